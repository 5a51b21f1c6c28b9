/// Static equilibrium against closed forms and against what settles in a simulation.

#include <gtest/gtest.h>

#include <cmath>

#include "math/vec.h"
#include "taut/analysis.h"
#include "tests/unit/analysis_scenes.h"

namespace taut::test {
namespace {

/// Half a rope's equation: a point between two cables of rest length L and stiffness k, each 1 m
/// across, sags by w under F: F = 2 k (l - L) w / l, l = sqrt(1 + w^2). Solved by bisection.
double Sag(double k, double rest, double force) {
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double w = 0.5 * (low + high), l = std::sqrt(1 + w * w);
    (2 * k * (l - rest) * w / l < force ? low : high) = w;
  }
  return low;
}

TEST(Equilibrium, ATightRopeSagsAsItsEquationSaysAtAnyMass) {
  const double ea = 100e9 * 50e-6, rest = ea / (ea + 20000);
  struct {
    double force_n, sag_m, tension_n;
  } const cases[] = {{5109, 0.0750685, 34124.7}, {9988, 0.1052325, 47718.9}};
  for (const auto& c : cases) {
    for (const double mass : {1e-6, 0.001, 1.0, 1000.0}) {
      ModelDef def = Rope(mass, ea / rest, rest);
      LoadCaseSpec loads;
      loads.weight = false;
      loads.forces.push_back({0, {0, 0, -c.force_n}});
      const Equilibrium e = FindEquilibrium(def, loads);
      ASSERT_TRUE(e.found) << e.why;
      EXPECT_EQ(e.way, EquilibriumWay::kNewton);
      EXPECT_NEAR(-e.pose.bodies[0].position_m.z, c.sag_m, 5e-8);
      EXPECT_NEAR(-e.pose.bodies[0].position_m.z, Sag(ea / rest, rest, c.force_n), 1e-12);
      EXPECT_NEAR(e.cable_tension_n[0], c.tension_n, 0.05);
    }
  }
}

}  // namespace
}  // namespace taut::test
