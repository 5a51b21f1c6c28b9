// Sine and cosine of turns, and sine waves
#include "taut/control/sine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simd/wide.h"

namespace taut::control {
namespace {

constexpr long double kTwoPi = 2.0L * std::numbers::pi_v<long double>;

TEST(Turns, SineAndCosineAreThoseOfTheCircle) {
  double sine = 0, cosine = 0;
  float sine_float = 0, cosine_float = 0;
  for (int i = -100000; i <= 100000; ++i) {
    const double x = i / 200000.0;
    const long double angle = kTwoPi * static_cast<long double>(x);
    const auto s = static_cast<double>(std::sin(angle)), c = static_cast<double>(std::cos(angle));
    sine = std::max(sine, std::fabs(SinTurns(x) - s));
    cosine = std::max(cosine, std::fabs(CosTurns(x) - c));
    const float y = static_cast<float>(x);
    const long double angle_float = kTwoPi * static_cast<long double>(y);
    sine_float =
        std::max(sine_float, std::fabs(SinTurns(y) - static_cast<float>(std::sin(angle_float))));
    cosine_float =
        std::max(cosine_float, std::fabs(CosTurns(y) - static_cast<float>(std::cos(angle_float))));
  }
  // At a quarter turn the series is (6.3 - 2.6 + ...) / 4: the last subtraction rounds by half a
  // unit of 4, the product before it by half a unit of 2.6, the first term by half a unit of 6.3.
  EXPECT_LE(sine, 4 * 0x1p-53);
  EXPECT_LE(cosine, 4 * 0x1p-53);
  EXPECT_LE(sine_float, 4 * 0x1p-24f);
  EXPECT_LE(cosine_float, 4 * 0x1p-24f);
}

TEST(Turns, TheSineIsOddAndItsZerosAreExact) {
  for (const double x : {0.0, 0.1, 0.2, 0.25, 0.3, 0.45, 0.5})
    EXPECT_EQ(SinTurns(-x), -SinTurns(x));
  EXPECT_EQ(SinTurns(0.5), 0.0);
  EXPECT_EQ(CosTurns(0.25), 0.0);
  EXPECT_EQ(CosTurns(-0.25), 0.0);
  EXPECT_NEAR(SinTurns(1e-9), 2e-9 * std::numbers::pi, 1e-24);
}

TEST(Turns, WrappingTakesWholeTurnsOffWithoutRounding) {
  EXPECT_EQ(WrapTurns(0.375), 0.375);
  EXPECT_EQ(WrapTurns(3.375), 0.375);
  EXPECT_EQ(WrapTurns(-2.625), 0.375);
  EXPECT_EQ(WrapTurns(1e15 + 0.25), 0.25);
  EXPECT_EQ(WrapTurns(-4194303.75f), 0.25f);
  EXPECT_EQ(std::fabs(WrapTurns(0.5)), 0.5);
  EXPECT_TRUE(std::isnan(WrapTurns(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(WrapTurns(std::numeric_limits<double>::infinity())));
}

TEST(Turns, LanesComputeWhatADoubleDoes) {
  using Lanes = simd::Wide<4>;
  for (int i = -64; i < 64; ++i) {
    Lanes x = Lanes::Splat(0);
    for (int lane = 0; lane < 4; ++lane) x.v[lane] = i / 37.0 + lane / 9.0;
    const Lanes s = SinTurns(WrapTurns(x)), c = CosTurns(WrapTurns(x));
    for (int lane = 0; lane < 4; ++lane) {
      EXPECT_EQ(s[lane], SinTurns(WrapTurns(x[lane])));
      EXPECT_EQ(c[lane], CosTurns(WrapTurns(x[lane])));
    }
  }
}

// NTRT's hand-tuned gait: A = 6 cm/s, offset -A, phase -3.14159 rad, 0.5 Hz; the value at 0.02 s in
// its trace is -0.1198816 m/s.
TEST(Sine, TheHandTunedWaveHasNtrtsValue) {
  const Sine<double> wave{0.06, -3.14159 * kTurnsPerRad, -0.06};
  EXPECT_NEAR(SineVelocity(wave, ClockTurns(0.5, 0.02)), -0.1198816, 5e-8);
}

TEST(Sine, TheClockDoesNotDrift) {
  const Sine<double> wave{1.0, 0.125, 0.0};
  // 1e9 periods of 0.5 Hz plus an eighth
  EXPECT_NEAR(SineVelocity(wave, ClockTurns(0.5, 2e9 + 0.25)), 0.0, 1e-15);
  EXPECT_EQ(SineVelocity(wave, ClockTurns(0.5, 2e9)), SineVelocity(wave, 0.0));
}

TEST(Sine, AmplitudePhaseAndOffsetAreWhatTheySay) {
  const Sine<double> wave{2.0, 0.25, 0.5};
  EXPECT_EQ(SineVelocity(wave, 0.0), 0.5);             // cos 90 degrees
  EXPECT_NEAR(SineVelocity(wave, -0.25), 2.5, 1e-15);  // cos 0
  EXPECT_NEAR(SineVelocity(wave, 0.25), -1.5, 1e-15);  // cos 180
}

}  // namespace
}  // namespace taut::control
