// Clocks of controllers: ticks without drift, and ticks in loops
#include "taut/control/clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace taut::control {
namespace {

TEST(ControlClock, TicksAreAtPhasePlusMultiplesOfThePeriod) {
  const Clock<double> clock{0.25, 0.125};
  EXPECT_EQ(TickTime(clock, 0), 0.125);
  EXPECT_EQ(TickTime(clock, 4), 1.125);
}

TEST(ControlClock, TenMillionTicksDoNotDrift) {
  const Clock<double> clock{0.001, 0.0};
  double summed_s = 0.0;
  for (int tick = 1; tick <= 10'000'000; ++tick) {
    summed_s += clock.period_s;
    const double exact_s = tick / 1000.0;  // correctly rounded
    ASSERT_NEAR(TickTime(clock, tick), exact_s, 4e-16 * exact_s);
  }
  EXPECT_GT(std::abs(summed_s - 1e4), 1e-6);  // the drift that the clock avoids
}

TEST(ControlClock, EveryTickIsAtItself) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> period(1e-4, 0.1), phase(0.0, 2.0);
  std::uniform_int_distribution<int64_t> tick(1, 100'000'000);
  for (int i = 0; i < 100'000; ++i) {
    const Clock<double> clock{period(random), phase(random)};
    const int64_t k = tick(random);
    ASSERT_EQ(TickAtOrAfter(clock, TickTime(clock, k)), k);
    ASSERT_TRUE(IsDue(clock, k, TickTime(clock, k)));
    const double between_s = TickTime(clock, k) + 0.5 * clock.period_s;
    ASSERT_EQ(TickAtOrAfter(clock, between_s), k + 1);
    ASSERT_FALSE(IsDue(clock, k + 1, between_s));
  }
}

TEST(ControlClock, ATimeWithinTheToleranceIsAtTheTick) {
  const Clock<double> clock{0.001, 0.0};
  const double tolerance_s = kTickTolerance<double> * clock.period_s;
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(TickAtOrAfter(clock, 5.0 + sign * 0.5 * tolerance_s), 5000);
    EXPECT_TRUE(IsDue(clock, 5000, 5.0 + sign * 0.5 * tolerance_s));
  }
  EXPECT_EQ(TickAtOrAfter(clock, 5.0 + 2.0 * tolerance_s), 5001);
  EXPECT_FALSE(IsDue(clock, 5000, 5.0 - 2.0 * tolerance_s));
}

TEST(ControlClock, NothingTicksBeforeThePhase) {
  const Clock<double> clock{0.01, 0.5};
  for (const double t_s : {-1e300, -1.0, 0.0, 0.4999}) {
    EXPECT_EQ(TickAtOrAfter(clock, t_s), 0) << t_s;
    EXPECT_FALSE(IsDue(clock, 0, t_s)) << t_s;
  }
  EXPECT_EQ(TickAtOrAfter(clock, 0.5), 0);
  EXPECT_TRUE(IsDue(clock, 0, 0.5));
}

TEST(ControlClock, TimesThatAreNoTimesAreAnsweredWithinRange) {
  const Clock<double> clock{0.001, 0.0};
  EXPECT_EQ(TickAtOrAfter(clock, std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(TickAtOrAfter(clock, -std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(TickAtOrAfter(clock, std::numeric_limits<double>::infinity()), kLastTick);
  EXPECT_EQ(TickAtOrAfter(clock, 1e300), kLastTick);
  EXPECT_FALSE(IsDue(clock, 0, std::numeric_limits<double>::quiet_NaN()));
}

TEST(ControlClock, StepsThatDivideThePeriodFindEachTickAtTheRightStep) {
  for (const double period_s : {0.001, 0.01, 0.003, 1.0 / 300.0}) {
    for (const int steps_per_tick : {1, 2, 3, 4, 7, 10, 16}) {
      const Clock<double> clock{period_s, 0.0};
      const double step_s = period_s / steps_per_tick;
      for (int step = 0; step <= 300'000; ++step) {
        const int next = (step + steps_per_tick - 1) / steps_per_tick;
        ASSERT_EQ(TickAtOrAfter(clock, step * step_s), next) << step << " of " << step_s;
        ASSERT_EQ(IsDue(clock, next, step * step_s), step % steps_per_tick == 0)
            << step << " of " << step_s;
      }
    }
  }
}

/// Runs a loop whose steps end at ticks, as in a simulation. Returns the times of control actions.
std::vector<double> TimesOfALoop(const Clock<double>& clock, double step_s, double until_s) {
  std::vector<double> acted_s;
  int64_t tick = TickAtOrAfter(clock, 0.0), step = 0;
  double t_s = 0.0;
  for (int turn = 0; t_s < until_s && turn < 1'000'000; ++turn) {
    if (IsDue(clock, tick, t_s)) {
      acted_s.push_back(t_s);
      ++tick;
    }
    const double step_end_s = static_cast<double>(step + 1) * step_s;
    t_s = std::min(step_end_s, TickTime(clock, tick));
    if (t_s == step_end_s) ++step;
  }
  return acted_s;
}

TEST(ControlClock, ALoopActsAtTheSameTicksForAnyStep) {
  const Clock<double> clock{0.001, 0.0004};
  for (const double step_s : {0.004, 0.001, 0.0007, 0.00025, 0.01}) {
    const std::vector<double> acted_s = TimesOfALoop(clock, step_s, 30.0);
    ASSERT_EQ(acted_s.size(), 30'000u) << step_s;
    for (std::size_t tick = 0; tick < acted_s.size(); ++tick) {
      ASSERT_NEAR(acted_s[tick], TickTime(clock, static_cast<int64_t>(tick)), 1e-14) << step_s;
    }
  }
}

TEST(ControlClock, AFloatClockFindsItsTicksAsLongAsAFloatCanTellThemApart) {
  for (const float period_s : {0.0009765625f, 0.001f, 0.003f, 0.01f}) {
    for (const float phase_s : {0.0f, 0.7f}) {
      const Clock<float> clock{period_s, phase_s};
      for (int64_t tick = 0; tick < 20'000; ++tick) {
        ASSERT_EQ(TickAtOrAfter(clock, TickTime(clock, tick)), tick) << period_s;
        ASSERT_TRUE(IsDue(clock, tick, TickTime(clock, tick))) << period_s;
        const float between_s = TickTime(clock, tick) + 0.5f * period_s;
        ASSERT_EQ(TickAtOrAfter(clock, between_s), tick + 1) << period_s;
        ASSERT_FALSE(IsDue(clock, tick + 1, between_s)) << period_s;
      }
    }
  }
}

}  // namespace
}  // namespace taut::control
