// Results of an experiment at rest: signs, places, and independence of the preceding case
#include <cmath>

#include "identify/computed.h"
#include "tests/unit/identify/identify_fixture.h"

namespace taut {
namespace {

using test::Height;
using test::IdentifyTest;
using test::kHangingModel;

const std::string kRestsFit = R"(taut: 1
kind: fit
name: f
experiments: [{name: a, experiment: experiment.yaml, data: a.csv, forward: load_cases}]
estimate: [{parameter: k_n_per_m, scale: 20}]
residuals: [{channel: "*", sd: 0.001}]
)";
std::string Experiment(const std::string& cases) {
  return "taut: 1\nkind: experiment\nname: e\nmodel: model.yaml\ngravity_m_per_s2: [0, 0, -10]\n"
         "duration_s: 1\nload_cases:\n" +
         cases;
}

class Rests : public IdentifyTest {};

TEST_F(Rests, ACaseHasNothingOfTheOneBefore) {
  Write("experiment.yaml",
        Experiment("  - {name: longer, rest_lengths: [{members: c, by_m: 0.05}]}\n"
                   "  - {name: pulled, forces: [{node: ball, force_n: [0, 0, -3]}]}\n"
                   "  - {name: plain}\n"));
  Write("a.csv", "time_s,node/ball/position_z_m\n0,0\n1,0\n2,0\n");
  const auto fit = Make(kRestsFit);
  ASSERT_TRUE(fit) << out_.Format();
  const auto at = At(*fit, {100}).value;
  EXPECT_NEAR(at[0] * 0.001, Height(0.95, 100), 1e-7);
  EXPECT_NEAR(at[1] * 0.001, Height(0.9, 100) - 0.03, 1e-7);
  EXPECT_NEAR(at[2] * 0.001, Height(0.9, 100), 1e-7);
}

TEST_F(Rests, NodesOfARodAreWhereItHangs) {
  // A rod of 1 m below the cable, whose end is fixed to it.
  std::string model =
      Replaced(kHangingModel, "ball: [0, 0, 0]}", "ball: [0, 0, 0], end: [0, 0, -1]}");
  model = Replaced(model, "tags: [cable]}]",
                   "tags: [cable]}, {name: r, nodes: [ball, end], tags: [rod]}]");
  model = Replaced(model, "{match: ball, point_mass: {mass_kg: mass_kg, radius_m: 0.01}}",
                   "{match: rod, rod: {mass_kg: mass_kg, radius_m: 0.01}}");
  Write("model.yaml", model);
  Write("experiment.yaml", Experiment("  - {name: plain}\n"));
  Write("a.csv",
        "time_s,node/ball/position_z_m,node/end/position_z_m,node/top/position_z_m\n0,0,0,0\n");
  const auto fit = Make(kRestsFit);
  ASSERT_TRUE(fit) << out_.Format();
  const auto at = At(*fit, {110}).value;
  ASSERT_EQ(at.size(), 3u);
  EXPECT_NEAR(at[0] * 0.001, Height(0.9, 110), 1e-7);
  EXPECT_NEAR(at[1] * 0.001, Height(0.9, 110) - 1, 1e-7);
  EXPECT_NEAR(at[2] * 0.001, 1, 1e-12);
}

TEST_F(Rests, ABarThatIsPulledHasAForceAboveZero) {
  Write("model.yaml", Replaced(Replaced(kHangingModel,
                                        "cable: {stiffness_n_per_m: k_n_per_m, damping_n_s_per_m: "
                                        "8, rest_length_m: 0.9, actuator: {ideal: true}}",
                                        "bar: {stiffness_n_per_m: k_n_per_m, rest_length_m: 0.9}"),
                               "tags: [cable]", "tags: [cable]"));
  Write("experiment.yaml", Experiment("  - {name: plain}\n"));
  Write("a.csv", "time_s,joint/c/axial_n,node/ball/position_z_m\n0,0,0\n");
  const auto fit = Make(kRestsFit);
  ASSERT_TRUE(fit) << out_.Format();
  const auto at = At(*fit, {110}).value;
  EXPECT_NEAR(at[0] * 0.001, 5, 1e-6);
  EXPECT_NEAR(at[1] * 0.001, Height(0.9, 110), 1e-7);
}

TEST_F(Rests, APushActsNoLongerThanItLasts) {
  Write("experiment.yaml",
        "taut: 1\nkind: experiment\nname: p\nmodel: model.yaml\ngravity_m_per_s2: [0, 0, -10]\n"
        "duration_s: 6\ntimeline:\n  events:\n"
        "    - push: {name: p, node: ball, direction: [0, 0, -1], force_n: [[0, 0], [1, 2], [2, "
        "2]]}\n"
        "    - push: {name: q, node: ball, direction: [0, 0, -1], force_n: [[3, 0], [4, 1], [5, "
        "1]]}\n");
  Write("a.csv", "time_s,node/ball/position_z_m\n1,0\n4,0\n");
  const auto fit = Make(Replaced(Replaced(kRestsFit, "load_cases", "static"), "sd: 0.001",
                                 "sd: 0.001, window: {after_setpoint_s: [-0.1, 0.1]}"));
  ASSERT_TRUE(fit) << out_.Format();
  const auto at = At(*fit, {100}).value;
  EXPECT_NEAR(at[0] * 0.001, Height(0.9, 100) - 0.02, 1e-7);
  EXPECT_NEAR(at[1] * 0.001, Height(0.9, 100) - 0.01, 1e-7);
}

TEST_F(Rests, MomentsOfAllItsMeasurementsAreLookedAtInOrder) {
  // Two measurements of one experiment: the second uses an earlier set point than the first.
  Write("a.csv", "time_s,node/ball/position_z_m\n3.6,0\n");
  Write("b.csv", "time_s,node/ball/position_z_m\n1.1,0\n");
  Write("a_when.csv", "time_s,experiment_s\n3.6,3.6\n");
  Write("b_when.csv", "time_s,experiment_s\n1.1,1.1\n");
  const auto fit = Make(Replaced(
      Replaced(Replaced(kRestsFit, "load_cases}",
                        "static, setpoints: a_when.csv}, {name: b, experiment: experiment.yaml, "
                        "data: b.csv, forward: static, setpoints: b_when.csv}"),
               "sd: 0.001", "sd: 0.001, window: {after_setpoint_s: [-0.1, 0.1]}"),
      "scale: 20}", "scale: 20}, {channel: \"*\", offset: {sd: 1}}"));
  ASSERT_TRUE(fit) << out_.Format();
  const std::vector<std::vector<double>> points{{100, 0}, {100, 0.5}};
  const auto answers = fit->train().forward(points);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_NEAR(answers[0].value[0] * 0.001, Height(0.7, 100), 1e-7);
  EXPECT_NEAR(answers[0].value[1] * 0.001, Height(0.8, 100), 1e-7);
  EXPECT_NEAR(answers[1].value[1] * 0.001, Height(0.8, 100) + 0.5, 1e-7);
  EXPECT_EQ(fit->counts().computed, 1);  // offsets alone cause no new computation
}

TEST_F(Rests, WhatActsByItsSquareIsNoMistake) {
  Write("experiment.yaml",
        Replaced(Experiment("  - {name: side, forces: [{node: ball, force_n: [side_n, 0, 0]}]}\n"),
                 "duration_s: 1", "duration_s: 1\nparameters: {side_n: 0}"));
  Write("a.csv", "time_s,node/ball/position_z_m\n0,0\n");
  const std::string text = Replaced(kRestsFit, "{parameter: k_n_per_m, scale: 20}",
                                    "{parameter: side_n, prior: {sd: 2}}");
  const auto fit = Make(text);
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_TRUE(CheckDependence(*fit, out_)) << out_.Format();
  // The force is perpendicular to the measured direction: the channel does not depend on it.
  Write("a.csv", "time_s,node/ball/position_y_m\n0,0\n");
  const auto blind = Make(text);
  ASSERT_TRUE(blind) << out_.Format();
  EXPECT_FALSE(CheckDependence(*blind, out_));
}

TEST_F(Rests, AFittedExperimentSaysWhatActsOnItAndWhereItBelongs) {
  std::filesystem::copy_file(folder_ / "a.csv", folder_ / "b.csv",
                             std::filesystem::copy_options::overwrite_existing);
  const auto fit = Make(
      "taut: 1\nkind: fit\nname: f\nexperiments:\n"
      "  - {name: a, experiment: experiment.yaml, data: a.csv, forward: static}\n"
      "  - {name: b, experiment: experiment.yaml, data: b.csv, forward: static, set: {mass_kg: "
      "0.75}}\n"
      "estimate: [{parameter: k_n_per_m, scale: 5}, {parameter: up_m, scale: 0.01, experiments: "
      "[b]}, {channel: \"*\", offset: {sd: 1}}]\nresiduals: [{channel: node/ball/position_z_m, sd: "
      "0.001, window: {after_setpoint_s: [1, 2]}}]\n");
  ASSERT_TRUE(fit) << out_.Format();
  const std::vector<double> values{112.5, 0.25, 0.5};
  EXPECT_EQ(FittedExperimentYaml(*fit, 0, values, folder_.string()),
            "# a with the values found by the fit f\ntaut: 1\nkind: experiment\nname: f_a\n"
            "base: experiment.yaml\nset:\n  k_n_per_m: 112.5\n");
  EXPECT_EQ(FittedExperimentYaml(*fit, 1, values, folder_.string()),
            "# b with the values found by the fit f\ntaut: 1\nkind: experiment\nname: f_b\n"
            "base: experiment.yaml\nparameters:\n  up_m: 0.25\nset:\n  k_n_per_m: 112.5\n  "
            "mass_kg: 0.75\n");
}

TEST_F(Rests, ARunThatBlowsUpSaysItself) {
  Write("experiment.yaml",
        "taut: 1\nkind: experiment\nname: e\nmodel: model.yaml\nduration_s: 0.02\n");
  Write("a.csv", "time_s,node/ball/position_z_m\n0,0\n");
  const auto fit = Make(Replaced(kRestsFit, ", forward: load_cases", ""));
  ASSERT_TRUE(fit) << out_.Format();
  const Residuals at = At(*fit, {1e308});
  EXPECT_NE(at.failed, "");
  EXPECT_EQ(at.failed.find("no value"), std::string::npos) << at.failed;
}

TEST(Computed, AsBytesKeepsItsBits) {
  identify::Computed one;
  one.failed = "why", one.stopped = true;
  one.time_s = {0.1, -0.0, 1e-310};
  one.values = {{1, NAN}, {}, {INFINITY}};
  one.references = {{2.5}, {-1, 7}};
  const identify::Computed two = identify::UnpackComputed(identify::Pack(one));
  EXPECT_EQ(two.failed, one.failed);
  EXPECT_EQ(two.stopped, one.stopped);
  EXPECT_EQ(two.time_s, one.time_s);
  EXPECT_TRUE(std::signbit(two.time_s[1]));
  ASSERT_EQ(two.values.size(), 3u);
  EXPECT_TRUE(std::isnan(two.values[0][1]));
  EXPECT_EQ(two.values[2], one.values[2]);
  EXPECT_EQ(two.references, one.references);
  // Truncated bytes yield at most the contained values.
  const std::string bytes = identify::Pack(one);
  EXPECT_LE(identify::UnpackComputed(bytes.substr(0, bytes.size() / 2)).values.size(), 3u);
}

TEST(TurnOf, IsTheSameOfAQuaternionAndItsNegative) {
  for (const double angle_rad : {0.4, 2.0, -3.0}) {
    const double c = std::cos(0.5 * angle_rad), s = std::sin(0.5 * angle_rad);
    EXPECT_NEAR(identify::TurnOf({-c, 0, 0, -s}).z, angle_rad, 1e-12);
    EXPECT_NEAR(identify::TurnOf({c, 0, 0, s}).z, angle_rad, 1e-12);
  }
}

}  // namespace
}  // namespace taut
