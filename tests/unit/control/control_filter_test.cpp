// Low-pass and complementary filters of controllers, against transfer functions
#include "taut/control/filter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace taut::control {
namespace {

TEST(ControlFilter, AStepArrivesAsAPower) {
  for (const double share : {0.001, 0.1, 0.5, 1.0}) {
    double y = 0;
    for (int n = 1; n <= 200; ++n) {
      EXPECT_NEAR(StepLowPass(y, 3.0, share), 3.0 * (1 - std::pow(1 - share, n)), 1e-12);
    }
  }
}

// A filtered sine: amplitude and phase of a / (1 - (1 - a) z^-1)
TEST(ControlFilter, ASineHasTheTransferFunctionsAmplitude) {
  const double share = 0.1, w = 0.3;
  double y = 0, most = 0;
  for (int n = 0; n < 4000; ++n) {
    StepLowPass(y, std::sin(w * n), share);
    if (n > 1000) most = std::max(most, std::fabs(y));
  }
  const double b = 1 - share;
  EXPECT_NEAR(most, share / std::sqrt(1 - 2 * b * std::cos(w) + b * b), 1e-4);
}

// Two sensors of one quantity, one with noise at every tick, one with drift: the filter suppresses
// both.
TEST(ControlFilter, AComplementaryFilterTakesTheBestOfBoth) {
  const double share = 0.02;
  double y = 1.0, low = 1.0, before = 1.0, worst = 0, worst_low = 0;
  for (int n = 1; n <= 5000; ++n) {
    const double truth = 1.0 + 0.5 * std::sin(0.05 * n);
    const double measured = truth + (n % 2 == 0 ? 0.2 : -0.2);
    const double step = truth - before + 1e-4;
    before = truth;
    StepComplementary(y, measured, step, share);
    StepLowPass(low, measured, share);
    if (n > 500) {
      worst = std::max(worst, std::fabs(y - truth));
      worst_low = std::max(worst_low, std::fabs(low - truth));
    }
  }
  // the drift contributes 1e-4 (1 - a) / a, the noise 0.2 a / (2 - a)
  EXPECT_NEAR(worst, 1e-4 * (1 - share) / share + 0.2 * share / (2 - share), 1e-3);
  EXPECT_GT(worst_low, 0.4);
}

TEST(ControlFilter, WithoutTheOtherSensorItIsALowPass) {
  double y = 0.3, low = 0.3;
  for (int n = 0; n < 100; ++n) {
    const double x = std::cos(n);
    EXPECT_EQ(StepComplementary(y, x, 0.0, 0.25), StepLowPass(low, x, 0.25));
  }
}

}  // namespace
}  // namespace taut::control
