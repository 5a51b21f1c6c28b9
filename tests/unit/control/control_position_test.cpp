// Position control of rest lengths: programs in time, and winches
#include "taut/control/position.h"

#include <gtest/gtest.h>

#include <limits>

namespace taut::control {
namespace {

using Point = ProgramPoint<double>;

TEST(ControlPosition, OnePointIsAConstant) {
  const Point point{5.0, 0.2};
  for (const double t_s : {-1.0, 0.0, 5.0, 100.0}) EXPECT_EQ(RestLengthAt(&point, 1, t_s), 0.2);
}

TEST(ControlPosition, TwoPointsAreARampHeldAtItsEnds) {
  const Point ramp[] = {{10.0, 0.20}, {14.0, 0.24}};
  EXPECT_EQ(RestLengthAt(ramp, 2, 0.0), 0.20);
  EXPECT_EQ(RestLengthAt(ramp, 2, 10.0), 0.20);
  EXPECT_DOUBLE_EQ(RestLengthAt(ramp, 2, 11.0), 0.21);
  EXPECT_DOUBLE_EQ(RestLengthAt(ramp, 2, 13.0), 0.23);
  EXPECT_EQ(RestLengthAt(ramp, 2, 14.0), 0.24);
  EXPECT_EQ(RestLengthAt(ramp, 2, 1e6), 0.24);
}

TEST(ControlPosition, EveryPointIsMetExactly) {
  const Point points[] = {{0.0, 0.1}, {0.3, 0.7}, {0.7, 0.30000000000000004}, {1.1, 0.2}};
  for (const Point& point : points) {
    EXPECT_EQ(RestLengthAt(points, 4, point.time_s), point.rest_length_m);
  }
}

TEST(ControlPosition, TwoPointsAtOneTimeAreAJump) {
  const Point jump[] = {{0.0, 0.1}, {1.0, 0.2}, {1.0, 0.4}, {2.0, 0.5}};
  EXPECT_NEAR(RestLengthAt(jump, 4, 1.0 - 1e-9), 0.2, 1e-9);
  EXPECT_EQ(RestLengthAt(jump, 4, 1.0), 0.4);
  EXPECT_DOUBLE_EQ(RestLengthAt(jump, 4, 1.5), 0.45);
}

TEST(ControlPosition, AtATimeThatIsNoneTheProgramHasNotBegun) {
  const Point ramp[] = {{0.0, 0.20}, {1.0, 0.24}};
  EXPECT_EQ(RestLengthAt(ramp, 2, std::numeric_limits<double>::quiet_NaN()), 0.20);
}

// An integrating winch under proportional control: the error decays by (1 - kp h) per tick.
TEST(ControlPosition, APidBringsAWinchToItsSetPoint) {
  const Pid<double> pid{5.0, 0.0, 0.0};
  PidState<double> state = StartPid<double>();
  const double period_s = 0.001, set_point_m = 0.25;
  double rest_length_m = 0.26, error_m = set_point_m - rest_length_m;
  for (int n = 0; n < 2000; ++n) {
    const double rate_m_per_s =
        RestLengthByPid(pid, state, rest_length_m, set_point_m, period_s, 0.07, Windup::kHeld);
    EXPECT_NEAR(rate_m_per_s, 5.0 * error_m, 1e-12);  // 5 /s * 1 cm is below the limit
    rest_length_m += rate_m_per_s * period_s;
    error_m *= 1.0 - 5.0 * period_s;
  }
  EXPECT_NEAR(rest_length_m, set_point_m, 1e-6);
}

TEST(ControlPosition, APidDoesNotAskForMoreThanTheWinchCan) {
  const Pid<double> pid{5.0, 0.0, 0.0};
  PidState<double> state = StartPid<double>();
  EXPECT_EQ(RestLengthByPid(pid, state, 0.2, 1.0, 0.001, 0.07, Windup::kHeld), 0.07);
  EXPECT_EQ(RestLengthByPid(pid, state, 1.0, 0.2, 0.001, 0.07, Windup::kHeld), -0.07);
}

}  // namespace
}  // namespace taut::control
