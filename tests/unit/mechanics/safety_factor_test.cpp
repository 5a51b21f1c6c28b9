// Safety factors of members (taut/safety.h), against handbook values
#include "taut/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

/// A steel tube of 20 mm by 1 mm, 1.5 m long, as a bar between two bodies and as a rod
MemberDef Tube() {
  MemberDef member;
  member.young_pa = 210e9;
  member.area_m2 = std::numbers::pi * (0.01 * 0.01 - 0.009 * 0.009);
  member.second_moment_m4 = std::numbers::pi / 4 * (std::pow(0.01, 4) - std::pow(0.009, 4));
  member.yield_pa = 235e6;
  member.strength_n = 20e3;
  return member;
}

ModelDef Members() {
  ModelDef def;
  scenes::AddRod(def, "rod", 1, 0.01, {0, 0, 0}, {0, 0, 1.5}, {});
  def.capsules[0].member = Tube();
  JointDef bar;
  bar.name = "bar", bar.kind = JointKind::kDistance, bar.body_b = 0;
  bar.to_m = {0, 0, 0}, bar.from_m = {1.5, 0, 0}, bar.stiffness = 1e6;
  bar.member = Tube();
  def.joints.push_back(bar);
  JointDef pin = bar;
  pin.name = "pin", pin.kind = JointKind::kBall, pin.stiffness = 0;
  def.joints.push_back(pin);
  CableDef cable;
  cable.name = "rope", cable.member.strength_n = 500;
  def.cables = {cable, cable};
  def.cables[1].name = "loose";
  return def;
}

/// An equilibrium is found with a rounding error, which is no effect of the load.
TEST(Safety, ATensionThatOnlyRoundingReducesHasNoFactorOfSlack) {
  MemberForces now, before;
  now.cable_tension_n = {100 * (1 - 1e-12), 100 * (1 - 1e-6)};
  now.bar_force_n = {0, 0};
  now.struts = {{0, {0, 0, 0}}};
  before = now;
  before.cable_tension_n = {100, 100};
  const auto loads = MemberLoads(Members(), now, &before);
  EXPECT_FALSE(loads[0].slackening);
  EXPECT_NEAR(loads[1].slackening.value_or(0), 1e6, 1);
}

TEST(Safety, FactorsAreThoseOfTheHandbook) {
  MemberForces now;
  now.cable_tension_n = {100, 0};
  now.bar_force_n = {-2000, 0};
  now.struts = {{0, {0, -1000, 3000}}};
  MemberForces before = now;
  before.cable_tension_n = {150, 20};
  const auto loads = MemberLoads(Members(), now, &before);
  ASSERT_EQ(loads.size(), 4u);
  EXPECT_EQ(loads[0].name, "rope");
  EXPECT_EQ(*loads[0].strength, 5);
  EXPECT_EQ(*loads[0].slackening, 3);  // the load reduces the tension by a third
  // This cable goes slack at 3 times the load and breaks at 5 times: two separate factors.
  EXPECT_EQ(loads[0].LeastOf(), "strength");
  EXPECT_EQ(*loads[0].Least(), 5);
  EXPECT_FALSE(loads[0].slack);
  EXPECT_TRUE(loads[1].slack);
  EXPECT_EQ(*loads[1].slackening, 1);
  EXPECT_FALSE(loads[1].strength);
  EXPECT_FALSE(loads[1].Least()) << "slack is no failure";
  // I = 2700.97 mm^4, A = 59.690 mm^2: Euler 2488.0 N over 1.5 m, yield 14 027 N
  EXPECT_EQ(loads[2].kind, MemberKind::kBar);
  EXPECT_NEAR(*loads[2].buckling, 2488.0 / 2000, 1e-4);
  EXPECT_NEAR(*loads[2].yield, 14027.2 / 2000, 1e-4);
  EXPECT_FALSE(loads[2].strength);
  EXPECT_EQ(loads[2].LeastOf(), "buckling");
  EXPECT_EQ(loads[3].kind, MemberKind::kRod);
  EXPECT_NEAR(*loads[3].buckling, 2.4880, 1e-4);
  EXPECT_NEAR(*loads[3].yield, 14027.2 / 3000, 1e-4);
  EXPECT_NEAR(*loads[3].strength, 20.0 / 3, 1e-12);
}

TEST(Safety, ABucklingLengthOfItsOwnCounts) {
  ModelDef def = Members();
  MemberForces now;
  now.cable_tension_n = {0, 0};
  now.bar_force_n = {-2000, 0};
  const double whole = *MemberLoads(def, now)[2].buckling;
  def.joints[0].member.buckling_length_m = 0.75;
  EXPECT_NEAR(*MemberLoads(def, now)[2].buckling, 4 * whole, 1e-12);
}

TEST(Safety, WhatIsNotKnownOrNotCarriedHasNoFactor) {
  ModelDef def = Members();
  def.joints[0].member = {};
  MemberForces now;
  now.cable_tension_n = {0, 0};
  now.bar_force_n = {-2000, 0};
  now.struts = {{0, {50, 40, 60}}};
  const auto loads = MemberLoads(def, now);
  for (const std::size_t i : {0u, 1u, 2u}) EXPECT_FALSE(loads[i].Least()) << loads[i].name;
  EXPECT_FALSE(loads[3].buckling) << "it is pulled only";
  EXPECT_TRUE(loads[3].yield);
}

}  // namespace
}  // namespace taut::test
