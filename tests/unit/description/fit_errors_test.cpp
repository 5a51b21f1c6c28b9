// Errors of fit files, reported all at once with their places and hints
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "taut/fit_spec.h"
#include "unit/description/hanging_model.h"

namespace taut {
namespace {

namespace fs = std::filesystem;
using test::kHangingModel;

const std::string kExperiment = R"(taut: 1
kind: experiment
name: pull
model: model.yaml
parameters: {up_m: 0.1}
duration_s: 4
timeline: {phases: {late: [2, 3]}}
controllers:
  - {name: play, period_s: 0.01, position: {programs: [{cables: c, change_m: [[0, 0], [1, 0], [1.1, -up_m]]}]}}
reference: [{source: a scale, cables_n: {c: 5}}]
)";
const std::string kGoodFit = R"(taut: 1
kind: fit
name: f
experiments:
  - {name: a, experiment: experiment.yaml, data: a.csv}
  - {name: b, experiment: experiment.yaml, data: b.csv, use: test, set: {up_m: 0.2}}
estimate:
  - {parameter: k_n_per_m, low: 50, high: 150, prior: {sd: 5}}
  - {channel: body/ball/position_z_m, offset: {sd: 0.002}, each: experiment}
  - {clock: data, delay_s: {low: 0, high: 3}}
residuals:
  - {channel: body/ball/position_*_m, sd: 0.001, window: {phase: late}}
  - {reference: maxima, sd: 0.5, loss: huber}
groups: window
search: {starts: 3, step: 0.05}
)";

class FitFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("taut_fit_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    Write("model.yaml", kHangingModel);
    Write("experiment.yaml", kExperiment);
    Write("a.csv", "time_s,body/ball/position_z_m\n0,0\n");
    Write("b.csv", "time_s,body/ball/position_z_m\n0,0\n");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  std::optional<FitSpec> Load(const std::string& text, const Overrides& overrides = {}) {
    Write("fit.yaml", text);
    out_ = {};
    return LoadFit((folder_ / "fit.yaml").string(), overrides, out_);
  }
  /// Returns the messages, without the file's name, for the valid fit with `old` replaced.
  std::string Wrong(const std::string& old, const std::string& by) {
    std::string text = kGoodFit;
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    EXPECT_FALSE(Load(text.replace(at, old.size(), by)));
    std::string messages;
    for (const Diagnostic& d : Sorted(out_.items())) {
      messages += std::to_string(d.at.line) + ": " + d.what +
                  (d.hint.empty() ? "" : " (" + d.hint + ")") + "\n";
    }
    return messages;
  }
  fs::path folder_;
  Diagnostics out_;
};

TEST_F(FitFile, IsRead) {
  const auto fit = Load(kGoodFit);
  ASSERT_TRUE(fit) << out_.Format();
  ASSERT_EQ(fit->experiments.size(), 2u);
  EXPECT_TRUE(fit->experiments[0].train);
  EXPECT_FALSE(fit->experiments[1].train);
  EXPECT_EQ(fit->experiments[1].experiment.parameters.at("up_m"), 0.2);
  ASSERT_EQ(fit->estimates.size(), 4u);  // two of them are the offset
  const FitEstimate& k = fit->estimates[0];
  EXPECT_EQ(k.range.start, 100);
  EXPECT_EQ(k.range.mean, 100);
  EXPECT_EQ(k.range.scale, 5);
  EXPECT_EQ(k.unit, "N/m");
  EXPECT_EQ(fit->estimates[2].name, "offset body/ball/position_z_m b");
  EXPECT_EQ(fit->estimates[2].experiments, (std::vector<std::size_t>{1}));
  EXPECT_EQ(fit->estimates[3].range.start, 1.5);
  EXPECT_EQ(fit->estimates[3].range.scale, 0.75);
  EXPECT_EQ(fit->residuals[1].references, ReferenceSpec::Statistic::kMax);
  EXPECT_EQ(fit->residuals[1].loss_sd, 1.345);
  EXPECT_EQ(fit->groups, FitGroups::kWindow);
  EXPECT_EQ(fit->search.starts, 3);
}

TEST_F(FitFile, OverridesReachItsOwnParametersAndThoseOfTheExperiments) {
  const auto fit = Load(kGoodFit + "parameters: {wide_n_per_m: 7}\n", {{"mass_kg", "0.6"}});
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_EQ(fit->experiments[0].experiment.robot.parameters.at("mass_kg"), 0.6);
  EXPECT_EQ(out_.warnings().size(), 1u);  // wide_n_per_m is unused
}

TEST_F(FitFile, SaysTheSameOfItselfWheneverItIsTheSame) {
  const auto fit = Load(kGoodFit), other = Load(kGoodFit);
  ASSERT_TRUE(fit && other);
  EXPECT_EQ(FitText(*fit), FitText(*other));
  std::string text = kGoodFit;
  const auto changed = Load(text.replace(text.find("sd: 0.5"), 7, "sd: 0.6"));
  ASSERT_TRUE(changed);
  EXPECT_NE(FitText(*fit), FitText(*changed));
}

TEST_F(FitFile, UnknownParametersAreSaidWithTheLikelyOne) {
  EXPECT_EQ(Wrong("parameter: k_n_per_m", "parameter: k_n_perm"),
            "8: estimate: no experiment and no model has a parameter \"k_n_perm\" (did you mean "
            "\"k_n_per_m\"?)\n");
}

TEST_F(FitFile, WhatIsTrainedOnJudgesNothing) {
  EXPECT_EQ(Wrong("data: b.csv", "data: ./a.csv"),
            "6: experiments: b has the same data as a, but one of them is held out for validation "
            "(use separate data for `use: test`)\n");
  EXPECT_EQ(Wrong("data: b.csv, use: test", "data: a.csv"),
            "6: experiments: b has the same data as a (list each measurement once)\n");
}

TEST_F(FitFile, NeedsSomethingToBeFoundFrom) {
  EXPECT_EQ(
      Wrong("data: a.csv}", "data: a.csv, use: test}"),
      "5: experiments: no entry is used for the estimation (write `use: train` for at least one, "
      "or leave out `use`)\n");
}

TEST_F(FitFile, AStandardDeviationOfZeroIsNone) {
  EXPECT_EQ(Wrong("sd: 0.001", "sd: 0"), "12: residual.sd must be positive, got 0\n");
}

TEST_F(FitFile, StartsLieBetweenTheBoundsAndNotOnThem) {
  EXPECT_EQ(Wrong("low: 50,", "low: 100,"),
            "8: estimate: k_n_per_m starts on its bound 100 (widen the bounds, or give a `start` "
            "between them)\n");
  EXPECT_EQ(Wrong("low: 50,", "low: 110,"),
            "8: estimate: k_n_per_m starts at 100, which is not between its bounds (the default "
            "start is the value in the experiment: give a `start`, or change the bounds)\n"
            "8: estimate: k_n_per_m: the prior's mean 100 is not between its bounds\n");
  EXPECT_EQ(Wrong("low: 50,", "low: 150,"),
            "8: estimate: k_n_per_m: low 150 is not below high 150\n");
}

TEST_F(FitFile, KeysOfOneKindAreNotForAnother) {
  EXPECT_EQ(Wrong("offset: {sd: 0.002}", "low: 0"),
            "9: estimate: a channel needs an `offset` or a `gain` (such as `offset: {sd: 0.002}`)\n"
            "9: estimate.low is allowed for a parameter only\n");
}

TEST_F(FitFile, NumbersAreFoundOnce) {
  EXPECT_EQ(Wrong("  - {clock:", "  - {parameter: k_n_per_m, scale: 1}\n  - {clock:"),
            "10: estimate: k_n_per_m is estimated twice (first in line 8)\n");
}

TEST_F(FitFile, WindowsAreOnesThatTheExperimentHas) {
  EXPECT_EQ(Wrong("phase: late", "phase: latte"),
            "12: residuals.window: a has no phase \"latte\" (did you mean \"late\"?)\n"
            "12: residuals.window: b has no phase \"latte\" (did you mean \"late\"?)\n");
  EXPECT_EQ(Wrong("phase: late", "from_s: 3, to_s: 2"),
            "12: residuals.window: the end 2 s is not after the start 3 s\n");
  EXPECT_EQ(Wrong("phase: late", "from_s: 3, phase: late"),
            "12: residuals.window needs both from_s and to_s\n"
            "12: residuals.window needs exactly one of `phase`, `from_s` with `to_s`, "
            "`after_setpoint_s`\n");
}

TEST_F(FitFile, EveryMistakeIsSaidAtOnce) {
  std::string text = kGoodFit;
  text.replace(text.find("data: a.csv"), 11, "data: c.csv");
  text.replace(text.find("experiments:\n"), 12, "experiments:");
  text.replace(text.find("loss: huber"), 11, "loss: hubert, experiments: [z]");
  text.replace(text.find("starts: 3"), 9, "starts: 0");
  EXPECT_FALSE(Load(text));
  std::string lines;
  for (const Diagnostic& d : Sorted(out_.items())) lines += std::to_string(d.at.line) + " ";
  EXPECT_EQ(lines, "5 13 13 15 ") << out_.Format();
}

TEST_F(FitFile, LoadCasesNeedSomeAndStaticsNeedSetPoints) {
  EXPECT_EQ(Wrong("data: a.csv}", "data: a.csv, forward: load_cases}"),
            "5: experiments: a has no load cases (add `load_cases` to the experiment, or change "
            "`forward`)\n"
            "10: estimate: the load cases of a have no clock, so they cannot have a delay\n"
            "12: residuals: a has load cases, which have no time (leave out `window`: row i of the "
            "data belongs to case i)\n");
  EXPECT_EQ(Wrong("data: a.csv}", "data: a.csv, forward: static}"),
            "12: residuals: a is static, so it is compared only after its set points (write "
            "`window: {after_setpoint_s: [2, 3]}`)\n");
}

}  // namespace
}  // namespace taut
