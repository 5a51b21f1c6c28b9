/// Ranks, states of self-stress and mechanisms against closed forms for known tensegrity structures

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "math/angle.h"
#include "math/vec.h"
#include "taut/analysis.h"
#include "tests/scenes/rod.h"
#include "tests/unit/analysis/analysis_scenes.h"

namespace taut::test {
namespace {

double Distance(const Vec3& a, const Vec3& b) { return std::sqrt(Dot(a - b, a - b)); }

/// Rods between pairs of points, and cables with given stiffness [N/m] and force density [N/m]
struct Rods {
  ModelDef def;
  std::vector<Vec3> at;
  std::vector<int> body;

  void AddRod(const Vec3& from, const Vec3& to) {
    const std::string name = "rod" + std::to_string(def.bodies.size());
    const int index = scenes::AddRod(def, name, 0.1, 1e-3, from, to, {});
    for (const Vec3& end : {from, to}) at.push_back(end), body.push_back(index);
  }
  void AddCableOf(std::size_t a, std::size_t b, double stiffness, double density) {
    const double length = Distance(at[a], at[b]);
    AddCable(def, {{body[a], at[a]}, {body[b], at[b]}}, stiffness,
             length - density * length / stiffness);
  }
};

/// Six rods of length 4, in parallel pairs 2 apart, and 24 cables of length sqrt(6)
ModelDef SixStruts(double stiffness, double density) {
  Rods robot;
  robot.def.gravity_m_per_s2 = {};
  for (const double side : {1.0, -1.0}) {
    robot.AddRod({0, side, 2}, {0, side, -2});
    robot.AddRod({2, 0, side}, {-2, 0, side});
    robot.AddRod({side, 2, 0}, {side, -2, 0});
  }
  for (std::size_t a = 0; a < 12; ++a) {
    for (std::size_t b = a + 1; b < 12; ++b) {
      const double apart = Distance(robot.at[a], robot.at[b]);
      if (std::fabs(apart - std::sqrt(6.0)) < 1e-9) robot.AddCableOf(a, b, stiffness, density);
    }
  }
  return robot.def;
}

/// A prism of n struts whose top is rotated against its base by pi / 2 - pi / n along a side cable
ModelDef Prism(int n) {
  Rods robot;
  robot.def.gravity_m_per_s2 = {};
  constexpr double kRadius = 0.7, kHeight = 1.1;
  for (int i = 0; i < n; ++i) {
    const double low = 2 * std::numbers::pi * i / n,
                 high = low + std::numbers::pi / 2 + std::numbers::pi / n;
    robot.AddRod({kRadius * std::cos(low), kRadius * std::sin(low), 0},
                 {kRadius * std::cos(high), kRadius * std::sin(high), kHeight});
  }
  const auto place = [&](int strut, int end) {
    return static_cast<std::size_t>(2 * (strut % n) + end);
  };
  for (int i = 0; i < n; ++i) robot.AddCableOf(place(i, 0), place(i + 1, 0), 1e3, 1);
  for (int i = 0; i < n; ++i) robot.AddCableOf(place(i, 1), place(i + 1, 1), 1e3, 1);
  for (int i = 0; i < n; ++i) robot.AddCableOf(place(i, 1), place(i + 1, 0), 1e3, 1);
  return robot.def;
}

TEST(ForceAnalysis, SixStrutsHaveOneStateOfSelfStressAndOneMechanism) {
  const ForceAnalysis found = AnalyseForces(SixStruts(1e3, 1));
  EXPECT_EQ(found.unknowns, 30);
  EXPECT_EQ(found.free_turns, 6);
  EXPECT_EQ(found.rank.rank, 23);
  EXPECT_TRUE(found.rank.clear());
  EXPECT_EQ(found.rigid, 6);
  EXPECT_EQ(found.mechanisms.size(), 1U);
  ASSERT_EQ(found.self_stress.size(), 1U);
  EXPECT_TRUE(found.self_stress[0].feasible);
  for (const double density : found.self_stress[0].density_n_per_m) EXPECT_NEAR(density, 1, 1e-12);
  ASSERT_EQ(found.self_stress[0].rod_density_n_per_m.size(), 6U);
  for (const double density : found.self_stress[0].rod_density_n_per_m) {
    EXPECT_NEAR(density, -1.5, 1e-12);
  }
}

TEST(ForceAnalysis, SixStrutsCountAsInTheLiterature) {
  const ForceAnalysis found = AnalyseForces(SixStruts(1e3, 1));
  ASSERT_TRUE(found.classical.has_value());
  EXPECT_EQ(found.classical->nodes, 12);
  EXPECT_EQ(found.classical->members, 30);
  EXPECT_EQ(found.classical->rank.rank, 29);
  EXPECT_EQ(found.classical->self_stresses, 1);
  EXPECT_EQ(found.classical->mechanisms, 1);
  EXPECT_EQ(found.classical->rigid, 6);
  // Columns have the length sqrt(2), because both ends of a member contribute.
  EXPECT_NEAR(found.classical->rank.smallest_kept / std::sqrt(2.0), 0.28, 0.005);
  EXPECT_LT(found.classical->rank.largest_dropped, 1e-14);
}

// The mechanism is stiffened by prestress only. With stiff cables the lowest eigenvalue is four
// times the cables' force density, as is the mechanism's stiffness for any cable stiffness.
TEST(ForceAnalysis, PrestressGivesSixStrutsFourTimesItsDensity) {
  const ForceAnalysis found = AnalyseForces(SixStruts(1e8, 2.5));
  ASSERT_EQ(found.mechanism_stiffness.size(), 1U);
  EXPECT_NEAR(found.mechanism_stiffness[0], 4, 1e-9);
  const std::optional<double> least = LeastStiffness(SixStruts(1e8, 2.5));
  ASSERT_TRUE(least.has_value());
  EXPECT_NEAR(*least / 2.5, 4, 1e-5);
}

TEST(ForceAnalysis, PrismsHaveTheDensitiesAndMechanismsThatAreKnown) {
  for (const int n : {3, 4, 6}) {
    SCOPED_TRACE(n);
    const ForceAnalysis found = AnalyseForces(Prism(n));
    ASSERT_FALSE(found.self_stress.empty());
    const SelfStress& state = found.self_stress[0];
    EXPECT_TRUE(state.feasible);
    const std::size_t sides = static_cast<std::size_t>(2 * n);
    for (int i = 0; i < 2 * n; ++i) {
      EXPECT_NEAR(state.density_n_per_m[static_cast<std::size_t>(i)] / state.density_n_per_m[sides],
                  1 / (2 * std::sin(std::numbers::pi / n)), 1e-9);
    }
    ASSERT_FALSE(state.rod_density_n_per_m.empty());
    EXPECT_NEAR(state.rod_density_n_per_m[0] / state.density_n_per_m[sides], -1, 1e-9);
    EXPECT_EQ(found.self_stress.size(), 1U);
    EXPECT_EQ(found.mechanisms.size(), static_cast<std::size_t>(2 * n - 5));
    ASSERT_FALSE(found.mechanism_stiffness.empty());
    EXPECT_GT(found.mechanism_stiffness.front(), 1e-3);
  }
}

TEST(ForceAnalysis, ATurnedPrismHasNoStateOfSelfStress) {
  ModelDef def = Prism(3);
  for (CableDef& cable : def.cables) {
    for (AttachmentDef& at : cable.attachments) {
      if (at.position_m.z < 1) continue;  // the top, rotated by 0.1 rad
      const Vec3 p = at.position_m;
      at.position_m = {std::cos(0.1) * p.x - std::sin(0.1) * p.y,
                       std::sin(0.1) * p.x + std::cos(0.1) * p.y, p.z};
    }
  }
  const ForceAnalysis found = AnalyseForces(def);
  EXPECT_TRUE(found.self_stress.empty());
  EXPECT_TRUE(found.mechanism_stiffness.empty());
}

// A point on ten cables has seven states of self-stress; only some combinations put all cables in
// tension.
TEST(ForceAnalysis, AFeasibleStateIsFoundAmongMany) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  AddPoint(def, "p", {0, 0, 0}, 1);
  const Vec3 ends[] = {{1, 0, 0.3},  {-1, 0.2, 0.1}, {0.1, 1, -0.2}, {0.2, -1, 0.1}, {0.3, 0.1, 1},
                       {0.1, 0, -1}, {1, 1, 0},      {-1, -1, 1},    {1, -1, -1},    {-1, 1, 1}};
  for (const Vec3& end : ends) AddCable(def, {{0, {0, 0, 0}}, {kWorld, end}}, 100, 1);
  const ForceAnalysis found = AnalyseForces(def);
  EXPECT_EQ(found.unknowns, 3);
  EXPECT_EQ(found.rank.rank, 3);
  ASSERT_EQ(found.self_stress.size(), 7U);
  EXPECT_TRUE(found.self_stress[0].feasible);
  for (const SelfStress& state : found.self_stress) {
    Vec3 sum;
    for (std::size_t c = 0; c < 10; ++c) sum = sum + state.density_n_per_m[c] * ends[c];
    EXPECT_LT(std::sqrt(Dot(sum, sum)), 1e-12);
  }
}

// All cables on one side of a plane: their resultant always points there.
TEST(ForceAnalysis, NoStateIsFeasibleWhereAllPullOneWay) {
  ModelDef def;
  AddPoint(def, "p", {0, 0, 0}, 1);
  for (const Vec3& end : {Vec3{1, 0, 1}, Vec3{-1, 0.1, 1}, Vec3{0, 1, 1}, Vec3{0.2, -1, 1}}) {
    AddCable(def, {{0, {0, 0, 0}}, {kWorld, end}}, 100, 1);
  }
  const ForceAnalysis found = AnalyseForces(def);
  ASSERT_EQ(found.self_stress.size(), 1U);
  EXPECT_FALSE(found.self_stress[0].feasible);
  EXPECT_TRUE(found.mechanism_stiffness.empty());
}

TEST(ForceAnalysis, ARankThatHangsOnRoundingIsNotClear) {
  ModelDef def;
  AddPoint(def, "p", {0, 0, 0}, 1);
  AddPoint(def, "q", {0, 0, 5}, 1);
  for (const double lift : {0.0, 3e-8}) {
    AddCable(def, {{0, {0, 0, 0}}, {kWorld, {1, 0, lift}}}, 100, 0.9);
  }
  for (const double lift : {0.0, 3e-10}) {
    AddCable(def, {{1, {0, 0, 5}}, {kWorld, {1, 0, 5 + lift}}}, 100, 0.9);
  }
  const ForceAnalysis found = AnalyseForces(def);
  EXPECT_EQ(found.rank.rank, 3);
  EXPECT_FALSE(found.rank.clear());
}

// An eyelet with friction splits a cable into two members; each constraint row of a joint and each
// bar is also a member.
TEST(ForceAnalysis, SpansBarsAndHeldDirectionsAreMembers) {
  ModelDef def;
  AddPoint(def, "p", {0, 0, 0}, 1);
  AddPoint(def, "q", {0, 1, 0}, 1);
  AddCable(def, {{kWorld, {-1, 0, 0}}, {0, {0, 0, 0}, 0.3}, {kWorld, {1, 0, 1}}}, 100, 2);
  AddBar(def, 0, {0, 0, 0}, 1, {0, 1, 0}, 1e4, 1);
  AddJoint(def, JointKind::kBall, kWorld, {0, 1, 0}, 1, {0, 1, 0});
  const ForceAnalysis found = AnalyseForces(def);
  ASSERT_EQ(found.members.size(), 6U);
  EXPECT_EQ(found.members[1].kind, StaticMember::Kind::kCable);
  EXPECT_EQ(found.members[1].part, 1);
  EXPECT_NEAR(found.members[1].length_m, std::sqrt(2.0), 1e-15);
  EXPECT_EQ(found.members[2].kind, StaticMember::Kind::kBar);
  EXPECT_EQ(found.members[5].kind, StaticMember::Kind::kHeld);
  EXPECT_EQ(found.members[5].part, 2);
  EXPECT_EQ(found.unknowns, 6);
  EXPECT_EQ(found.rank.rank, 6);
  EXPECT_TRUE(found.self_stress.empty());
}

}  // namespace
}  // namespace taut::test
