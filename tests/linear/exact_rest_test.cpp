// Linearization at rest states where the solver has nothing to do: the warm-start impulses already
// satisfy all laws, but the derivatives must still be available.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/linear/linear_robots.h"

namespace taut::test {
namespace {

/// Returns a ball on a rope from the ceiling.
ExperimentSpec OnARope(double stiffness_n_per_m) {
  ModelDef def;
  BodyDef body;
  body.name = "weight", body.mass_kg = 0.5, body.inertia_kg_m2 = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  def.bodies.push_back(body);
  def.gravity_m_per_s2 = {0, 0, -9.81};
  CableDef cable;
  cable.name = "rope", cable.stiffness_n_per_m = stiffness_n_per_m, cable.rest_length_m = 1;
  cable.attachments = {{kWorld, {0, 0, 1}}, {0, {0, 0, 0}}};
  def.cables.push_back(cable);
  return ExperimentOf(def);
}

/// Returns a rod on a hinge, its center half a meter below.
ExperimentSpec OnAHinge() {
  ExperimentSpec e = OnARope(1);
  ModelDef& def = e.robot.def;
  def.cables.clear();
  JointDef hinge;
  hinge.name = "hinge", hinge.kind = JointKind::kHinge, hinge.body_a = kWorld, hinge.body_b = 0;
  hinge.from_m = hinge.to_m = {0, 0, 0.5};
  hinge.axis = {0, 1, 0};
  def.joints.push_back(hinge);
  return e;
}

StateSpace FindExactRest(const ExperimentSpec& experiment) {
  Diagnostics out;
  StateSpace system = FindStateSpace(experiment, {}, out);
  EXPECT_TRUE(out.ok()) << out.Format();
  EXPECT_TRUE(system.found) << system.why;
  for (const std::string& remark : system.remarks) {
    if (remark.rfind("derivatives are finite differences", 0) != 0) ADD_FAILURE() << remark;
  }
  return system;
}

std::vector<double> Swings(const StateSpace& system) {
  std::vector<double> all_hz;
  for (const LinearMode& mode : ModesOf(system)) {
    if (mode.frequency_hz > 0.01 && std::fabs(mode.damping) < 0.5)
      all_hz.push_back(mode.frequency_hz);
  }
  return all_hz;
}

TEST(ExactRest, AStiffRope) {
  // Groups that are implicit in tension and direction use differences (linear.md, section 3).
  const StateSpace system = FindExactRest(OnARope(4e6));
  EXPECT_EQ(system.derivatives, Derivatives::kDifferences);
  // Like a pendulum, it swings in both directions, with the length of the rope stretched by the
  // weight.
  const std::vector<double> swings_hz = Swings(system);
  const double pendulum_hz = std::sqrt(9.81 / (1 + 0.5 * 9.81 / 4e6)) / (2 * std::numbers::pi);
  ASSERT_GE(swings_hz.size(), 2u);
  EXPECT_NEAR(swings_hz[0], pendulum_hz, 1e-5 * pendulum_hz);
  EXPECT_NEAR(swings_hz[1], pendulum_hz, 1e-5 * pendulum_hz);
}

TEST(ExactRest, AHinge) {
  // Groups with held joints use differences, too.
  const StateSpace system = FindExactRest(OnAHinge());
  EXPECT_EQ(system.derivatives, Derivatives::kDifferences);
  const double own_hz = std::sqrt(0.5 * 9.81 * 0.5 / (1e-3 + 0.5 * 0.25)) / (2 * std::numbers::pi);
  const std::vector<double> swings_hz = Swings(system);
  ASSERT_EQ(swings_hz.size(), 1u);
  EXPECT_NEAR(swings_hz[0], own_hz, 1e-5 * own_hz);
}

/// A ball on the ground: pushed, it rolls at once.
TEST(ExactRest, ABallOnTheGround) {
  ExperimentSpec e = OnARope(1);
  ModelDef& def = e.robot.def;
  def.cables.clear();
  SphereDef sphere;
  sphere.body = 0, sphere.radius_m = 0.1, sphere.material = {0.5, 0.5, 0};
  def.spheres.push_back(sphere);
  PlaneDef ground;
  ground.name = "ground", ground.point_m = {0, 0, -0.1}, ground.normal = {0, 0, 1};
  ground.material = {0.5, 0.5, 0};
  def.planes.push_back(ground);
  const StateSpace system = FindExactRest(e);
  EXPECT_EQ(system.derivatives, Derivatives::kExact);
  const auto entry = [&](const char* row, const char* column) {
    const auto i = FindSignal(system.states, row), j = FindSignal(system.states, column);
    EXPECT_TRUE(i && j) << row << column;
    return i && j ? system.A(*i, *j) : NAN;
  };
  // An impulse P at the ground stops the slip v - r w of a sliding ball: with J = I / r, v' = v - P
  // / m, w' = w + r P / I, v' = r w' (by w = spin_y).
  const double m = 0.5, I = 1e-3, r = 0.1, kept = m * r * r / (I + m * r * r);
  EXPECT_NEAR(entry("body/weight/velocity_x", "body/weight/velocity_x"), kept, 1e-9);
  EXPECT_NEAR(entry("body/weight/spin_y", "body/weight/velocity_x"), kept / r, 1e-8);
}

}  // namespace
}  // namespace taut::test
