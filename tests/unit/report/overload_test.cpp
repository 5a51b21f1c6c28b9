// Overloaded members of a run: name, force, time, and the outputs that report them
#include <cmath>
#include <numbers>

#include "taut/live.h"
#include "taut/summary.h"
#include "tests/constants.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/hanging_mass.h"
#include "tests/scenes/rod.h"
#include "unit/plant/recorder_fixture.h"

namespace taut::test {
namespace {

/// Records rows at the start and the end only: the peak in between is not recorded.
RunSummary SummaryOf(const ModelDef& def, double duration_s) {
  ExperimentSpec experiment = RecordedExperiment(def, duration_s, {"*"});
  experiment.record.rate_hz = 1 / duration_s;
  return Recording(experiment).summary;
}

/// A mass released at the rest length: T = m g (1 - cos(w t))
ModelDef LetGo(double strength_n) {
  ModelDef def = scenes::HangingMass().Def();
  def.cables[0].member.strength_n = strength_n;
  return def;
}

TEST(Overload, ACableBeyondItsStrengthIsSaidWithItsLargestTensionAndTheTime) {
  const scenes::HangingMass scene;
  const double weight_n = scene.mass_kg * kG;
  const double w = std::sqrt(scene.stiffness_n_per_m / scene.mass_kg);
  const double strength_n = 0.5;
  const RunSummary run = SummaryOf(LetGo(strength_n), 2 * 3.14159265358979 / w);  // at rest again
  ASSERT_EQ(run.overloads.size(), 1u);
  const Overload& cable = run.overloads[0];
  EXPECT_EQ(cable.kind, MemberKind::kCable);
  EXPECT_EQ(cable.name, "cable");
  EXPECT_EQ(cable.limit, MemberLimit::kStrength);
  EXPECT_EQ(cable.bears_n, strength_n);
  EXPECT_EQ(cable.carried_n, run.cables[0].tension.max_n);
  EXPECT_NEAR(cable.carried_n, 2 * weight_n, 1e-3 * weight_n);
  const double when_s = std::acos(1 - strength_n / weight_n) / w;
  EXPECT_GE(cable.first_time_s, when_s - 1e-4);
  EXPECT_LE(cable.first_time_s, when_s + 1.1e-3) << "a step later";
  EXPECT_EQ(run.status.bits, kStatusOverloaded);
  EXPECT_EQ(run.status.first_time_s, cable.first_time_s);
  EXPECT_EQ(run.status_text, Describe(cable));
}

TEST(Overload, WhatHoldsIsNotMentioned) {
  for (const double strength_n : {0.0, 2.1 * 0.5 * kG}) {
    const RunSummary run = SummaryOf(LetGo(strength_n), 0.3);
    EXPECT_TRUE(run.overloads.empty()) << strength_n;
    EXPECT_EQ(run.status.bits, kStatusOk) << strength_n;
    EXPECT_EQ(run.status_text, "") << strength_n;
  }
}

TEST(Overload, OfACableWithFrictionTheTightestSpanCounts) {
  // Over an edge with a wrap angle of a quarter turn: the span at the weight has a higher tension
  // than the first span.
  ModelDef def;
  BodyDef mass;
  mass.name = "mass";
  mass.mass_kg = 1;
  mass.com_m = {0.1, 0, -0.1};
  mass.inertia_kg_m2 = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  def.bodies.push_back(mass);
  CableDef cable = SoftCable("rope", {{kWorld, {0, 0, 0}}, {kWorld, {0.1, 0, 0}}, {0, mass.com_m}},
                             1e3, 0.2 - 1e-3);
  cable.attachments[1].friction = 0.3;
  cable.member.strength_n = 5;
  def.cables.push_back(cable);
  const RunSummary run = SummaryOf(def, 0.2);
  ASSERT_EQ(run.overloads.size(), 1u);
  EXPECT_GT(run.overloads[0].carried_n, 1.2 * run.cables[0].tension.max_n);
}

/// 1 kg upright on a bar that its weight has shortened
ModelDef OnABar(const MemberDef& member) {
  ModelDef def;
  BodyDef mass;
  mass.name = "mass";
  mass.mass_kg = 1;
  mass.com_m = {0, 0, 1};
  mass.inertia_kg_m2 = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  def.bodies.push_back(mass);
  JointDef bar;
  bar.name = "bar", bar.kind = JointKind::kDistance;
  bar.body_a = kWorld, bar.body_b = 0;
  bar.from_m = {0, 0, 0}, bar.to_m = {0, 0, 1};
  bar.stiffness = 1e5, bar.rest = 1 + kG / 1e5;
  bar.member = member;
  def.joints.push_back(bar);
  return def;
}

TEST(Overload, ABarThatBucklesAndYieldsIsSaidTwice) {
  MemberDef member;
  member.young_pa = 1e9;
  member.second_moment_m4 =
      0.5 * kG / (std::numbers::pi * std::numbers::pi * 1e9);  // buckles at half the weight
  member.area_m2 = 1e-6;
  member.yield_pa = 0.75 * kG / 1e-6;
  member.strength_n = 1;  // applies to tension only
  const RunSummary run = SummaryOf(OnABar(member), 0.02);
  ASSERT_EQ(run.overloads.size(), 2u);
  EXPECT_EQ(run.overloads[0].limit, MemberLimit::kYield);
  EXPECT_NEAR(run.overloads[0].bears_n, 0.75 * kG, 1e-12);
  EXPECT_EQ(run.overloads[1].limit, MemberLimit::kBuckling);
  EXPECT_NEAR(run.overloads[1].bears_n, 0.5 * kG, 1e-12);
  for (const Overload& one : run.overloads) {
    EXPECT_EQ(one.kind, MemberKind::kBar);
    EXPECT_EQ(one.name, "bar");
    EXPECT_NEAR(one.carried_n, kG, 1e-3);
    EXPECT_NEAR(one.first_time_s, 1e-3, 1e-12) << "a joint's force is that of a step";
  }
  EXPECT_NE(run.status_text.find("; and one more limit of a member was exceeded"),
            std::string::npos);
  member.second_moment_m4 *= 4, member.yield_pa *= 4;
  EXPECT_TRUE(SummaryOf(OnABar(member), 0.02).overloads.empty());
}

/// A rod of 0.3 kg that falls on its end from 1 cm and stands: between two rows it lands with m v =
/// m sqrt(2 g 0.01 m) in one step.
TEST(Overload, ARodIsLookedAtBetweenRows) {
  ModelDef def;
  scenes::AddRod(def, "rod", 0.3, 0.01, {0, 0, 0.02}, {0, 0, 0.42}, {});
  scenes::AddGround(def, {});
  const double load_n = 50;
  def.capsules[0].member.young_pa = 1e9;
  def.capsules[0].member.second_moment_m4 =
      load_n * 0.4 * 0.4 / (std::numbers::pi * std::numbers::pi * 1e9);
  const RunSummary run = SummaryOf(def, 0.1);
  ASSERT_EQ(run.struts.size(), 1u);
  EXPECT_GT(run.struts[0].least_n, -0.31 * kG) << "or the rows have it, too";
  ASSERT_EQ(run.overloads.size(), 1u);
  EXPECT_EQ(run.overloads[0].kind, MemberKind::kRod);
  EXPECT_EQ(run.overloads[0].name, "rod");
  EXPECT_EQ(run.overloads[0].limit, MemberLimit::kBuckling);
  EXPECT_NEAR(run.overloads[0].bears_n, load_n, 1e-9);
  // The impact takes one or two steps; the weight adds to it.
  const double momentum = 0.3 * std::sqrt(2 * kG * 0.01);
  EXPECT_GT(run.overloads[0].carried_n, 0.5 * momentum / 1e-3);
  EXPECT_LT(run.overloads[0].carried_n, 1.1 * momentum / 1e-3);
  EXPECT_NEAR(run.overloads[0].first_time_s, std::sqrt(2 * 0.01 / kG), 2e-3);
}

TEST(Overload, ALiveRunFindsTheSame) {
  ExperimentSpec experiment = RecordedExperiment(LetGo(0.5), 0.1, {"*"});
  const RunSummary run = Recording(experiment).summary;
  Diagnostics out;
  const auto live = LiveRun::Start(experiment, out);
  ASSERT_TRUE(live) << out.Format();
  EXPECT_TRUE(live->Overloads().empty());
  while (live->time_s() < 0.1 - 1e-9) live->Step();
  ASSERT_EQ(live->Overloads().size(), 1u);
  EXPECT_EQ(live->Overloads()[0].carried_n, run.overloads[0].carried_n);
  EXPECT_EQ(live->Overloads()[0].first_time_s, run.overloads[0].first_time_s);
}

/// Traces, summaries and overloads use means over the steps (docs/theory/cables.md, section 3): 1 g
/// on 1e7 N/m, half of critical, is at rest after 0.06 ms.
TEST(StiffCable, RowsAndLargestTensionOfALightMassAreItsWeight) {
  scenes::HangingMass scene;
  scene.mass_kg = 1e-3;
  scene.stiffness_n_per_m = 1e7;
  scene.damping_n_s_per_m = 100;
  ModelDef def = scene.Def();
  const double weight_n = scene.mass_kg * kG;
  def.cables[0].member.strength_n = 1.03 * weight_n;
  const Recording run(RecordedExperiment(def, 0.3, {"*"}));
  for (std::size_t row = 1; row < run.rows(); ++row) {
    ASSERT_NEAR(run.At("cable/cable/tension_n", row), weight_n, 0.02 * weight_n) << row;
  }
  EXPECT_NEAR(run.Last("cable/cable/tension_n"), weight_n, 1e-3 * weight_n);
  EXPECT_NEAR(run.Last("cable/cable/elastic_n"), weight_n, 1e-3 * weight_n);
  EXPECT_NEAR(run.summary.system_max_tension_n, weight_n, 0.02 * weight_n);
  EXPECT_TRUE(run.summary.overloads.empty());
}

}  // namespace
}  // namespace taut::test
