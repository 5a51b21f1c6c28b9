// Impedance control, and conversions of tensions to rest lengths, against closed forms
#include "taut/control/impedance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "taut/control/rate.h"
#include "tests/constants.h"

namespace taut::control {
namespace {

constexpr double kPeriod = 0.001;
constexpr double kStiffness = 229.16;

/// Cable 1 of the paper's quasi-static test: inner top, front
constexpr Impedance<double> kInnerTop{28.0, 0.19, 500.0, 150.0};

double ElasticTension(double length_m, double rest_length_m) {
  return std::max(0.0, kStiffness * (length_m - rest_length_m));
}

TEST(ControlImpedance, TheLawGivesHandComputedTensions) {
  EXPECT_DOUBLE_EQ(ImpedanceTension(kInnerTop, 0.19, 0.0, 0.0), 28.0);
  EXPECT_DOUBLE_EQ(ImpedanceTension(kInnerTop, 0.20, 0.0, 0.0), 33.0);    // + 500 * 0.01
  EXPECT_DOUBLE_EQ(ImpedanceTension(kInnerTop, 0.20, 0.01, 0.0), 34.5);   // + 150 * 0.01
  EXPECT_DOUBLE_EQ(ImpedanceTension(kInnerTop, 0.20, 0.01, 0.02), 31.5);  // - 150 * 0.02
  EXPECT_DOUBLE_EQ(ImpedanceTension(kInnerTop, 0.18, -0.02, 0.0), 20.0);  // 28 - 5 - 3
}

TEST(ControlImpedance, LengtheningRaisesTheSetPointAndALengtheningCommandLowersIt) {
  const double T = ImpedanceTension(kInnerTop, 0.19, 0.0, 0.0);
  EXPECT_GT(ImpedanceTension(kInnerTop, 0.191, 0.0, 0.0), T);
  EXPECT_GT(ImpedanceTension(kInnerTop, 0.19, 0.01, 0.0), T);
  EXPECT_LT(ImpedanceTension(kInnerTop, 0.19, 0.0, 0.01), T);
}

TEST(ControlImpedance, ZeroGainsLeaveTheTensionOffset) {
  const Impedance<double> offset_only{12.0, 0.3, 0.0, 0.0};
  for (const double length_m : {0.0, 0.3, 5.0}) {
    EXPECT_EQ(ImpedanceTension(offset_only, length_m, 2.0, -1.0), 12.0);
  }
}

TEST(ControlImpedance, TheSetPointIsNeverNegative) {
  const Impedance<double> soft{1.0, 0.2, 100.0, 50.0};
  EXPECT_EQ(ImpedanceTension(soft, 0.1, 0.0, 0.0), 0.0);   // 1 - 10
  EXPECT_EQ(ImpedanceTension(soft, 0.2, -1.0, 0.0), 0.0);  // 1 - 50
  EXPECT_EQ(ImpedanceTension(soft, 0.2, 0.0, 1.0), 0.0);
}

TEST(ControlImpedance, AMeasurementThatIsNotANumberStaysSeen) {
  EXPECT_TRUE(std::isnan(ImpedanceTension(kInnerTop, kNan, 0.0, 0.0)));
  EXPECT_TRUE(std::isnan(TensionToRestLengthByStiffness(0.2, kNan, 10.0, kStiffness, 0.001)));
  EXPECT_TRUE(std::isnan(RestLengthAfter(0.2, kNan, kPeriod, 0.001)));
}

TEST(ControlTensionByStiffness, ATautCableReachesTheSetPointInOneTick) {
  const double length_m = 0.25;
  for (const double set_point_n : {0.0, 1.0, 7.0, 20.0, 50.0}) {
    const double rest_length_m = 0.22;
    const double T = ElasticTension(length_m, rest_length_m);
    ASSERT_GT(T, 0.0);
    const double next_m =
        TensionToRestLengthByStiffness(rest_length_m, T, set_point_n, kStiffness, 0.001);
    EXPECT_NEAR(ElasticTension(length_m, next_m), set_point_n, 1e-12);
    // and remains there
    const double after_m = TensionToRestLengthByStiffness(next_m, ElasticTension(length_m, next_m),
                                                          set_point_n, kStiffness, 0.001);
    EXPECT_NEAR(after_m, next_m, 1e-15);
  }
}

TEST(ControlTensionByStiffness, ASlackCableIsWoundInByTheSetPointEachTick) {
  const double length_m = 0.25, set_point_n = 10.0;
  const double winding_m = set_point_n / kStiffness;
  double rest_length_m = length_m + 2.5 * winding_m;
  for (int tick = 1; tick <= 3; ++tick) {
    rest_length_m = TensionToRestLengthByStiffness(
        rest_length_m, ElasticTension(length_m, rest_length_m), set_point_n, kStiffness, 0.001);
    EXPECT_NEAR(rest_length_m, length_m + (2.5 - tick) * winding_m, 1e-15);
  }
  rest_length_m = TensionToRestLengthByStiffness(
      rest_length_m, ElasticTension(length_m, rest_length_m), set_point_n, kStiffness, 0.001);
  EXPECT_NEAR(ElasticTension(length_m, rest_length_m), set_point_n, 1e-12);
}

TEST(ControlTensionByStiffness, TheRestLengthDoesNotPassItsFloor) {
  EXPECT_EQ(TensionToRestLengthByStiffness(0.02, 0.0, 100.0, kStiffness, 0.01), 0.01);
  EXPECT_EQ(TensionToRestLengthByStiffness(0.02, 0.0, 100.0, kStiffness, 0.001), 0.001);
}

TEST(ControlTensionByPid, TooLittleTensionWindsIn) {
  const Pid<double> pid{0.01, 0.0, 0.0};
  PidState<double> state = StartPid<double>();
  EXPECT_DOUBLE_EQ(TensionByPid(pid, state, 8.0, 10.0, kPeriod), -0.02);
  EXPECT_DOUBLE_EQ(TensionByPid(pid, state, 13.0, 10.0, kPeriod), 0.03);
}

// Proportional control of an ideal cable held at both ends: the error decays by (1 - k kp h) per
// tick.
TEST(ControlTensionByPid, TheErrorOfAHeldCableDecaysGeometrically) {
  const Pid<double> pid{0.05, 0.0, 0.0};
  PidState<double> state = StartPid<double>();
  const double length_m = 0.25, set_point_n = 20.0;
  double rest_length_m = 0.24;
  const double error_n = set_point_n - ElasticTension(length_m, rest_length_m);
  for (int n = 1; n <= 500; ++n) {
    const double rate =
        TensionByPid(pid, state, ElasticTension(length_m, rest_length_m), set_point_n, kPeriod);
    rest_length_m = RestLengthAfter(rest_length_m, rate, kPeriod, 0.001);
    EXPECT_NEAR(set_point_n - ElasticTension(length_m, rest_length_m),
                error_n * std::pow(1.0 - kStiffness * 0.05 * kPeriod, n), 1e-11);
  }
}

TEST(ControlTensionByPid, TheLimitedOneKeepsTheSpeedLimitInBothDirections) {
  const Pid<double> pid{1.0, 0.0, 0.0};
  PidState<double> state = StartPid<double>();
  EXPECT_EQ(TensionByPidLimited(pid, state, 0.0, 10.0, kPeriod, 0.07, Windup::kHeld), -0.07);
  EXPECT_EQ(TensionByPidLimited(pid, state, 10.0, 0.0, kPeriod, 0.07, Windup::kHeld), 0.07);
  EXPECT_EQ(TensionByPidLimited(pid, state, 10.0, 10.0625, kPeriod, 0.07, Windup::kHeld), -0.0625);
}

TEST(ControlRestLength, AfterOnePeriodItIsRateTimesPeriodFurtherButAboveTheFloor) {
  EXPECT_DOUBLE_EQ(RestLengthAfter(0.2, -0.07, 0.01, 0.01), 0.1993);
  EXPECT_EQ(RestLengthAfter(0.0101, -0.07, 0.01, 0.01), 0.01);
}

TEST(ControlLengthFromTension, TheElasticTensionTellsTheLengthOfATautCable) {
  for (const double length_m : {0.2201, 0.25, 0.4}) {
    EXPECT_NEAR(LengthFromTension(0.22, ElasticTension(length_m, 0.22), kStiffness), length_m,
                1e-15);
  }
  EXPECT_EQ(LengthFromTension(0.22, ElasticTension(0.1, 0.22), kStiffness), 0.22);  // slack
}

TEST(ControlRate, SteadyLengtheningIsItsRate) {
  DifferenceState<double> state = StartDifference(0.2);
  EXPECT_EQ(StepDifference(state, 0.2, kPeriod), 0.0);
  for (int n = 1; n < 100; ++n) {
    EXPECT_NEAR(StepDifference(state, 0.2 + 0.05 * n * kPeriod, kPeriod), 0.05, 1e-12);
  }
}

TEST(ControlRate, NtrtsFirstTickSeesTheStretchAsAJump) {
  DifferenceState<double> state =
      StartDifferenceAtRestLength(0.193103657);  // outer left cable of NTRT
  EXPECT_NEAR(StepDifference(state, 0.22365, kPeriod), 30.546343, 1e-9);
  EXPECT_EQ(StepDifference(state, 0.22365, kPeriod), 0.0);
}

}  // namespace
}  // namespace taut::control
