// Intervals of statically indeterminate forces, against lever laws and Coulomb's law
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "math/vec.h"
#include "taut/inverse_statics.h"
#include "tests/unit/analysis/holding_scenes.h"

namespace taut {
namespace {

using test::Body;
using test::CableTo;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBarWeight = 2 * 9.81;

ForceIntervals Find(const ModelDef& def, const IntervalOptions& options = {},
                    const LoadCaseSpec& loads = {}) {
  Diagnostics out;
  ForceIntervals found = FindForceIntervals(def, loads, options, out);
  EXPECT_TRUE(out.ok()) << out.Format();
  return found;
}

void ExpectInterval(const ForceInterval& interval, double low, double high) {
  EXPECT_NEAR(interval.low_n, low, 1e-6);
  if (std::isinf(high)) {
    EXPECT_EQ(interval.high_n, high);
  } else {
    EXPECT_NEAR(interval.high_n, high, 1e-6);
  }
  EXPECT_LT(interval.uncertain_n, 1e-5);
}

/// A body of 2 kg with its center of mass above a floor
ModelDef Table(const Vec3& com_m) {
  ModelDef def;
  def.bodies = {Body("table", 2, com_m)};
  return def;
}
std::vector<TouchDef> Feet(const std::vector<Vec3>& places, double friction) {
  std::vector<TouchDef> feet;
  for (const Vec3& place : places) feet.push_back({0, kWorld, place, {0, 0, 1}, friction});
  return feet;
}

TEST(ForceIntervals, FourFeetOfATableShareInManyWays) {
  IntervalOptions options;
  options.touches = Feet({{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}, 0);
  const ForceIntervals middle = Find(Table({0, 0, 0.3}), options);
  ASSERT_TRUE(middle.found) << middle.why;
  EXPECT_EQ(middle.undetermined, 1);
  for (const ForceInterval& foot : middle.touch) ExpectInterval(foot, 0, kBarWeight / 2);
  // The center of mass at (0.5, 0): N = W (3, 1, 1, 3) / 8 + a (1, -1, 1, -1)
  const ForceIntervals aside = Find(Table({0.5, 0, 0.3}), options);
  ASSERT_TRUE(aside.found) << aside.why;
  ExpectInterval(aside.touch[0], kBarWeight / 4, kBarWeight / 2);
  ExpectInterval(aside.touch[1], 0, kBarWeight / 4);
}

/// Bodies that are not connected by unknown forces are solved separately; a cable of known tension
/// does not connect.
TEST(ForceIntervals, EachPartByItselfIsAsInTheWhole) {
  ModelDef def = Table({0, 0, 0.3});
  def.bodies.push_back(Body("other", 1, {10, 0, 0.3}));
  def.bodies.push_back(Body("still", 1, {20, 0, 0.3}));
  def.bodies.back().fixed = true;
  IntervalOptions options;
  options.touches = Feet({{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}}, 0);
  for (TouchDef foot : Feet({{11, 1, 0}, {9, 1, 0}, {9, -1, 0}, {11, -1, 0}}, 0.5)) {
    foot.body = 1;
    options.touches.push_back(foot);
  }
  const ForceIntervals both = Find(def, options);
  ASSERT_TRUE(both.found) << both.why;
  EXPECT_EQ(both.undetermined, 1 + 6);
  ASSERT_EQ(both.touch.size(), 8u);
  for (std::size_t i = 0; i < 4; ++i) {
    ExpectInterval(both.touch[i], 0, kBarWeight / 2);
    ExpectInterval(both.touch[4 + i], 0, kBarWeight / 4);
  }
  // If any of the separate parts does not balance, it is reported by name.
  options.touches.resize(5);
  const ForceIntervals tips = Find(def, options);
  EXPECT_FALSE(tips.found);
  EXPECT_NE(tips.why.find("other"), std::string::npos) << tips.why;
  EXPECT_TRUE(tips.touch.empty());
}

/// Bars that a load case lengthens keep their change in the separate parts.
TEST(ForceIntervals, ABarThatIsLongerIsSoInItsPart) {
  ModelDef def;
  const double stretch_m = 9.81 / 1000;
  for (const int b : {0, 1}) {
    const double x = 5.0 * b, z = -(1 + stretch_m + 0.01 * b);
    def.bodies.push_back(Body(b == 0 ? "as_long" : "longer", 1, {x, 0, z}));
    JointDef bar;
    bar.name = def.bodies.back().name + "_bar", bar.kind = JointKind::kDistance;
    bar.body_b = b, bar.from_m = {x, 0, 0}, bar.to_m = {x, 0, z};
    bar.stiffness = 1000, bar.rest = 1;
    def.joints.push_back(bar);
  }
  LoadCaseSpec loads;
  EXPECT_FALSE(Find(def, {}, loads).found) << "the longer one pulls too much";
  loads.bars.push_back({1, 0.01});
  const ForceIntervals found = Find(def, {}, loads);
  ASSERT_TRUE(found.found) << found.why;
  ExpectInterval(found.joint_z[0], 9.81, 9.81);
  ExpectInterval(found.joint_z[1], 9.81, 9.81);
}

/// Two rods of a body with a common end contact the ground there once.
TEST(ForceIntervals, WhatEndsInOnePlaceTouchesOnce) {
  ModelDef def = Table({0, 0, 0.1});
  def.planes = {test::Plane("ground", {0, 0, 1}, 0.5)};
  for (const double x : {-1.0, 1.0}) {
    CapsuleDef rod;
    rod.body = 0, rod.radius_m = 0.1, rod.to_m = {0, 0, 0.1}, rod.from_m = {x, 0, 0.1};
    def.capsules.push_back(rod);
  }
  EXPECT_EQ(FindTouches(def, 1e-6).size(), 3u);
  def.capsules[1].to_m.x = 1e-3;
  EXPECT_EQ(FindTouches(def, 1e-6).size(), 4u);
}

/// A cable of unknown tension connects its bodies.
TEST(ForceIntervals, ACableOfUnknownTensionJoinsItsBodies) {
  ModelDef def;
  def.bodies = {Body("upper", 2, {0, 0, 1}), Body("lower", 1, {0, 0, 0})};
  def.cables = {CableTo("a", {0, 0, 2}, {0, 0, 1}), CableTo("b", {0, 0, 2}, {0, 0, 0})};
  def.cables[1].attachments = {{0, {0, 0, 1}}, {1, {0, 0, 0}}};
  IntervalOptions options;
  options.known_tensions = false;
  const ForceIntervals chain = Find(def, options);
  ASSERT_TRUE(chain.found) << chain.why;
  ExpectInterval(chain.cable[0], 3 * 9.81, 3 * 9.81);
  ExpectInterval(chain.cable[1], 9.81, 9.81);
}

// Friction does not change the normal forces, because it acts in the plane of the feet.
TEST(ForceIntervals, ThreeFeetAreDeterminateWithFrictionToo) {
  IntervalOptions options;
  options.touches = Feet({{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}}, 0.7);
  const ForceIntervals table = Find(Table({0, 0, 0.3}), options);
  ASSERT_TRUE(table.found) << table.why;
  EXPECT_EQ(table.undetermined, 3);
  for (const ForceInterval& foot : table.touch)
    ExpectInterval(foot, kBarWeight / 3, kBarWeight / 3);
}

TEST(ForceIntervals, ATableThatTipsIsNotHeld) {
  IntervalOptions options;
  options.touches = Feet({{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}}, 0.7);
  const ForceIntervals table = Find(Table({-0.7, 0, 0.3}), options);
  EXPECT_FALSE(table.found);
  ASSERT_EQ(table.left.size(), 1U);
  EXPECT_EQ(table.left[0].body, 0);
  EXPECT_NE(table.why.find("out of balance: table by"), std::string::npos) << table.why;
}

/// A ladder of 2 kg in a vertical plane rotated about z, so that friction is not along an initial
/// friction direction
struct Ladder {
  ModelDef def;
  IntervalOptions options;
};
Ladder LadderAt(double angle_rad, double floor_friction, double wall_friction) {
  const double turned = 0.3, across = 3 * std::cos(angle_rad), up = 3 * std::sin(angle_rad);
  const Vec3 ahead{std::cos(turned), std::sin(turned), 0};
  const Vec3 top = across * ahead + Vec3{0, 0, up};
  Ladder ladder;
  ladder.def.bodies = {Body("ladder", 2, 0.5 * top)};
  ladder.options.touches = {{0, kWorld, {}, {0, 0, 1}, floor_friction},
                            {0, kWorld, top, -1.0 * ahead, wall_friction}};
  return ladder;
}

// With r = cot(angle), friction F up the wall, N2 = r (W / 2 - F) at the wall, N1 = W - F at the
// floor: |F| <= m2 N2 and N2 <= m1 N1
TEST(ForceIntervals, ALadderAgainstAWall) {
  struct Case {
    double angle_rad, floor, wall;
  };
  for (const Case& c : {Case{1.1, 0.6, 0.4}, Case{0.9, 0.5, 0.5}, Case{1.3, 0.3, 0.2}}) {
    const Ladder ladder = LadderAt(c.angle_rad, c.floor, c.wall);
    const double r = 1 / std::tan(c.angle_rad), w = kBarWeight;
    const double most = c.wall * r * w / 2 / (1 + c.wall * r);
    double least = -c.wall * r * w / 2 / (1 - c.wall * r);
    if (r > c.floor) least = std::fmax(least, w * (r / 2 - c.floor) / (r - c.floor));
    const ForceIntervals found = Find(ladder.def, ladder.options);
    ASSERT_TRUE(found.found) << found.why;
    ExpectInterval(found.touch[0], w - most, w - least);
    ExpectInterval(found.touch[1], r * (w / 2 - most), r * (w / 2 - least));
  }
}

// At a smooth wall the ladder stands if half the cotangent is at most the floor's friction.
TEST(ForceIntervals, ALadderSlipsJustWhereItShould) {
  for (const double more : {0.001, -0.001}) {
    const Ladder ladder = LadderAt(std::atan(1 / (2 * 0.4)) + more, 0.4, 0);
    const ForceIntervals found = Find(ladder.def, ladder.options);
    EXPECT_EQ(found.found, more > 0) << found.why;
  }
}

// Between two walls the block is held by friction at any sufficiently large normal force.
TEST(ForceIntervals, AJamHasNoUpperLimit) {
  ModelDef def;
  def.bodies = {Body("block", 2, {0, 0, 0})};
  IntervalOptions options;
  options.touches = {{0, kWorld, {-1, 0, 0}, {1, 0, 0}, 0.25},
                     {0, kWorld, {1, 0, 0}, {-1, 0, 0}, 0.25}};
  const ForceIntervals found = Find(def, options);
  ASSERT_TRUE(found.found) << found.why;
  for (const ForceInterval& wall : found.touch)
    ExpectInterval(wall, kBarWeight / 2 / 0.25, kInfinity);
}

TEST(ForceIntervals, CablesThatMayPullAsTheyLikeWithinBounds) {
  ModelDef def;
  def.bodies = {Body("mass", 2, {0, 0, 0})};
  def.cables = {CableTo("above", {0, 0, 2}, {}), CableTo("below", {0, 0, -1}, {})};
  IntervalOptions options;
  options.known_tensions = false;
  options.bounds = {{0, 50}, {}};
  const ForceIntervals found = Find(def, options);
  ASSERT_TRUE(found.found) << found.why;
  ExpectInterval(found.cable[0], kBarWeight, 50);
  ExpectInterval(found.cable[1], 0, 50 - kBarWeight);
}

TEST(ForceIntervals, TensionsThatFollowFromRestLengthsAreKnown) {
  ModelDef def;
  def.bodies = {Body("mass", 2, {0, 0, 0})};
  def.cables = {CableTo("above", {0, 0, 2}, {})};
  def.cables[0].rest_length_m = 2 - 0.012;  // 12 N
  IntervalOptions options;
  options.touches = Feet({{0.5, 0, 0}, {-0.5, 0, 0}}, 0);
  const ForceIntervals found = Find(def, options);
  ASSERT_TRUE(found.found) << found.why;
  ExpectInterval(found.cable[0], 12, 12);
  for (const ForceInterval& foot : found.touch)
    ExpectInterval(foot, kBarWeight / 2 - 6, kBarWeight / 2 - 6);
}

// A beam on two fixed balls: each carries half the weight, with any axial force.
TEST(ForceIntervals, RedundantSupports) {
  ModelDef def;
  def.bodies = {Body("beam", 2, {0, 0, 0})};
  for (const double x : {-1.0, 1.0}) {
    JointDef ball;
    ball.name = "ball", ball.body_a = kWorld, ball.body_b = 0;
    ball.from_m = ball.to_m = {x, 0, 0};
    def.joints.push_back(ball);
  }
  const ForceIntervals found = Find(def);
  ASSERT_TRUE(found.found) << found.why;
  EXPECT_EQ(found.undetermined, 1);
  for (std::size_t j = 0; j < 2; ++j) {
    ExpectInterval(found.joint_z[j], kBarWeight / 2, kBarWeight / 2);
    ExpectInterval(found.joint_y[j], 0, 0);
    EXPECT_EQ(found.joint_x[j].low_n, -kInfinity);
    EXPECT_EQ(found.joint_x[j].high_n, kInfinity);
  }
}

TEST(ForceIntervals, TouchesAreFoundWhereShapesAreOnPlanes) {
  ModelDef def;
  def.bodies = {Body("box", 1, {0, 0, 0.5}), Body("rod", 1, {5, 0, 1})};
  BoxDef box;
  box.body = 0, box.center_m = {0, 0, 0.5}, box.half_extents_m = {0.4, 0.3, 0.5};
  box.material.static_friction = 0.9;
  def.boxes = {box};
  CapsuleDef rod;
  rod.body = 1, rod.from_m = {5, 0, 0.1}, rod.to_m = {6, 0, 2}, rod.radius_m = 0.1;
  rod.material.static_friction = 0.25;
  def.capsules = {rod};
  def.planes = {test::Plane("floor", {0, 0, 1}, 0.4)};
  const std::vector<TouchDef> touches = FindTouches(def, 1e-6);
  ASSERT_EQ(touches.size(), 5U);
  EXPECT_EQ(touches[4].body, 0);
  EXPECT_NEAR(touches[0].point_m.x, 5, 1e-12);
  EXPECT_NEAR(touches[0].point_m.z, 0, 1e-12);
  EXPECT_NEAR(touches[0].friction, std::sqrt(0.25 * 0.4), 1e-12);
  EXPECT_NEAR(touches[1].friction, 0.6, 1e-12);
}

}  // namespace
}  // namespace taut
