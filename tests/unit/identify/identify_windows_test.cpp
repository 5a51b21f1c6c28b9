// Pairing of run values with data: windows, statistics, clocks, references, and transformations
#include <cmath>

#include "identify/residual_rows.h"
#include "learn/sqlite.h"
#include "tests/unit/identify/identify_fixture.h"

namespace taut {
namespace {

using identify::Computed;
using identify::Row;
using test::Height;
using test::IdentifyTest;
using test::kFit;

/// Returns values 0, 2, 2, 6 at 0, 1, 3, 4 s, linear in between.
Computed Course() {
  Computed out;
  out.time_s = {0, 1, 3, 4};
  out.values = {{9, 9, 9, 9}, {0, 2, 2, 6}};
  return out;
}

double Of(Row::How how, double from_s, double to_s, double delay_s = 0) {
  Row row;
  row.how = how;
  row.from_s = from_s, row.to_s = to_s;
  return *identify::ValueOf(row, Course(), {1, {}}, delay_s);
}

TEST(RowsOfARun, AreStatisticsOfStraightLines) {
  EXPECT_NEAR(Of(Row::How::kAt, 3.25, 3.25), 3, 1e-12);
  EXPECT_NEAR(Of(Row::How::kMean, 0.5, 3.5), (0.75 + 4 + 1.5) / 3, 1e-12);
  EXPECT_NEAR(Of(Row::How::kMean, 0.5, 0.75), 1.25, 1e-12);  // between two rows
  EXPECT_NEAR(Of(Row::How::kMax, 0.5, 3.5), 4, 1e-12);
  EXPECT_NEAR(Of(Row::How::kMin, 0.5, 3.5), 1, 1e-12);
  EXPECT_NEAR(Of(Row::How::kMean, 2.5, 3.5, 2), 0.75 + 1, 1e-12);  // of 0.5 to 1.5 s
  EXPECT_NEAR(Of(Row::How::kMax, 3, 9), 6, 1e-12);                 // up to the end of the run
  Row row;
  row.how = Row::How::kRest;
  row.from_s = 3;
  EXPECT_EQ(*identify::ValueOf(row, Course(), {1, {}}, 0), 2);
  row.from_s = 5;
  EXPECT_FALSE(identify::ValueOf(row, Course(), {1, {}}, 0));
}

namespace fs = std::filesystem;

class Windows : public IdentifyTest {
 protected:
  static std::string Dynamic(const std::string& residual) {
    return "taut: 1\nkind: fit\nname: f\n"
           "experiments: [{name: a, experiment: experiment.yaml, data: a.csv}]\n"
           "estimate: [{parameter: k_n_per_m, prior: {mean: 104, sd: 5}}]\nresiduals: [" +
           residual + "]\n";
  }
  void Data(const std::string& rows) { Write("a.csv", "time_s,node/ball/position_z_m\n" + rows); }
};

TEST_F(Windows, AWindowHasAllOfItsRowsAndNoOthers) {
  Data("0,99\n1,1\n1.5,nan\n2,4\n2.5,99\n");
  const std::string window =
      "{channel: node/ball/position_z_m, sd: 1, statistic: WHAT, window: {from_s: 1, to_s: 2}}";
  const auto of = [&](const std::string& what) {
    const auto fit = Make(Dynamic(Replaced(window, "WHAT", what)));
    EXPECT_TRUE(fit) << out_.Format();
    return fit ? fit->train_points() : std::vector<FitPoint>{};
  };
  ASSERT_EQ(of("mean").size(), 1u);
  EXPECT_EQ(of("mean")[0].measured, 2.5);
  EXPECT_EQ(of("mean")[0].where, "1..2 s");
  EXPECT_EQ(of("mean")[0].time_s, 1.5);
  EXPECT_EQ(of("max")[0].measured, 4);
  EXPECT_EQ(of("min")[0].measured, 1);
  ASSERT_EQ(of("rows").size(), 2u);
  EXPECT_EQ(of("rows")[1].measured, 4);
  EXPECT_EQ(of("rows")[1].where, "at 2 s");
}

TEST_F(Windows, SetPointsOnTheDatasClockMeetThoseOfTheRun) {
  // Set points at 101.1 s and 203.6 s of the data's clock, which are 1.1 s and 3.6 s of the run.
  std::string rows;
  for (const double from_s : {100.0, 202.5}) {
    for (int i = 0; i <= 20; ++i) {
      const double t = from_s + 0.1 * i;
      const double rest_m = from_s < 200 ? (t < 101.1 ? 0.9 : 0.8) : (t < 203.6 ? 0.8 : 0.7);
      rows += std::to_string(t) + "," + std::to_string(Height(rest_m, 100)) + "\n";
    }
  }
  Data(rows);
  Write("when.csv", "time_s\n101.1\n203.6\n");
  const std::string text =
      Replaced(Dynamic("{channel: node/ball/position_z_m, sd: 0.001, statistic: STAT, window: "
                       "{after_setpoint_s: [0.6, 0.8]}}"),
               "data: a.csv", "data: a.csv, setpoints: when.csv");
  for (const char* statistic : {"mean", "rows"}) {
    const auto fit = Make(Replaced(text, "STAT", statistic));
    ASSERT_TRUE(fit) << out_.Format();
    const std::size_t each = fit->train_points().size() / 2;
    EXPECT_EQ(each, statistic[0] == 'm' ? 1u : 3u);
    EXPECT_NEAR(fit->train_points()[0].measured, Height(0.8, 100), 1e-6);
    EXPECT_NEAR(fit->train_points()[each].measured, Height(0.7, 100), 1e-6);
    // The oscillation after a set point decays by exp(-8 t).
    for (const double r : At(*fit, {100}).value) EXPECT_LT(std::fabs(r), 1);
  }
  // A file may give the run times of its rows: here in reverse, so that data of 0.8 m rest length
  // are compared with 0.7 m.
  Write("when.csv", "time_s,experiment_s\n101.1,3.6\n");
  const auto fit = Make(Replaced(text, "STAT", "mean"));
  ASSERT_TRUE(fit) << out_.Format();
  ASSERT_EQ(fit->train_points().size(), 1u);
  EXPECT_NEAR(At(*fit, {100}).value[0], (Height(0.7, 100) - Height(0.8, 100)) / 0.001, 1);
}

TEST_F(Windows, WhatTheRunDoesNotReachIsLeftOutAndSaid) {
  Data("0,0\n1.2,0\n2.2,0\n5.9,0\n");
  const auto fit = Make(
      Dynamic("{channel: node/ball/position_z_m, sd: 1, window: {after_setpoint_s: [1, 2.5]}}"));
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_EQ(fit->train_points().size(), 1u);
  EXPECT_NE(out_.Format().find("1 of 2 windows"), std::string::npos) << out_.Format();
}

/// Two masses on two cables, and references of three kinds
const std::string kTwo = R"(taut: 1
kind: model
name: two
parameters: {k_n_per_m: 100}
nodes: {top: [0, 0, 1], ball: [0, 0, 0], high: [3, 0, 1], heavy: [3, 0, 0]}
pairs: [{name: c, nodes: [top, ball], tags: [cable]}, {name: d, nodes: [high, heavy], tags: [cable]}]
builders:
  - {match: top, anchor: {}}
  - {match: high, anchor: {}}
  - {match: ball, point_mass: {mass_kg: 0.5, radius_m: 0.01}}
  - {match: heavy, point_mass: {mass_kg: 1.5, radius_m: 0.01}}
  - {match: cable, cable: {stiffness_n_per_m: k_n_per_m, damping_n_s_per_m: 12, rest_length_m: 0.9}}
)";
const std::string kWeighed = R"(taut: 1
kind: experiment
name: weighed
model: model.yaml
gravity_m_per_s2: [0, 0, -10]
duration_s: 8
timeline: {phases: {late: [7, 8]}}
reference:
  - {source: one, cables_n: {c: 1}}
  - {source: two, statistic: mean, phase: late, cables_n: {c: 4, d: 20}}
  - {source: three, statistic: min, phase: late, cables_n: {d: 14}}
)";

TEST_F(Windows, ReferencesAreTheRunsNumbersOfEachCable) {
  Write("model.yaml", kTwo);
  Write("experiment.yaml", kWeighed);
  const std::string text =
      "taut: 1\nkind: fit\nname: f\nexperiments: [{name: a, experiment: experiment.yaml}]\n"
      "estimate: [{parameter: k_n_per_m, scale: 5}]\n"
      "residuals: [{reference: WHAT, sd: 0.5, relative_sd: 0.05}]\n";
  const auto fit = Make(Replaced(text, "WHAT", "all"));
  ASSERT_TRUE(fit) << out_.Format();
  ASSERT_EQ(fit->train_points().size(), 4u);
  const auto at = At(*fit, {100});
  ASSERT_EQ(at.failed, "");
  EXPECT_NEAR(at.value[0], (10 - 1) / 0.5, 1e-3);  // in the described pose it is stretched by 0.1 m
  EXPECT_NEAR(at.value[1], (5 - 4) / 0.5, 1e-3);
  EXPECT_NEAR(at.value[2], (15 - 20) / 1.0, 1e-3);
  EXPECT_NEAR(at.value[3], (15 - 14) / 0.7, 1e-3);
  const auto means = Make(Replaced(text, "WHAT", "means"));
  ASSERT_TRUE(means) << out_.Format();
  ASSERT_EQ(means->train_points().size(), 2u);
  EXPECT_EQ(means->train_points()[1].where, "mean of late");
  EXPECT_NEAR(At(*means, {100}).value[1], -5, 1e-3);
}

TEST_F(Windows, GainsComeBeforeOffsetsAndActWhereTheyFit) {
  const std::string text = Replaced(kFit, "{channel: node/*/position_z_m, offset: {sd: 0.01}}",
                                    "{channel: node/ball/*, gain: {sd: 0.1}}, {channel: "
                                    "node/*/position_z_m, offset: {sd: 0.01}}");
  const auto fit = Make(text);
  ASSERT_TRUE(fit) << out_.Format();
  const double one = At(*fit, {125, 1, 0}).value[0], measured = Height(0.8, 110);
  EXPECT_NEAR(one, (Height(0.8, 125) - measured) / 0.001, 1e-4);
  EXPECT_NEAR(At(*fit, {125, 1.2, 0.003}).value[0],
              (1.2 * Height(0.8, 125) + 0.003 - measured) / 0.001, 1e-4);
}

TEST_F(Windows, WhatIsKnownBeforeIsTheProblems) {
  const auto fit = Make(Replaced(kFit, "{parameter: k_n_per_m, prior: {sd: 5}}",
                                 "{parameter: k_n_per_m, low: 50, high: 150, scale: 7, prior: "
                                 "{mean: 104, sd: 5}}") +
                        "search: {step: 0.03}\ngroups: window\n");
  ASSERT_TRUE(fit) << out_.Format();
  const FitParameter &k = fit->train().parameters[0], &offset = fit->train().parameters[1];
  EXPECT_EQ(k.prior_mean, 104);
  EXPECT_EQ(k.prior_sd, 5);
  EXPECT_EQ(k.low, 50);
  EXPECT_EQ(k.high, 150);
  EXPECT_EQ(k.scale, 7);
  EXPECT_EQ(k.step, 0.03);
  EXPECT_EQ(k.start, 100);
  EXPECT_FALSE(k.nuisance);
  EXPECT_TRUE(offset.nuisance);
  EXPECT_EQ(fit->train().group_names, (std::vector<std::string>{"a set point 1", "a set point 2"}));
  EXPECT_EQ(fit->train().rows[1].group, 1);
}

TEST_F(Windows, WhatActsOnTheHoldOutAloneStaysAndTakesNoPlace) {
  // The first parameter is the offset of the hold-out, which is not part of the problem.
  fs::copy_file(folder_ / "a.csv", folder_ / "b.csv", fs::copy_options::overwrite_existing);
  const std::string text =
      "taut: 1\nkind: fit\nname: f\nexperiments:\n"
      "  - {name: b, experiment: experiment.yaml, data: b.csv, forward: static, use: test}\n"
      "  - {name: a, experiment: experiment.yaml, data: a.csv, forward: static}\n"
      "estimate:\n"
      "  - {channel: node/*/position_z_m, offset: {start: 0.002, scale: 0.01}, experiments: [b]}\n"
      "  - {parameter: k_n_per_m, prior: {sd: 5}}\n"
      "residuals: [{channel: node/ball/position_z_m, sd: 0.001, window: {after_setpoint_s: [1, "
      "2]}}]\ngroups: channel\n";
  const auto fit = Make(text);
  ASSERT_TRUE(fit) << out_.Format();
  ASSERT_EQ(fit->train().parameters.size(), 1u);
  ASSERT_TRUE(fit->test());
  EXPECT_EQ(fit->test_points()[0].experiment, 0u);
  EXPECT_EQ(fit->train_points()[0].experiment, 1u);
  EXPECT_EQ(fit->train().group_names, (std::vector<std::string>{"node/ball/position_z_m"}));
  const double off = (Height(0.8, 125) - Height(0.8, 110)) / 0.001;
  EXPECT_NEAR(At(*fit, {125}).value[0], off, 1e-4);
  const std::vector<std::vector<double>> points{{125}};
  EXPECT_NEAR(fit->test()->forward(points)[0].value[0], off + 2, 1e-4);
  // Both are one experiment with the same values: computed once.
  EXPECT_EQ(fit->counts().computed, 1);
}

TEST_F(Windows, EqualExperimentsWithOtherValuesAreNotTheSame) {
  fs::copy_file(folder_ / "a.csv", folder_ / "b.csv", fs::copy_options::overwrite_existing);
  const auto make = [&](const std::string& more, const std::string& own) {
    return Make(
        "taut: 1\nkind: fit\nname: f\nexperiments:\n"
        "  - {name: a, experiment: experiment.yaml, data: a.csv, forward: static}\n"
        "  - {name: b, experiment: experiment.yaml, data: b.csv, forward: static" +
        more + "}\nestimate: [{parameter: k_n_per_m, prior: {sd: 5}" + own +
        "}]\nresiduals: [{channel: node/ball/position_z_m, sd: 0.001, window: "
        "{after_setpoint_s: [1, 2]}}]\n");
  };
  const auto set = make(", set: {mass_kg: 0.6}", "");
  ASSERT_TRUE(set) << out_.Format();
  const auto of_set = At(*set, {100}).value;
  EXPECT_NEAR((of_set[2] - of_set[0]) * 0.001, -0.1 * 10 / 100, 1e-6);
  EXPECT_EQ(set->counts().computed, 2);
  const auto own = make("", ", each: experiment");
  ASSERT_TRUE(own) << out_.Format();
  ASSERT_EQ(own->train().parameters.size(), 2u);
  const auto of_own = At(*own, {100, 120}).value;
  EXPECT_NEAR((of_own[2] - of_own[0]) * 0.001, Height(0.8, 120) - Height(0.8, 100), 1e-6);
  const auto shared = make("", "");
  ASSERT_TRUE(shared) << out_.Format();
  At(*shared, {90});
  EXPECT_EQ(shared->counts().computed, 1);
}

TEST_F(Windows, PushesActAlongTheirDirectionWhileTheyLast) {
  Write("experiment.yaml",
        "taut: 1\nkind: experiment\nname: p\nmodel: model.yaml\ngravity_m_per_s2: [0, 0, -10]\n"
        "duration_s: 6\ntimeline:\n  events:\n    - push: {name: p, node: ball, scale: 2, "
        "direction: [3, 0, 0], force_n: [[0, 0], [1, 1], [2, 1], [3, 2], [4, 2]]}\n");
  // Set points: 1 s (2 N), 3 s (4 N). At rest the cable is aligned with the force.
  std::string rows = "time_s,node/ball/position_x_m\n";
  for (const double t : {1.0, 3.0}) rows += std::to_string(t) + ",0\n";
  Write("a.csv", rows);
  const auto fit = Make(
      "taut: 1\nkind: fit\nname: f\nexperiments: [{name: a, experiment: experiment.yaml, data: "
      "a.csv, forward: static}]\nestimate: [{parameter: k_n_per_m, prior: {sd: 5}}]\nresiduals: "
      "[{channel: node/ball/position_x_m, sd: 0.001, window: {after_setpoint_s: [-0.1, 0.1]}}]\n");
  ASSERT_TRUE(fit) << out_.Format();
  const auto at = At(*fit, {100}).value;
  ASSERT_EQ(at.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    const double x_n = i == 0 ? 2 : 4, pull_n = std::hypot(x_n, 5);
    EXPECT_NEAR(at[i] * 0.001, (0.9 + pull_n / 100) * x_n / pull_n, 1e-6);
  }
}

TEST_F(Windows, ErrorsByChannelAreRootMeanSquaresInItsUnit) {
  std::vector<FitPoint> points(3);
  points[0].channel = points[2].channel = "a";
  points[1].channel = "b";
  points[0].sd = 2, points[1].sd = 5, points[2].sd = 3;
  const auto errors = ErrorsByChannel(points, {{1, 2, -1}, {0.5, 1, 0.1}});
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].count, 2u);
  EXPECT_NEAR(errors[0].untuned, std::sqrt((4 + 9) / 2.0), 1e-12);
  EXPECT_NEAR(errors[0].fitted, std::sqrt((1 + 0.09) / 2), 1e-12);
  EXPECT_NEAR(errors[0].fitted_bias, (1 + 0.3) / 2, 1e-12);
  EXPECT_NEAR(errors[1].untuned, 10, 1e-12);
}

TEST_F(Windows, DesignSeesWhatAChannelTells) {
  // Without new measurements: the prior and a datum of 100 sds. An accuracy of 1 mm determines k to
  // 1e-3 k^2 / (m g): of a prior of 5 N/m, 2 / sqrt(2^2 + 5^2) remains.
  const auto fit =
      Make(Replaced(Replaced(kFit, ", {channel: node/*/position_z_m, offset: {sd: 0.01}}", ""),
                    "sd: 0.001", "sd: 10") +
           "design: [{name: camera, residuals: [{channel: node/ball/position_z_m, sd: "
           "0.001, experiments: [a], window: {after_setpoint_s: [1, 1.1]}}]}]\n");
  ASSERT_TRUE(fit) << out_.Format();
  OutcomeOptions options;
  options.design = true;
  const FitOutcome outcome = RunFit(*fit, options);
  ASSERT_TRUE(outcome.design);
  ASSERT_EQ(outcome.design->wrong.size(), 0u);
  EXPECT_NEAR(outcome.design->now.sd_ratio[0], 1, 1e-6);
  const double se = 1e-3 * 100 * 100 / 5 / std::sqrt(2);  // from two set points
  EXPECT_NEAR(outcome.design->alone[0].sd_ratio[0], se / std::hypot(se, 5), 1e-3);
}

TEST_F(Windows, OtherDataAreAnotherFit) {
  ASSERT_TRUE(Make(kFit, "fit.sqlite")) << out_.Format();
  WriteData("node/ball/position_z_m", 111, 0);
  EXPECT_FALSE(Make(kFit, "fit.sqlite"));
  EXPECT_NE(out_.Format().find("which differs in data"), std::string::npos) << out_.Format();
}

TEST_F(Windows, ARecordThatIsDamagedIsComputedAgain) {
  std::vector<double> first;
  {
    const auto fit = Make(kFit, "fit.sqlite");
    ASSERT_TRUE(fit) << out_.Format();
    first = At(*fit, {125, 0}).value;
  }
  {
    learn::Database database((folder_ / "fit.sqlite").string(), learn::Database::Open::kOrMake);
    ASSERT_TRUE(database.Execute("UPDATE point SET value = replace(value, '0', '1')"));
  }
  const auto fit = Make(kFit, "fit.sqlite");
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_EQ(fit->counts().damaged, 1);
  EXPECT_EQ(At(*fit, {125, 0}).value, first);
}

TEST_F(Windows, PointsWithoutTheFactsOfTheirFitAreRefused) {
  {
    const auto fit = Make(kFit, "fit.sqlite");
    ASSERT_TRUE(fit) << out_.Format();
    At(*fit, {125, 0});
  }
  const std::string path = (folder_ / "fit.sqlite").string();
  learn::Database database(path, learn::Database::Open::kOrMake);
  ASSERT_TRUE(database.Execute("INSERT INTO fact VALUES ('weather', 'rain')"));
  EXPECT_FALSE(Make(kFit, "fit.sqlite"));
  EXPECT_NE(out_.Format().find("which differs in weather"), std::string::npos) << out_.Format();
  ASSERT_TRUE(database.Execute("DELETE FROM fact"));
  EXPECT_FALSE(Make(kFit, "fit.sqlite"));
  EXPECT_NE(out_.Format().find("it contains points, but not the inputs of their fit"),
            std::string::npos)
      << out_.Format();
}

TEST_F(Windows, PointsUnderFactsThatWereChangedAreDamaged) {
  const std::string path = (folder_ / "fit.sqlite").string();
  std::vector<double> of_other_data;
  const auto facts = [&](const std::string& sql) {
    learn::Database database(path, learn::Database::Open::kOrMake);
    ASSERT_TRUE(database.Execute(sql));
  };
  {
    const auto fit = Make(kFit, "fit.sqlite");
    ASSERT_TRUE(fit) << out_.Format();
    of_other_data = At(*fit, {125, 0}).value;
  }
  fs::copy_file(path, path + ".old");
  WriteData("node/ball/position_z_m", 111, 0);
  fs::remove(path);
  ASSERT_TRUE(Make(kFit, "fit.sqlite")) << out_.Format();  // the facts of these data
  facts("ATTACH '" + path + ".old' AS old; INSERT INTO point SELECT * FROM old.point");
  const auto fit = Make(kFit, "fit.sqlite");
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_EQ(fit->counts().damaged, 1);
  EXPECT_EQ(fit->counts().remembered, 0);
  EXPECT_NE(At(*fit, {125, 0}).value, of_other_data);
}

}  // namespace
}  // namespace taut
