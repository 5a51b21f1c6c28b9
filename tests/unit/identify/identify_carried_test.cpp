// Check of whether measured forces carry the load: two cables and a bar at a ball, in closed form
#include <cmath>

#include "tests/unit/identify/identify_fixture.h"

namespace taut {
namespace {

using test::IdentifyTest;

/// Stiff, so that the ball and the directions stay as described: both cables at 45 degrees upward,
/// the bar straight downward. A third cable is not part of the cut.
const std::string kCarriedModel = R"(taut: 1
kind: model
name: held
parameters: {k_n_per_m: 1.0e7}
nodes: {left: [-1, 0, 1], right: [1, 0, 1], low: [0, 0, -1], far: [1, 0, 0.5], ball: [0, 0, 0]}
pairs:
  - {name: l, nodes: [left, ball], tags: [cable]}
  - {name: r, nodes: [ball, right], tags: [cable]}
  - {name: b, nodes: [low, ball], tags: [bar]}
  - {name: other, nodes: [right, far], tags: [cable_2]}
builders:
  - {match: left, anchor: {}}
  - {match: right, anchor: {}}
  - {match: low, anchor: {}}
  - {match: far, point_mass: {mass_kg: 1, radius_m: 0.01}}
  - {match: ball, point_mass: {mass_kg: 0.5, radius_m: 0.01}}
  - {match: cable, cable: {stiffness_n_per_m: k_n_per_m, damping_n_s_per_m: 8, rest_length_m: sqrt(2)}}
  - {match: cable_2, cable: {stiffness_n_per_m: 1000, damping_n_s_per_m: 8, rest_length_m: 0.5}}
  - {match: bar, bar: {stiffness_n_per_m: 1.0e5, rest_length_m: 1}}
)";
const std::string kCarriedExperiment = R"(taut: 1
kind: experiment
name: press
model: model.yaml
gravity_m_per_s2: [0, 0, -10]
duration_s: 1
load_cases:
  - {name: one, forces: [{node: ball, force_n: [0, 0, -10]}, {node: far, force_n: [0, 0, -3]}]}
  - {name: two, forces: [{node: ball, force_n: [2, 0, -25]}]}
  - {name: three, weight: false, forces: [{node: ball, force_n: [0, 0, -40]}]}
)";
const std::string kCarriedFit = R"(taut: 1
kind: fit
name: f
experiments: [{name: a, experiment: experiment.yaml, data: a.csv, forward: load_cases}]
estimate: [{parameter: k_n_per_m, scale: 1.0e6}]
residuals:
  - {channel: cable/*/tension_n, sd: 0.3, relative_sd: 0.1}
  - {channel: joint/*/axial_n, sd: 0.2}
carried: [{name: ball, bodies: [ball]}]
)";

class Carried : public IdentifyTest {
 protected:
  void SetUp() override {
    IdentifyTest::SetUp();
    Write("model.yaml", kCarriedModel);
    Write("experiment.yaml", kCarriedExperiment);
    Write("a.csv",
          "time_s,cable/l/tension_n,cable/r/tension_n,joint/b/axial_n,cable/other/tension_n\n"
          "0,8,9,-1,7\n1,14,17,-4,7\n2,22,23,-6,7\n");
  }
};

TEST_F(Carried, SharesAreThoseOfTheDrawing) {
  const auto fit = Make(kCarriedFit);
  ASSERT_TRUE(fit) << out_.Format();
  const auto all = fit->Carried();
  ASSERT_EQ(all.size(), 1u);
  const CarriedLoad& of = all[0];
  ASSERT_EQ(of.check.why, "");
  ASSERT_EQ(of.rows.size(), 3u);
  // The weight is 5 N except in the third case; a compressed bar carries, too.
  const double half = std::sqrt(0.5);
  const double applied[] = {15, 30, 40};
  const double carried[] = {17 * half + 1, 31 * half + 4, 45 * half + 6};
  // sd of a cable: a tenth of its force, at least 0.3 N; of the bar: 0.2 N.
  const double sd[] = {std::sqrt(0.5 * (0.8 * 0.8 + 0.9 * 0.9) + 0.04),
                       std::sqrt(0.5 * (1.4 * 1.4 + 1.7 * 1.7) + 0.04),
                       std::sqrt(0.5 * (2.2 * 2.2 + 2.3 * 2.3) + 0.04)};
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(of.rows[i].applied_n, applied[i], 1e-9);
    EXPECT_NEAR(of.rows[i].carried_n, carried[i], 1e-4);
    EXPECT_NEAR(of.rows[i].sd_n, sd[i], 1e-4);
    xx += applied[i] * applied[i] / (sd[i] * sd[i]);
    xy += applied[i] * carried[i] / (sd[i] * sd[i]);
  }
  EXPECT_EQ(of.rows[1].where, "load case two");
  EXPECT_NEAR(of.check.slope, xy / xx, 1e-5);
  EXPECT_GE(of.check.se, 1 / std::sqrt(xx));
  EXPECT_EQ(of.check.sentence.find("ball of a: measured forces carry "), 0u) << of.check.sentence;
}

TEST_F(Carried, ALoadToTheSideIsLookedAtInItsDirection) {
  const auto fit =
      Make(Replaced(kCarriedFit, "bodies: [ball]", "bodies: [ball], direction: [4, 0, 0]"));
  ASSERT_TRUE(fit) << out_.Format();
  const CarriedLoad of = fit->Carried()[0];
  ASSERT_EQ(of.check.why, "");
  EXPECT_NEAR(of.rows[0].applied_n, 0, 1e-9);
  EXPECT_NEAR(of.rows[1].applied_n, 2, 1e-9);
  // The right cable pulls the ball to the right, the same direction as the load: a negative share.
  EXPECT_NEAR(of.rows[1].carried_n, (14 - 17) * std::sqrt(0.5), 1e-4);
}

TEST_F(Carried, ARowThatLacksAForceIsNone) {
  Write(
      "a.csv",
      "time_s,cable/l/tension_n,cable/r/tension_n,joint/b/axial_n\n0,8,9,-1\n1,nan,17,-4\n2,22,23,-"
      "6\n");
  const auto fit = Make(kCarriedFit);
  ASSERT_TRUE(fit) << out_.Format();
  const CarriedLoad of = fit->Carried()[0];
  ASSERT_EQ(of.rows.size(), 2u);
  EXPECT_EQ(of.rows[1].where, "load case three");
}

TEST_F(Carried, AllMembersHaveToBeCompared) {
  EXPECT_EQ(
      Wrong(Replaced(Replaced(kCarriedFit, "cable/*/tension_n", "cable/r/tension_n"),
                     "  - {channel: joint/*/axial_n, sd: 0.2}\n", "")),
      "carried: ball of a: cable/l/tension_n is not compared (add all members between the "
      "bodies and the rest of the robot to `residuals`)\n"
      "carried: ball of a: joint/b/axial_n is not compared (add all members between the bodies "
      "and the rest of the robot to `residuals`)\n");
}

TEST_F(Carried, WhatElseHoldsTheBodiesIsSaid) {
  EXPECT_EQ(Wrong(Replaced(kCarriedFit, "bodies: [ball]", "bodies: [ball, fer]")),
            "carried.bodies: a has no body \"fer\" (did you mean \"far\"?)\n");
  Write("model.yaml", Replaced(kCarriedModel, "ball, point_mass: {", "ball, sphere: {"));
  Write("experiment.yaml",
        kCarriedExperiment + "terrain: [{name: ground, plane: {height_m: -0.0099}}]\n");
  const auto fit = Make(kCarriedFit);
  ASSERT_TRUE(fit) << out_.Format();
  const CarriedLoad of = fit->Carried()[0];
  EXPECT_EQ(of.check.why.find("other supports than members, such as the ground, hold the bodies: "),
            0u)
      << "[" << of.check.why << "]";
}

TEST_F(Carried, MistakesOfTheFileAreSaidAtOnce) {
  EXPECT_EQ(
      Wrong(Replaced(Replaced(kCarriedFit, "forward: load_cases", "forward: dynamic"),
                     "bodies: [ball]", "bodies: [ball], experiments: [a], direction: [0, 0, 0]")),
      "carried.direction must not be zero\n"
      "carried: a is dynamic, but carried loads are compared at rest (write `forward: static` or "
      "`forward: load_cases`)\n");
  EXPECT_EQ(
      Wrong(Replaced(kCarriedFit, "forward: load_cases", "forward: dynamic")),
      "carried: no experiment is at rest (write `forward: static` or `forward: load_cases`)\n");
}

TEST_F(Carried, WorkThatIsSharedOutHasTheSameBits) {
  const auto fit = Make(kCarriedFit), other = Make(kCarriedFit), third = Make(kCarriedFit);
  ASSERT_TRUE(fit && other && third) << out_.Format();
  EXPECT_EQ(fit->Agreed(), other->Agreed());
  const std::vector<std::vector<double>> points{{1e7}, {2e7}, {-1}, {3e7}, {4e7}};
  const auto alone = third->train().forward(points);
  std::size_t asked = 0;
  fit->SpreadBy(
      [&](std::span<const std::string> pieces) {
        asked += pieces.size();
        std::vector<std::string> answers;
        for (const std::string& piece : pieces) answers.push_back(other->Do({&piece, 1})[0]);
        return answers;
      },
      2);
  const auto shared = fit->train().forward(points);
  EXPECT_EQ(asked, 5u);
  ASSERT_EQ(shared.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(shared[i].value, alone[i].value);
    EXPECT_EQ(shared[i].failed, alone[i].failed);
  }
  EXPECT_NE(shared[2].failed, "");
  // A stopped process returns fewer results, which count as no results.
  fit->SpreadBy([](std::span<const std::string>) { return std::vector<std::string>{}; }, 2);
  EXPECT_EQ(fit->train().forward(std::vector<std::vector<double>>{{5e7}}).size(), 0u);
  // Fits with different residuals must not share results.
  const auto less =
      Make(Replaced(kCarriedFit, "cable/*/tension_n, sd: 0.3", "cable/*/tension_n, sd: 0.31"));
  EXPECT_NE(fit->Agreed(), less->Agreed());
}

}  // namespace
}  // namespace taut
