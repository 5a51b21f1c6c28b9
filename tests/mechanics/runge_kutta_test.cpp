/// Tests of the reference integrator against closed forms.

#include "tests/mechanics/runge_kutta.h"

#include <gtest/gtest.h>

namespace taut::mechanics {
namespace {

TEST(RungeKutta, KeepsACircleForManyTurns) {
  const auto f = [](double, const std::array<double, 2>& y) {
    return std::array<double, 2>{y[1], -y[0]};
  };
  const auto y = Integrate<2>(f, 0, {1, 0}, 200, 1e-13);
  EXPECT_NEAR(y[0], std::cos(200.0), 1e-9);
  EXPECT_NEAR(y[1], -std::sin(200.0), 1e-9);
}

TEST(RungeKutta, FollowsTime) {
  const auto f = [](double t, const std::array<double, 1>&) {
    return std::array<double, 1>{3 * t * t};
  };
  EXPECT_NEAR((Integrate<1>(f, 1, {1}, 2)[0]), 8, 1e-12);
}

}  // namespace
}  // namespace taut::mechanics
