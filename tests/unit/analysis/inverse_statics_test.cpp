// Inverse statics: against closed forms, against the statics of a description, which has no
// unknowns, and against published commands of a real robot
#include "taut/inverse_statics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "math/vec.h"
#include "taut/spec.h"
#include "tests/unit/analysis/holding_scenes.h"

namespace taut {
namespace {

using test::Body;
using test::CableTo;

constexpr double kWeight = 2 * 9.81;

HoldingForces Hold(const ModelDef& def, const HoldingOptions& options = {},
                   const LoadCaseSpec& loads = {}) {
  Diagnostics out;
  HoldingForces forces = FindHoldingForces(def, loads, options, out);
  EXPECT_TRUE(out.ok()) << out.Format();
  return forces;
}

/// A mass of 2 kg on three vertical cables at its center of mass
ModelDef ThreeAbove() {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, -9.81};
  def.bodies = {Body("mass", 2, {0, 0, 0})};
  def.cables = {CableTo("a", {0, 0, 1}, {}, 500), CableTo("b", {0, 0, 2}, {}, 1000),
                CableTo("c", {0, 0, 3}, {}, 2500)};
  return def;
}

TEST(InverseStatics, ParallelCablesShareByWhatIsLeast) {
  HoldingOptions options;
  const auto expect = [&](HoldingCost cost, const std::vector<double>& shares) {
    options.minimise = cost;
    const HoldingForces forces = Hold(ThreeAbove(), options);
    ASSERT_TRUE(forces.found) << forces.why;
    double sum = 0;
    for (const double share : shares) sum += share;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(forces.cable_tension_n[i], kWeight * shares[i] / sum, 1e-9);
    }
    EXPECT_LT(forces.residual_n, 1e-12);
  };
  // Lagrange multipliers: T w = const, with the weights w = 1, 1 / (2 k), 1 / l^2
  expect(HoldingCost::kTension, {1, 1, 1});
  expect(HoldingCost::kEnergy, {500, 1000, 2500});
  expect(HoldingCost::kForceDensity, {1, 4, 9});
}

TEST(InverseStatics, RestLengthsAndCommandsFollowFromTensions) {
  HoldingOptions options;
  options.minimise = HoldingCost::kTension;
  options.calibration_rest_m = {0.9, 2.0, 3.5};
  LoadCaseSpec warm;
  warm.cables = {{1, 0.002}};
  const HoldingForces forces = Hold(ThreeAbove(), options, warm);
  const double tension = kWeight / 3;
  EXPECT_NEAR(forces.rest_length_m[1], 2 - tension / 1000, 1e-12);
  EXPECT_NEAR(forces.command_m[0], 1 - tension / 500 - 0.9, 1e-12);
  EXPECT_NEAR(forces.command_m[1], -tension / 1000 - 0.002, 1e-12);  // heat has lengthened it
  EXPECT_NEAR(forces.command_m[2], 3 - tension / 2500 - 3.5, 1e-12);
  EXPECT_NEAR(forces.cost, 3 * tension * tension, 1e-9);
}

TEST(InverseStatics, BoundsOfTensionAndOfForceDensity) {
  ModelDef def = ThreeAbove();
  def.cables[2] = CableTo("below", {0, 0, -4}, {});
  HoldingOptions options;
  options.minimise = HoldingCost::kTension;
  options.bounds.resize(3);
  options.bounds[2].at_least_n_per_m = 2;  // 8 N
  options.bounds[0].at_most_n = 5;
  const HoldingForces forces = Hold(def, options);
  ASSERT_TRUE(forces.found) << forces.why;
  EXPECT_NEAR(forces.cable_tension_n[2], 8, 1e-9);
  EXPECT_NEAR(forces.cable_tension_n[0], 5, 1e-9);
  EXPECT_NEAR(forces.cable_tension_n[1], kWeight + 3, 1e-9);
  EXPECT_EQ(forces.at_bound, (std::vector<int>{0, 2}));
}

TEST(InverseStatics, ACableThatWouldHaveToPushIsNamedByWhatIsLeft) {
  ModelDef def = ThreeAbove();
  def.bodies.push_back(Body("other", 1, {5, 0, 0}));
  for (CableDef& cable : def.cables) cable.attachments[0].position_m.z = -1;
  def.cables.push_back(CableTo("holds", {5, 0, 1}, {5, 0, 0}));
  def.cables.back().attachments[1].body = 1;
  const HoldingForces forces = Hold(def);
  EXPECT_FALSE(forces.found);
  ASSERT_EQ(forces.left.size(), 1U);
  EXPECT_EQ(forces.left[0].body, 0);
  EXPECT_NEAR(forces.left[0].force_n.z, -kWeight, 1e-8);
  EXPECT_EQ(
      forces.why,
      "no forces within their bounds balance the loads; out of balance: mass by 19.62 N and 0 N m");
}

TEST(InverseStatics, BoundsThatAreTooTightLeaveTheRest) {
  ModelDef def = ThreeAbove();
  HoldingOptions options;
  options.bounds.assign(3, {0.0, 3.0});
  const HoldingForces forces = Hold(def, options);
  EXPECT_FALSE(forces.found);
  ASSERT_EQ(forces.left.size(), 1U);
  EXPECT_NEAR(forces.left[0].force_n.z, 9 - kWeight, 1e-8);
}

TEST(InverseStatics, APushAcrossAllCablesIsLeft) {
  ModelDef def = ThreeAbove();
  def.nodes = {{"n", 0, {0, 0, 0}}};
  LoadCaseSpec loads;
  loads.forces = {{0, {3, 0, 0}}};
  const HoldingForces forces = Hold(def, {}, loads);
  EXPECT_FALSE(forces.found);
  ASSERT_EQ(forces.left.size(), 1U);
  EXPECT_NEAR(forces.left[0].force_n.x, 3, 1e-9);
  EXPECT_NEAR(forces.left[0].force_n.z, 0, 1e-7);
}

// A crane: a bar from the wall to the mass, a cable from above; l_bar = 3, l_cable = 5, 4 above.
TEST(InverseStatics, BarsCarryWhatTheyMust) {
  ModelDef def;
  def.bodies = {Body("mass", 2, {3, 0, 0})};
  def.cables = {CableTo("rope", {0, 0, 4}, {3, 0, 0})};
  JointDef bar;
  bar.name = "boom", bar.kind = JointKind::kDistance;
  bar.body_a = kWorld, bar.body_b = 0, bar.from_m = {0, 0, 0}, bar.to_m = {3, 0, 0};
  bar.stiffness = 1e5, bar.rest = 3;
  def.joints = {bar};
  const HoldingForces forces = Hold(def);
  ASSERT_TRUE(forces.found) << forces.why;
  EXPECT_NEAR(forces.cable_tension_n[0], kWeight * 5 / 4, 1e-9);
  EXPECT_NEAR(forces.bar_force_n[0], -kWeight * 3 / 4, 1e-9);
  EXPECT_NEAR(forces.bar_rest_m[0], 3 + kWeight * 3 / 4 / 1e5, 1e-12);
  EXPECT_NEAR(forces.joint_loads[0].force_n.x, kWeight * 3 / 4, 1e-9);
}

// A moving pulley: both spans carry half the weight.
TEST(InverseStatics, ACableThroughAnEyeletBearsHalf) {
  ModelDef def;
  def.bodies = {Body("block", 2, {0, 0, 0})};
  CableDef rope = CableTo("rope", {0, 0, 3}, {});
  rope.attachments.push_back({kWorld, {0, 0, 3}});
  def.cables = {rope};
  const HoldingForces forces = Hold(def);
  ASSERT_TRUE(forces.found) << forces.why;
  EXPECT_NEAR(forces.cable_tension_n[0], kWeight / 2, 1e-9);
  EXPECT_NEAR(forces.rest_length_m[0], 6 - kWeight / 2 / 1000, 1e-12);
}

// A plank of 4 m on two feet without friction, pulled up by a rope at one end: lever law.
TEST(InverseStatics, WhatTouchesPushesAndDoesNotPull) {
  ModelDef def;
  def.bodies = {Body("plank", 2, {0, 0, 0})};
  def.cables = {CableTo("rope", {2, 0, 1}, {2, 0, 0})};
  HoldingOptions options;
  options.touches = {{0, kWorld, {-2, 0, 0}, {0, 0, 1}, 0}, {0, kWorld, {1, 0, 0}, {0, 0, 1}, 0}};
  options.bounds = {{4.0, 4.0}};
  const HoldingForces held = Hold(def, options);
  ASSERT_TRUE(held.found) << held.why;
  // Moments about the left foot: 3 N2 + 4 * 4 = 2 W
  EXPECT_NEAR(held.touch_force_n[1].z, (2 * kWeight - 16) / 3, 1e-9);
  EXPECT_NEAR(held.touch_force_n[0].z, kWeight - 4 - (2 * kWeight - 16) / 3, 1e-9);
  options.bounds = {{11.0, 11.0}};  // the right foot would have to pull
  EXPECT_FALSE(Hold(def, options).found);
}

// With the resulting rest lengths the described pose is in equilibrium.
TEST(InverseStatics, PretensionOfAPrismBalancesTheDescription) {
  Diagnostics out;
  auto robot = LoadRobot(std::string(TAUT_SOURCE_DIR) + "/examples/my_first_robot.yaml", {}, out);
  ASSERT_TRUE(robot) << out.Format();
  ModelDef& def = robot->def;
  def.gravity_m_per_s2 = {};
  HoldingOptions options;
  options.bounds.assign(def.cables.size(), {10.0});
  const HoldingForces forces = Hold(def, options);
  ASSERT_TRUE(forces.found) << forces.why;
  for (std::size_t i = 0; i < def.cables.size(); ++i) {
    def.cables[i].rest_length_m = forces.rest_length_m[i];
  }
  EXPECT_FALSE(forces.at_bound.empty());
  for (const BodyLoad& load : StartLoads(def)) {
    EXPECT_LT(std::sqrt(Dot(load.cable_force_n, load.cable_force_n)), 1e-9);
    EXPECT_LT(std::sqrt(Dot(load.cable_torque_n_m, load.cable_torque_n_m)), 1e-9);
  }
}

/// The BEST laboratory's spine in the plane y = 0 of W, z up (tests/data/best_2d_spine/README.md)
ModelDef BestSpine(double x_m, double z_m, double turn_rad) {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  const auto at = [&](double x, double z) {
    return Vec3{x_m + c * x - s * z, 0, z_m + s * x + c * z};
  };
  const Vec3 low = at(-0.1442, -0.1524), high = at(-0.1442, 0.1524);
  const Vec3 a{-0.0656, 0, 0}, b{-0.0656, 0, 0.307}, third{0.1842, 0, 0.1524};
  ModelDef def;
  def.bodies = {Body("vertebra", 0.655, at(-0.0291, 0))};
  def.cables = {CableTo("1", a, low, 838.86), CableTo("2", b, high, 838.86),
                CableTo("3", third, low, 4448.2), CableTo("4", third, high, 4448.2)};
  JointDef plane;
  plane.name = "guide", plane.kind = JointKind::kPlanar, plane.body_a = kWorld, plane.body_b = 0;
  plane.axis = {0, 1, 0}, plane.from_m = plane.to_m = def.bodies[0].com_m;
  def.joints = {plane};
  return def;
}

TEST(InverseStatics, The120PublishedCommandsOfTheBestSpine) {
  std::ifstream file(std::string(TAUT_SOURCE_DIR) + "/tests/data/best_2d_spine/commands.csv");
  std::string line;
  for (int heading = 0; heading < 5; ++heading) std::getline(file, line);
  HoldingOptions options;
  options.minimise = HoldingCost::kForceDensity;
  options.bounds.assign(4, {0.0, CableBounds::kNone, 0.5});
  for (const CableDef& cable : BestSpine(0.3284, 0.1524, 0).cables) {
    options.calibration_rest_m.push_back(CableLength(cable));
  }
  int commands = 0, bounded = 0;
  double largest = 0;
  while (std::getline(file, line)) {
    std::vector<double> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    ASSERT_EQ(row.size(), 10U);
    const HoldingForces forces = Hold(BestSpine(row[7], row[8], row[9]), options);
    ASSERT_TRUE(forces.found) << forces.why;
    for (std::size_t i = 0; i < 4; ++i) {
      largest = std::fmax(largest, std::fabs(-forces.command_m[i] - 0.01 * row[i]));
    }
    bounded += !forces.at_bound.empty();
    ++commands;
  }
  EXPECT_EQ(commands, 120);
  EXPECT_EQ(bounded, 120);   // each is determined by the lower bound of force density
  EXPECT_LT(largest, 1e-5);  // commands and poses have five digits
  RecordProperty("largest_m", std::to_string(largest * 1e6) + " um");
}

TEST(InverseStatics, WrongOptionsAreComplainedOfAllAtOnce) {
  HoldingOptions options;
  options.bounds = {{-1.0}, {0, CableBounds::kNone, 3, 2}};
  options.calibration_rest_m = {1};
  options.touches = {{4, kWorld, {}, {0, 0, 2}, -1}};
  LoadCaseSpec loads;
  loads.name = "wind";
  loads.settlements = {{0, {}}};
  loads.forces = {{7, {}}};
  ModelDef def = ThreeAbove();
  Diagnostics out;
  const HoldingForces none = FindHoldingForces(def, loads, options, out);
  EXPECT_FALSE(none.found);
  EXPECT_EQ(none.why, "the options are invalid");
  EXPECT_EQ(out.Format(),
            "error: contact 0 does not connect two bodies, or a body and the world\n"
            "error: load case wind has a force on a node that does not exist\n"
            "error: load case wind moves supports, but forces are computed in the described pose "
            "(describe the pose with the moved supports)\n"
            "error: the calibration has 1 rest lengths for 3 cables\n"
            "error: the friction of contact 0 must be a finite number of at least 0\n"
            "error: the normal of contact 0 is not a unit vector\n"
            "error: there are 2 bounds for 3 cables\n");
  def.cables.pop_back();
  options.calibration_rest_m.clear();
  options.touches.clear();
  Diagnostics bounds;
  FindHoldingForces(def, {}, options, bounds);
  EXPECT_EQ(bounds.Format(),
            "error: the bounds of cable a must be numbers of at least 0\n"
            "error: the lower bound of cable b, 6.000000 N, is above its upper bound of 4.000000 "
            "N\n");
}

}  // namespace
}  // namespace taut
