// The same controller with float, double and SIMD lanes
#include "taut/control/real.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "simd/wide.h"
#include "taut/control/impedance.h"
#include "taut/control/rate.h"
#include "tests/constants.h"

namespace taut::control {
namespace {

TEST(ControlReal, ClampKeepsTheRange) {
  EXPECT_EQ(Clamp(5.0, -1.0, 2.0), 2.0);
  EXPECT_EQ(Clamp(-5.0, -1.0, 2.0), -1.0);
  EXPECT_EQ(Clamp(1.5, -1.0, 2.0), 1.5);
}

TEST(ControlReal, NotANumberComesThroughWhereItIsTheGuardedArgument) {
  EXPECT_TRUE(std::isnan(Max(0.0, kNan)));
  EXPECT_TRUE(std::isnan(Min(0.0, kNan)));
  EXPECT_TRUE(std::isnan(Clamp(kNan, -1.0, 2.0)));
}

/// Drives a cable of oscillating length by impedance control through both conversions for two
/// seconds. Returns the final rest lengths.
template <class Real>
struct Ends {
  Real by_stiffness_m, by_pid_m;
};
template <class Real>
Ends<Real> Drive(Real tension_offset_n) {
  const auto real = [](float x) { return FromScalar<Real>(x); };
  const Real h = real(0.0009765625f), k = real(229.0f), floor_m = real(0.0078125f);
  const Impedance<Real> law{tension_offset_n, real(0.1875f), real(500.0f), real(150.0f)};
  const Pid<Real> pid{real(0.03125f), real(0.0625f), real(0.0f)};
  Real stiff_m = real(0.1875f), pid_m = real(0.1875f);
  PidState<Real> state = StartPid<Real>();
  DifferenceState<Real> difference = StartDifference(real(0.25f));
  for (int tick = 0; tick < 2048; ++tick) {
    // a triangle wave of 1/32 m: exact in float
    const int phase = tick % 1024;
    const Real l = real(0.25f + static_cast<float>(phase < 512 ? phase : 1024 - phase) / 16384.0f);
    const Real rate = StepDifference(difference, l, h);
    const Real set_point = ImpedanceTension(law, l, rate, real(0.0f));
    const Real zero = real(0.0f);
    const Real T_stiff = Max(zero, k * (l - stiff_m)), T_pid = Max(zero, k * (l - pid_m));
    stiff_m = TensionToRestLengthByStiffness(stiff_m, T_stiff, set_point, k, floor_m);
    const Real speed =
        TensionByPidLimited(pid, state, T_pid, set_point, h, real(0.0625f), Windup::kHeld);
    pid_m = RestLengthAfter(pid_m, speed, h, floor_m);
  }
  return {stiff_m, pid_m};
}

TEST(ControlReal, FloatAgreesWithDouble) {
  const Ends<double> exact = Drive<double>(11.0);
  const Ends<float> single = Drive<float>(11.0f);
  EXPECT_GT(std::abs(exact.by_stiffness_m - 0.1875), 0.01);  // it has moved
  EXPECT_GT(std::abs(exact.by_pid_m - 0.1875), 0.01);
  EXPECT_NEAR(static_cast<double>(single.by_stiffness_m), exact.by_stiffness_m, 1e-6);
  EXPECT_NEAR(static_cast<double>(single.by_pid_m), exact.by_pid_m, 1e-5);
}

bool SameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <int N>
void ExpectLanesEqualScalars() {
  using W = simd::Wide<N>;
  W offset = W::Splat(0.0);
  for (int i = 0; i < N; ++i) offset.Set(i, 3.0 + 8.0 * i);  // one lane slack at times
  const Ends<W> lanes = Drive<W>(offset);
  for (int i = 0; i < N; ++i) {
    const Ends<double> alone = Drive<double>(offset[i]);
    EXPECT_TRUE(SameBits(lanes.by_stiffness_m[i], alone.by_stiffness_m)) << i;
    EXPECT_TRUE(SameBits(lanes.by_pid_m[i], alone.by_pid_m)) << i;
  }
}

TEST(ControlReal, ALaneHasTheBitsOfItsScalar) {
  ExpectLanesEqualScalars<1>();
  ExpectLanesEqualScalars<2>();
}

}  // namespace
}  // namespace taut::control
