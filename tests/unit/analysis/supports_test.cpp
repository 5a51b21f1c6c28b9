/// Supports: texts of free motions, load cases that supports cannot hold, and largest displacements
/// of nodes

#include <gtest/gtest.h>

#include <cmath>

#include "taut/analysis.h"
#include "tests/scenes/rod.h"
#include "tests/unit/analysis/analysis_scenes.h"

namespace taut::test {
namespace {

/// A horizontal triangle of three points and bars, of side 1 m, centered on the z axis
ModelDef Triangle(double height_m) {
  ModelDef def;
  const double r = 1 / std::sqrt(3.0);
  const Vec3 at[] = {{r, 0, height_m}, {-r / 2, 0.5, height_m}, {-r / 2, -0.5, height_m}};
  for (int i = 0; i < 3; ++i) AddPoint(def, "p" + std::to_string(i), at[i], 1);
  for (int i = 0; i < 3; ++i) AddBar(def, i, at[i], (i + 1) % 3, at[(i + 1) % 3], 1e5, 1);
  return def;
}

void Hold(ModelDef& def, JointKind kind, int body, const Vec3& axis = {0, 0, 1}) {
  const Vec3 at = def.bodies[static_cast<std::size_t>(body)].com_m;
  AddJoint(def, kind, kWorld, at, body, at, axis);
}

LoadCaseSpec Push(int node, const Vec3& force_n) {
  LoadCaseSpec loads;
  loads.weight = false;
  loads.forces.push_back({node, force_n});
  return loads;
}

TEST(Supports, FreeMotionsAreNamedByTheirAxes) {
  ModelDef def = Triangle(0);
  SupportCheck check = CheckSupports(def, {});
  EXPECT_EQ(check.free, 6);
  EXPECT_EQ(check.free_motions,
            std::vector<std::string>{"the structure can still translate along x, y and z and "
                                     "rotate about x, y and z through (0, 0, 0)"});
  // Planes support it from below: it can slide and rotate on them.
  for (int i = 0; i < 3; ++i) Hold(def, JointKind::kPlane, i);
  check = CheckSupports(def, {});
  EXPECT_EQ(check.free, 3);
  EXPECT_EQ(
      check.free_motions[0],
      "the structure can still translate along x and y and rotate about z through (0.5774, 0, 0)");
  EXPECT_EQ(check.missing, "") << "weight does nothing along them";
  EXPECT_EQ(CheckSupports(def, Push(0, {0, 0, 5})).missing, "");
  EXPECT_EQ(CheckSupports(def, Push(0, {5, 0, 0})).missing,
            check.free_motions[0] + ", and the loads act along this motion");
  // Lines along x: only translation along x is free.
  Hold(def, JointKind::kLine, 1, {1, 0, 0}), Hold(def, JointKind::kLine, 2, {1, 0, 0});
  check = CheckSupports(def, Push(0, {5, 0, 0}));
  EXPECT_EQ(check.free, 1);
  EXPECT_EQ(check.missing,
            "the structure can still translate along x, and the loads act along this motion");
  EXPECT_EQ(check.fix,
            "no member resists this motion: add anchors or supports that hold at least 1 direction "
            "at nodes that move");
  EXPECT_EQ(CheckSupports(def, Push(0, {0, 5, 0})).missing, "");
}

TEST(Supports, ATurnAboutTheLineThroughTwoOfThemIsNamed) {
  for (const double height_m : {0.5, -0.5}) {
    // The tip, which carries the mass, is above or below the line between the two held corners.
    ModelDef def = Triangle(0);
    Hold(def, JointKind::kBall, 1), Hold(def, JointKind::kBall, 2);
    const Vec3 tip{0, 0, height_m};
    AddPoint(def, "tip", tip, 30);
    for (int i = 0; i < 3; ++i) {
      const Vec3 at = def.bodies[static_cast<std::size_t>(i)].com_m;
      AddBar(def, 3, tip, i, at, 1e5, std::sqrt(1.0 / 3 + 0.25));
    }
    const SupportCheck check = CheckSupports(def, {});
    EXPECT_EQ(check.free, 1);
    const std::string moves = "the structure can still rotate about y through (-0.2887, 0.5, 0)";
    EXPECT_EQ(check.free_motions, std::vector<std::string>{moves});
    EXPECT_EQ(check.missing, height_m > 0 ? moves + ", and the loads topple it" : "");
  }
}

TEST(Supports, WhatTheGroundMayBearIsNotRefused) {
  ModelDef def;
  scenes::AddRod(def, "rod", 1, 0.01, {0, 0, 1}, {0.1, 0, 2}, {});
  AddJoint(def, JointKind::kBall, kWorld, {0, 0, 1}, 0, {0, 0, 1});
  EXPECT_NE(CheckSupports(def, {}).missing, "");
  def.planes.push_back({"ground", {0, 0, 1}, {0, 0, 0}, {}});
  EXPECT_EQ(CheckSupports(def, {}).missing, "");
}

/// A body may hang from a rail, which supports it everywhere.
TEST(Supports, ARodThatHangsFromARailIsNotRefused) {
  for (const double side : {-1.0, 1.0}) {
    ModelDef def;
    scenes::AddRod(def, "rod", 1, 0.01, {0, 0, 0}, {0, 0, side}, {});
    AddJoint(def, JointKind::kLine, kWorld, {0, 0, 0}, 0, {0, 0, 0}, {1, 0, 0});
    const SupportCheck check = CheckSupports(def, {});
    EXPECT_EQ(check.free, 3);
    EXPECT_EQ(check.free_motions[0],
              "the structure can still translate along x and rotate about x and y through (0, 0, "
              "0)");
    EXPECT_EQ(check.missing.empty(), side < 0) << check.missing;
    def.nodes.push_back({"end", 0, {0, 0, side}});
    const int end = static_cast<int>(def.nodes.size()) - 1;
    EXPECT_NE(CheckSupports(def, Push(end, {1, 0, 0})).missing, "");
    LoadCaseSpec across = Push(end, {0, 1, 0});
    across.weight = true;
    EXPECT_EQ(CheckSupports(def, across).missing.empty(), side < 0) << "the weight brings it back";
  }
}

TEST(Supports, ASpringHoldsAHinge) {
  ModelDef def;
  scenes::AddRod(def, "rod", 1, 0.01, {0, 0, 0}, {0, 0, 1}, {});
  JointDef& hinge = AddJoint(def, JointKind::kHinge, kWorld, {0, 0, 0}, 0, {0, 0, 0}, {0, 1, 0});
  EXPECT_EQ(CheckSupports(def, {}).missing,
            "the structure can still rotate about y through (0, 0, 0), and the loads topple it");
  hinge.stiffness = 4;  // m g l / 2 = 4.905 N m
  EXPECT_NE(CheckSupports(def, {}).missing, "");
  hinge.stiffness = 6;
  EXPECT_EQ(CheckSupports(def, {}).missing, "");
}

TEST(Supports, APartThatNothingHoldsIsNamed) {
  ModelDef def = Rope(1, 1000, 0.99);
  AddPoint(def, "loose", {0, 0, 3}, 1);
  const SupportCheck check = CheckSupports(def, {});
  EXPECT_EQ(check.free, 3);
  EXPECT_EQ(check.missing,
            "the part with body \"loose\" can still translate along x, y and z, and the loads act "
            "along this motion");
}

TEST(Supports, LoadsOfAFloatingRobotHaveToBalance) {
  const ModelDef def = Triangle(1);
  LoadCaseSpec squeeze = Push(1, {0, -5, 0});
  squeeze.forces.push_back({2, {0, 5, 0}});
  EXPECT_EQ(CheckSupports(def, squeeze).missing, "");
  squeeze.forces[1].force_n.y = 4;
  EXPECT_NE(CheckSupports(def, squeeze).missing, "");
  squeeze.forces[1].force_n = {1, 5, 0};  // with a moment
  EXPECT_NE(CheckSupports(def, squeeze).missing, "");
}

TEST(LargestMove, IsThatOfTheNodeThatMovesMost) {
  ModelDef def;
  AddPoint(def, "mass", {0, 0, -1}, 1);
  AddCable(def, {{kWorld, {0, 0, 0}}, {0, {0, 0, -1}}}, 100, 1);
  Equilibrium at = FindEquilibrium(def);
  Move move = LargestMove(def, at.pose);
  EXPECT_NEAR(move.distance_m, 9.81 / 100, 1e-9);
  EXPECT_EQ(move.name, "node \"mass\"");
  EXPECT_NEAR(move.size_m, 1, 1e-12);
  EXPECT_EQ(move.Warning(), "");
  def.cables[0].stiffness_n_per_m = 30;
  at = FindEquilibrium(def);
  EXPECT_EQ(LargestMove(def, at.pose).Warning(),
            "node \"mass\" moves by 0.327 m, more than a quarter of the structure's size of 1 m");
}

/// On the ground only the change of shape counts, not the rigid motion of a falling or rolling
/// robot.
TEST(LargestMove, LeavesOutTheRigidMotionOfWhatNothingHolds) {
  const ModelDef def = Triangle(1);
  Pose pose;
  const Quat turn{std::cos(1.0), std::sin(1.0), 0, 0};
  for (const BodyDef& body : def.bodies) {
    BodyState state;
    const Vec3& p = body.com_m;  // turned by 2 rad about x, then moved
    state.position_m = {p.x + 7, std::cos(2.0) * p.y - std::sin(2.0) * p.z,
                        std::sin(2.0) * p.y + std::cos(2.0) * p.z - 3};
    state.orientation = turn;
    pose.bodies.push_back(state);
  }
  EXPECT_LT(LargestMove(def, pose).distance_m, 1e-12);
  pose.bodies[0].position_m.x += 0.3;
  const Move move = LargestMove(def, pose);
  EXPECT_GT(move.distance_m, 0.05);
  EXPECT_LT(move.distance_m, 0.3);
}

}  // namespace
}  // namespace taut::test
