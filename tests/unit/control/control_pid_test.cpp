// PID controllers: closed forms of responses, output limits and wind-up
#include "taut/control/pid.h"

#include <gtest/gtest.h>

namespace taut::control {
namespace {

constexpr double kPidPeriod = 0.001;
constexpr Pid<double> kPid{2.0, 30.0, 0.5};

TEST(ControlPid, AStepOfTheErrorHasItsClosedForm) {
  PidState<double> state = StartPid<double>();
  const double e = 1.5;
  for (int n = 1; n <= 1000; ++n) {
    // the trapezoid from e = 0 to e counts half of the first period
    const double integral = e * kPidPeriod * (n - 0.5);
    const double derivative = n == 1 ? e / kPidPeriod : 0.0;
    EXPECT_NEAR(StepPid(kPid, state, e, kPidPeriod), 2.0 * e + 30.0 * integral + 0.5 * derivative,
                1e-11);
  }
}

TEST(ControlPid, ARampOfTheErrorHasItsClosedForm) {
  PidState<double> state = StartPid<double>();
  const double slope = 4.0;
  for (int n = 1; n <= 1000; ++n) {
    const double t_s = n * kPidPeriod;
    EXPECT_NEAR(StepPid(kPid, state, slope * t_s, kPidPeriod),
                2.0 * slope * t_s + 30.0 * slope * t_s * t_s / 2.0 + 0.5 * slope, 1e-10);
  }
}

TEST(ControlPid, StartingAtTheErrorGivesNoKick) {
  const Pid<double> derivative_only{0.0, 0.0, 1.0};
  PidState<double> kicked = StartPid<double>(), smooth = StartPidAt(3.0);
  EXPECT_DOUBLE_EQ(StepPid(derivative_only, kicked, 3.0, kPidPeriod), 3000.0);
  EXPECT_EQ(StepPid(derivative_only, smooth, 3.0, kPidPeriod), 0.0);
}

TEST(ControlPid, StartingFromAnOutputGoesOnFromThere) {
  for (const double error : {-2.0, 0.0, 0.7}) {
    for (const double output : {-1.0, 0.0, 0.4}) {
      PidState<double> state = StartPidFrom(kPid, error, output, kPidPeriod);
      EXPECT_NEAR(StepPid(kPid, state, error, kPidPeriod), output, 1e-12);
      // then it integrates
      EXPECT_NEAR(StepPid(kPid, state, error, kPidPeriod), output + 30.0 * error * kPidPeriod,
                  1e-12);
    }
  }
  const Pid<double> proportional{2.0, 0.0, 0.0};
  PidState<double> state = StartPidFrom(proportional, 0.5, 9.0, kPidPeriod);
  EXPECT_EQ(StepPid(proportional, state, 0.5, kPidPeriod), 1.0);
}

TEST(ControlPid, ZeroGainsGiveZero) {
  const Pid<double> none{0.0, 0.0, 0.0};
  PidState<double> state = StartPid<double>();
  for (const double e : {1.0, -100.0, 1e6}) EXPECT_EQ(StepPid(none, state, e, kPidPeriod), 0.0);
}

TEST(ControlPid, WithinTheLimitsTheLimitedOneIsThePlainOne) {
  const OutputLimits<double> wide{-1e9, 1e9};
  for (const Windup windup : {Windup::kAllowed, Windup::kHeld}) {
    PidState<double> plain = StartPid<double>(), limited = StartPid<double>();
    for (int n = 0; n < 100; ++n) {
      const double e = 1.0 - 0.03 * n;
      EXPECT_EQ(StepPid(kPid, plain, e, kPidPeriod),
                StepPidLimited(kPid, limited, e, kPidPeriod, wide, windup));
      EXPECT_EQ(plain.integral, limited.integral);
    }
  }
}

// An integral controller at its limit for n ticks: with wind-up it needs n ticks of the opposite
// error to return; without wind-up it leaves the limit at the first.
TEST(ControlPid, HeldIntegralLeavesTheLimitAtOnce) {
  const Pid<double> integral_only{0.0, 10.0, 0.0};
  for (const double side : {1.0, -1.0}) {
    const OutputLimits<double> limits{-1.0, 1.0};
    PidState<double> wound = StartPidAt(side), held = StartPidAt(side);
    for (int n = 0; n < 1000; ++n) {
      StepPidLimited(integral_only, wound, side, kPidPeriod, limits, Windup::kAllowed);
      StepPidLimited(integral_only, held, side, kPidPeriod, limits, Windup::kHeld);
    }
    EXPECT_NEAR(wound.integral, side * 1.0, 1e-12);               // 1 s of unit error
    EXPECT_NEAR(held.integral, side * 0.1, 1.0001 * kPidPeriod);  // where 10 I reaches the limit

    const double opposite = -side;
    StepPidLimited(integral_only, wound, opposite, kPidPeriod, limits, Windup::kAllowed);
    StepPidLimited(integral_only, held, opposite, kPidPeriod, limits, Windup::kHeld);
    double u_wound = 0, u_held = 0;
    for (int n = 0; n < 10; ++n) {
      u_wound =
          StepPidLimited(integral_only, wound, opposite, kPidPeriod, limits, Windup::kAllowed);
      u_held = StepPidLimited(integral_only, held, opposite, kPidPeriod, limits, Windup::kHeld);
    }
    EXPECT_EQ(u_wound, side);
    EXPECT_LT(side * u_held, 0.95);
    EXPECT_GT(side * u_held, 0.85);
  }
}

TEST(ControlPid, TheOutputIsFormedWithTheIntegralThatWasKept) {
  const Pid<double> pid{0.5, 10.0, 0.0};
  const OutputLimits<double> limits{-1.0, 1.0};
  PidState<double> state = StartPidAt(0.3);
  double u = 0.0;
  for (int n = 0; n < 1000; ++n) {
    u = StepPidLimited(pid, state, 0.3, kPidPeriod, limits, Windup::kHeld);
    ASSERT_NEAR(u, 0.5 * 0.3 + 10.0 * state.integral, 1e-14);
  }
  EXPECT_LE(u, 1.0);
  EXPECT_GT(u, 1.0 - 10.0 * 0.3 * kPidPeriod);  // one more tick would exceed the limit
}

TEST(ControlPid, TheOutputNeverLeavesTheLimits) {
  const OutputLimits<double> limits{-0.2, 0.7};
  for (const Windup windup : {Windup::kAllowed, Windup::kHeld}) {
    PidState<double> state = StartPid<double>();
    for (int n = 0; n < 2000; ++n) {
      const double e = (n % 7 - 3) * (n % 1000 < 500 ? 1.0 : -0.6) + 0.1;
      const double u = StepPidLimited(kPid, state, e, kPidPeriod, limits, windup);
      ASSERT_GE(u, limits.low);
      ASSERT_LE(u, limits.high);
    }
  }
}

}  // namespace
}  // namespace taut::control
