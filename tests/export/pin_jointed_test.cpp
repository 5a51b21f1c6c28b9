// Robots as pin-jointed structures (nodes, bars, strings): against closed forms and structures of
// TsgFEM
#include "taut/pin_jointed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/analysis/analysis_scenes.h"
#include "tests/unit/description/structural_files.h"

namespace taut {
namespace {

const PinMember& MemberOf(const PinJointed& s, const std::string& name) {
  for (const PinMember& member : s.members) {
    if (member.name == name) return member;
  }
  ADD_FAILURE() << "there is no member " << name;
  return s.members.front();
}

/// Returns the unbalanced force at a node: its load plus the forces of its members.
Vec3 LeftAt(const PinJointed& s, std::size_t node) {
  Vec3 sum = s.nodes[node].load_n;
  for (const PinMember& m : s.members) {
    const Vec3 way = s.nodes[static_cast<std::size_t>(m.to)].position_m -
                     s.nodes[static_cast<std::size_t>(m.from)].position_m;
    if (m.from == static_cast<int>(node)) sum = sum + m.force_density_n_per_m * way;
    if (m.to == static_cast<int>(node)) sum = sum - m.force_density_n_per_m * way;
  }
  return sum;
}

int AddRod(ModelDef& def, const std::string& name, const Vec3& from, const Vec3& to, double mass) {
  const int body = test::AddPoint(def, name, 0.5 * (from + to), mass);
  def.nodes.back().position_m = from;
  def.nodes.back().name = name + "_from";
  def.nodes.push_back({name + "_to", body, to});
  CapsuleDef rod;
  rod.name = name, rod.body = body, rod.from_m = from, rod.to_m = to, rod.radius_m = 0.01;
  def.capsules.push_back(rod);
  return body;
}

TEST(PinJointed, AWeightOnTwoRopesPullsByItsWeight) {
  ModelDef def;
  test::AddPoint(def, "ball", {0, 0, 0.6}, 2);
  const double length = 0.5, tension = 2 * 9.81 / 1.6, k = 1000;
  for (const double side : {-0.3, 0.3}) {
    test::AddCable(def, {{kWorld, {side, 0, 1}}, {0, {0, 0, 0.6}}}, k, length - tension / k);
  }
  const PinJointed s = PinJointedOf(def, true);
  ASSERT_EQ(s.nodes.size(), 3u);
  EXPECT_EQ(s.bars, 0);
  EXPECT_EQ(s.nodes[0].name, "ball");
  EXPECT_NEAR(s.nodes[0].load_n.z, -2 * 9.81, 1e-12);
  EXPECT_TRUE(s.nodes[1].pinned[0] && s.nodes[1].pinned[1] && s.nodes[1].pinned[2]);
  EXPECT_NEAR(s.members[0].force_n, tension, 1e-9);
  EXPECT_NEAR(s.members[0].force_density_n_per_m, tension / length, 1e-9);
  EXPECT_NEAR(LeftAt(s, 0).z, 0, 1e-9);
  EXPECT_TRUE(s.notes.empty());
  EXPECT_NEAR(s.nodes[1].left_n.z + s.nodes[2].left_n.z, 2 * 9.81, 1e-9);
  EXPECT_NEAR(PinJointedOf(def, false).nodes[0].load_n.z, 0, 0);
}

TEST(PinJointed, WhatFallsHasNoWeightForItsMembers) {
  ModelDef def;
  const int rod = AddRod(def, "rod", {0, 0, 1}, {1, 0, 1}, 1);
  const int other = AddRod(def, "other", {0, 1, 1}, {1, 1, 1}, 1);
  test::AddCable(def, {{rod, {0, 0, 1}}, {other, {1, 1, 1}}}, 100, 1);
  def.planes.emplace_back();  // far below
  for (const PinNode& node : PinJointedOf(def).nodes) EXPECT_EQ(node.load_n.z, 0);
  // The robot lies on the ground: now its nodes have weight.
  def.planes[0].point_m.z = 0.99;
  double weight = 0;
  for (const PinNode& node : PinJointedOf(def).nodes) {
    EXPECT_TRUE(node.on_ground);
    weight += node.load_n.z;
  }
  EXPECT_NEAR(weight, -2 * 9.81, 1e-9);
}

TEST(PinJointed, ARodBetweenTwoCablesIsPressed) {
  ModelDef def;
  const int rod = AddRod(def, "rod", {0, 0, 0}, {1, 0, 0}, 1);
  // All cables pull inward, toward anchors on either side of the rod's center.
  for (const double y : {-0.5, 0.5}) {
    for (const double x : {0.0, 1.0}) {
      test::AddCable(def, {{rod, {x, 0, 0}}, {kWorld, {0.5, y, 0}}}, 100, 0.5);
    }
  }
  const PinJointed s = PinJointedOf(def, false);
  const double tension = 100 * (std::sqrt(0.5) - 0.5);
  EXPECT_EQ(s.bars, 1);
  // Two cables at each end, at 45 degrees
  EXPECT_NEAR(MemberOf(s, "rod").force_n, -2 * tension * std::sqrt(0.5), 1e-9);
  EXPECT_EQ(MemberOf(s, "rod").stiffness_n_per_m, 0);
  EXPECT_EQ(MemberOf(s, "rod").rest_length_m, 1);
  EXPECT_TRUE(s.notes.empty()) << s.notes.front();
}

TEST(PinJointed, ARodThatACablePullsAsideBendsAndItsTrussBalancesAllTheSame) {
  ModelDef def;
  const int rod = AddRod(def, "rod", {0, 0, 0}, {2, 0, 0}, 1);
  const auto pull = [&](double x, double z, double tension) {
    test::AddCable(def, {{rod, {x, 0, 0}}, {kWorld, {x, 0, z}}}, 1000, 1 - tension / 1000);
  };
  pull(0, -1, 5), pull(2, -1, 5), pull(1, 1, 10);  // three-point bending
  const PinJointed s = PinJointedOf(def, false);
  ASSERT_TRUE(s.notes.empty()) << s.notes.front();
  for (std::size_t n = 0; n < s.nodes.size(); ++n) {
    if (s.nodes[n].pinned[0]) continue;
    EXPECT_NEAR(LeftAt(s, n).x, 0, 1e-9) << s.nodes[n].name;
    EXPECT_NEAR(LeftAt(s, n).y, 0, 1e-9);
    EXPECT_NEAR(LeftAt(s, n).z, 0, 1e-9);
  }
  // The rod becomes two bars and two points next to its axis.
  MemberOf(s, "rod_1"), MemberOf(s, "rod_2");
  int beside = 0;
  for (const PinNode& node : s.nodes) beside += node.name.starts_with("rod_beside_");
  EXPECT_EQ(beside, 2);
}

TEST(PinJointed, APlateUnderPullsAcrossItIsRigid) {
  ModelDef def;
  const int plate = test::AddPoint(def, "plate", {0, 0, 0}, 1);
  def.nodes.clear();
  double up = 1;
  // Forces at the corners of a square, alternately up and down: bars in the plane cannot carry
  // them.
  for (const Vec3 corner : {Vec3{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}) {
    test::AddCable(def, {{plate, corner}, {kWorld, corner + Vec3{0, 0, up}}}, 100, 0.9);
    up = -up;
  }
  const PinJointed s = PinJointedOf(def, false);
  ASSERT_TRUE(s.notes.empty()) << s.notes.front();
  for (std::size_t n = 0; n < s.nodes.size(); ++n) {
    if (s.nodes[n].pinned[0]) continue;
    EXPECT_NEAR(LeftAt(s, n).z, 0, 1e-9) << s.nodes[n].name;
  }
}

TEST(PinJointed, MassesOfNodesHaveTheMassAndTheCentreOfBodies) {
  ModelDef def;
  const int body = test::AddPoint(def, "hanging", {0.3, 0.1, -0.4}, 3);
  def.nodes.clear();
  for (const double x : {-1.0, 1.0}) {
    test::AddCable(def, {{body, {x, 0, 0}}, {kWorld, {x, 0, 1}}}, 100, 0.9);
  }
  const PinJointed s = PinJointedOf(def, true);
  double mass = 0;
  Vec3 first;
  for (const PinNode& node : s.nodes) {
    mass += node.mass_kg;
    first = first + node.mass_kg * node.position_m;
    EXPECT_NEAR(node.load_n.z, -9.81 * node.mass_kg, 1e-12);
  }
  EXPECT_NEAR(mass, 3, 1e-12);
  EXPECT_NEAR(first.x, 0.9, 1e-12);
  EXPECT_NEAR(first.y, 0.3, 1e-12);
  EXPECT_NEAR(first.z, -1.2, 1e-12);
}

TEST(PinJointed, CablesThroughEyeletsShareWhatTheyAreByLength) {
  ModelDef def;
  const int ring = test::AddPoint(def, "ring", {0, 0, 0}, 1);
  test::AddCable(def, {{kWorld, {-3, 0, 0}}, {ring, {0, 0, 0}}, {kWorld, {0, 1, 0}}}, 200, 3.5);
  PinJointed s = PinJointedOf(def, false);
  ASSERT_EQ(s.members.size(), 2u);
  ASSERT_EQ(s.clusters.size(), 1u);
  const PinCluster& all = s.clusters[0];
  EXPECT_NEAR(all.length_m, 4, 1e-12);
  EXPECT_NEAR(all.rest_length_m, 3.5, 1e-12);
  EXPECT_NEAR(all.stiffness_n_per_m, 200, 1e-9);
  EXPECT_NEAR(all.force_n, 100, 1e-9);
  // Each part has the same force, computed from its length and its stiffness.
  for (const PinMember& part : s.members) {
    EXPECT_NEAR(part.stiffness_n_per_m * (part.length_m - part.rest_length_m), 100, 1e-9);
  }
  EXPECT_NEAR(s.members[0].force_density_n_per_m, 100.0 / 3, 1e-9);
  EXPECT_EQ(Clustering(s).rows, 1);
  def.cables[0].attachments[1].friction = 0.1;
  s = PinJointedOf(def, false);
  ASSERT_EQ(s.clusters.size(), 2u);
  EXPECT_EQ(s.clusters[1].name, "cable0_span_2");
}

TEST(PinJointed, ACableOnAWheelPullsWhereItArrivesAndLeaves) {
  ModelDef def;
  const int body = test::AddPoint(def, "block", {0, 0, 0}, 1);
  AttachmentDef wheel{body, {0, 0, 0}};
  wheel.wheel = WheelDef{{0, 1, 0}, 0.1, false, 0};
  const double pi = std::acos(-1.0), arc = 0.1 * pi;
  test::AddCable(def, {{kWorld, {-0.1, 0, -1}}, wheel, {kWorld, {0.1, 0, -1}}}, 100, 2);
  if (PinJointedOf(def, false).members.size() < 3) {
    def.cables[0].attachments[1].wheel->counterclockwise = true;
  }
  const PinJointed s = PinJointedOf(def, false);
  const PinCluster& cable = s.clusters.back();
  EXPECT_NEAR(cable.length_m, 2, 1e-12);
  EXPECT_NEAR(cable.rest_length_m, 2 - arc, 1e-12);
  EXPECT_NEAR(cable.force_n, 100 * arc, 1e-9);
  EXPECT_NEAR(cable.stiffness_n_per_m * (cable.length_m - cable.rest_length_m), 100 * arc, 1e-9);
  // The cable pulls the block down with twice its tension; nothing balances this force.
  EXPECT_EQ(s.notes.size(), 2u);
  double down = 0;
  for (std::size_t n = 0; n < s.nodes.size(); ++n) {
    if (!s.nodes[n].pinned[0]) down += LeftAt(s, n).z;
  }
  EXPECT_NEAR(down, -2 * 100 * arc, 1e-9);
}

TEST(PinJointed, PointsThatJointsHoldAreOneNode) {
  ModelDef def;
  const int a = AddRod(def, "a", {0, 0, 0}, {1, 0, 0}, 1);
  const int b = AddRod(def, "b", {1, 0, 0}, {1, 1, 0}, 1);
  test::AddJoint(def, JointKind::kBall, a, {1, 0, 0}, b, {1, 0, 0});
  test::AddJoint(def, JointKind::kBall, kWorld, {0, 0, 0}, a, {0, 0, 0});
  test::AddJoint(def, JointKind::kLine, kWorld, {1, 1, 0}, b, {1, 1, 0}, {0, 1, 0});
  const PinJointed s = PinJointedOf(def, true);
  ASSERT_EQ(s.nodes.size(), 3u);
  const PinMember &first = MemberOf(s, "a"), &second = MemberOf(s, "b");
  EXPECT_EQ(first.to, second.from);
  const auto pinned = [&](int node) { return s.nodes[static_cast<std::size_t>(node)].pinned; };
  EXPECT_EQ(pinned(first.from), (std::array{true, true, true}));
  EXPECT_EQ(pinned(first.to), (std::array{false, false, false}));
  EXPECT_EQ(pinned(second.to), (std::array{true, false, true}));
}

TEST(PinJointed, AJointThatSlidesIsSaidToTakeNoPart) {
  ModelDef def;
  const int a = AddRod(def, "a", {0, 0, 0}, {1, 0, 0}, 1);
  const int b = AddRod(def, "b", {1, 0, 0}, {1, 1, 0}, 1);
  test::AddJoint(def, JointKind::kPrismatic, a, {1, 0, 0}, b, {1, 0, 0});
  const PinJointed s = PinJointedOf(def, false);
  ASSERT_EQ(s.notes.size(), 1u);
  EXPECT_NE(s.notes[0].find("joint0 is left out"), std::string::npos) << s.notes[0];
}

/// Checks member forces and force densities against structures of another program.
TEST(PinJointed, StructuresOfTsgFemHaveItsForceDensities) {
  int looked = 0;
  for (const char* name : {"tsgfem_static_tower_2prism", "tsgfem_static_half_Tbar",
                           "tsgfem_static_3d_Dbar_folding", "ctsfem_cable_net_TTS_static"}) {
    const auto file = test::StructuralFile(name);
    if (!file) continue;
    ++looked;
    ModelDef def = test::TrussOf(*file, MemberMass::kLumped);
    // Rigid bars: their forces follow from equilibrium only.
    for (JointDef& joint : def.joints) {
      if (IsBar(joint)) joint.stiffness = 0;
    }
    const PinJointed s = PinJointedOf(def, false);
    const auto force = test::Numbers((*file)["t"]), density = test::Numbers((*file)["q"]);
    ASSERT_EQ(s.members.size(), force.size()) << name;
    std::size_t bar = 0, string = static_cast<std::size_t>(s.bars);
    for (std::size_t m = 0; m < force.size(); ++m) {
      const PinMember& own = s.members[force[m] > 0 ? string++ : bar++];
      EXPECT_NEAR(own.force_n, force[m], 1e-6 * std::fabs(force[m])) << name << " " << m;
      EXPECT_NEAR(own.force_density_n_per_m, density[m], 1e-6 * std::fabs(density[m])) << name;
    }
    EXPECT_EQ(NodeMatrix(s).columns, static_cast<int>((*file)["N"][0].size()));
  }
  if (looked == 0) GTEST_SKIP() << "no structural reference: set TAUT_REFERENCE";
}

}  // namespace
}  // namespace taut
