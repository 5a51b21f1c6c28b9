/// An hour of standing without creep. standing_test.cpp checks the minute that every build runs.

#include "tests/physics/standing.h"

namespace taut::test {
namespace {

class StandingForAnHour : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
#ifndef NDEBUG
    GTEST_SKIP() << "an hour takes minutes in this build, without optimisation";
#endif
  }
};

TEST_P(StandingForAnHour, ItDoesNotCreep) { StandsStill(GetParam(), 0, 3600); }

TEST_P(StandingForAnHour, ItDoesNotCreepDownASlopeOfTenDegrees) {
  StandsStill(GetParam(), 10, 3600);
}

INSTANTIATE_TEST_SUITE_P(Robots, StandingForAnHour, ::testing::ValuesIn(kRobots),
                         [](const auto& robot) { return std::string(robot.param); });

}  // namespace
}  // namespace taut::test
