// `taut fit`: synthetic data of known parameters, verdicts as exit statuses, interruptions
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

const std::string kFitModel = R"(taut: 1
kind: model
name: hanging
parameters: {k_n_per_m: 100, mass_kg: 0.5, radius_m: 0.01}
nodes: {top: [0, 0, 1], ball: [0, 0, 0]}
pairs: [{name: c, nodes: [top, ball], tags: [cable]}]
builders:
  - {match: top, anchor: {}}
  - {match: ball, point_mass: {mass_kg: mass_kg, radius_m: radius_m}}
  - {match: cable, cable: {stiffness_n_per_m: k_n_per_m, damping_n_s_per_m: 8, rest_length_m: 0.9, actuator: {ideal: true}}}
)";
const std::string kFitExperiment = R"(taut: 1
kind: experiment
name: pull
model: model.yaml
gravity_m_per_s2: [0, 0, -10]
duration_s: 20
controllers:
  - {name: play, period_s: 0.01, position: {programs: [{cables: c, change_m: [[0, 0], [1, -0.01], [2, -0.02], [3, -0.03], [4, -0.04], [5, -0.05], [6, -0.06], [7, -0.07], [8, -0.08], [9, -0.09], [10, -0.1]]}]}}
)";
const std::string kFit = R"(taut: 1
kind: fit
name: f
experiments:
  - {name: a, experiment: experiment.yaml, data: a.csv, forward: static}
  - {name: b, experiment: experiment.yaml, data: b.csv, forward: static, use: test}
estimate:
  - {parameter: k_n_per_m, prior: {sd: 20}}
residuals:
  - {channel: node/ball/position_z_m, sd: 0.001, window: {after_setpoint_s: [-0.1, 0.1]}}
groups: window
)";

class FitCommand : public CommandTest {
 protected:
  FitCommand() {
    Write("model.yaml", kFitModel);
    Write("experiment.yaml", kFitExperiment);
    WriteData("a.csv", 110, 0.001, 1);
    WriteData("b.csv", 110, 0.001, 2);
  }
  /// Writes the height of the mass, 1 - (L + m g / k), with noise.
  void WriteData(const std::string& name, double k_n_per_m, double sd_m, unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, sd_m);
    std::string text = "time_s,node/ball/position_z_m\n";
    for (int i = 1; i <= 10; ++i) {
      const double z_m = 1 - (0.9 - 0.01 * i + 0.5 * 10 / k_n_per_m) + noise(random);
      text += std::to_string(i) + "," + std::to_string(z_m) + "\n";
    }
    Write(name, text);
  }
  CommandResult Fit(const std::string& text, std::vector<std::string> more = {},
                    const std::string& out = "out") const {
    Write("fit.yaml", text);
    more.insert(more.begin(), {"fit", "fit.yaml", "--out", out});
    return End(Start(more));
  }
  nlohmann::json Summary() const { return nlohmann::json::parse(Read(Path("out/summary.json"))); }
  static std::string Replaced(std::string text, const std::string& old, const std::string& by) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    return text.replace(at, old.size(), by);
  }
};

TEST_F(FitCommand, FindsASpringConstantWithDefaultSteps) {
  // 22 periods of an oscillation, without noise: the default difference step of damping_n_s_per_m
  // is too long here.
  const std::string hang = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";
  ASSERT_EQ(End(Start({"run", hang, "--set", "stiffness_n_per_m=410", "--set", "hang_m=1.03",
                       "--set", "damping_n_s_per_m=0.5", "--out", "truth", "--quiet", "--csv"}))
                .status,
            0);
  const CommandResult done =
      Fit("taut: 1\nkind: fit\nname: f\nexperiments: [{name: one, experiment: " + hang +
          ", data: truth/trace.csv, set: {hang_m: 1.03}}]\n"
          "estimate:\n  - {parameter: stiffness_n_per_m}\n"
          "  - {parameter: damping_n_s_per_m, start: 0.2, low: 0, high: 5}\n"
          "residuals: [{channel: \"cable/*/length_m\", sd: 0.001, statistic: rows}]\n");
  EXPECT_EQ(done.status, 0) << done.output << done.errors;
  const auto summary = Summary();
  EXPECT_NEAR(summary["parameters"][0]["value"], 410, 0.01);
  EXPECT_NEAR(summary["parameters"][1]["value"], 0.5, 1e-4);
}

TEST_F(FitCommand, FindsWhatATwinWasMadeWith) {
  const CommandResult done = Fit(kFit, {"--profile", "k_n_per_m"});
  EXPECT_EQ(done.status, 0) << done.output << done.errors;
  const auto summary = Summary();
  const auto& k = summary["parameters"][0];
  EXPECT_EQ(k["verdict"], "estimated");
  // z falls by m g / k^2 per unit of k: ten samples of 1 mm determine k to 1e-3 / sqrt(10) k^2 / 5.
  const double se = 1e-3 / std::sqrt(10.0) * 110 * 110 / 5;
  EXPECT_NEAR(k["se"], se, 0.05 * se);
  EXPECT_NEAR(k["value"], 110, 3 * se);
  EXPECT_LT(summary["hold_out"]["fitted_rms_sd"],
            0.5 * summary["hold_out"]["untuned_rms_sd"].get<double>());
  EXPECT_NEAR(
      summary["profiles"][0]["high"].get<double>() - summary["profiles"][0]["low"].get<double>(),
      2 * 1.96 * se, 0.1 * se);
  // The fitted model, as an experiment.
  EXPECT_EQ(End(Start({"check", "out/fitted_a.yaml", "--quiet"})).status, 0);
  EXPECT_NE(Read(Path("out/fitted_a.yaml")).find("k_n_per_m: 1"), std::string::npos);
  const std::string page = Read(Path("out/report.html"));
  EXPECT_NE(page.find("<strong class=\"good\">Good</strong><small>agrees with held-out data"),
            page.npos);
  EXPECT_NE(page.find("<strong class=\"good\">1 of 1</strong>"), page.npos);
  EXPECT_NE(page.find("aria-label=\"start, prior and estimate of each parameter\""), page.npos);
  EXPECT_NE(page.find("class=\"title\" x=\"62\" y=\"16\">a: "), page.npos);
  EXPECT_NE(page.find(", held out: "), page.npos);
}

TEST_F(FitCommand, ThePageShowsSingleDataInOneFigure) {
  const std::string hang = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";
  ASSERT_EQ(End(Start({"run", hang, "--set", "stiffness_n_per_m=410", "--out", "truth", "--quiet",
                       "--csv"}))
                .status,
            0);
  const CommandResult done =
      Fit("taut: 1\nkind: fit\nname: f\nexperiments: [{name: one, experiment: " + hang +
          ", data: truth/trace.csv}]\nestimate:\n  - {parameter: stiffness_n_per_m}\n"
          "residuals:\n  - {channel: \"cable/*/length_m\", sd: 1e-5, statistic: max}\n"
          "  - {channel: \"cable/*/length_m\", sd: 1e-5, statistic: mean}\n");
  EXPECT_EQ(done.status, 0) << done.output << done.errors;
  const std::string page = Read(Path("out/report.html"));
  EXPECT_NE(page.find("aria-label=\"measured and computed values\""), page.npos);
  EXPECT_EQ(page.find("class=\"title\""), page.npos) << "a plot with two dots";
  EXPECT_EQ(page.find("<h2>Residuals"), page.npos);
}

TEST_F(FitCommand, LeavesEachExperimentBeforeAndAfter) {
  for (const char* forward : {"static", "dynamic"}) {
    std::string text = kFit;
    for (int i = 0; i < 2; ++i)
      text = Replaced(text, "forward: static", std::string("forward:  ") + forward);
    const CommandResult done = Fit(text, {}, std::string("of_") + forward);
    ASSERT_EQ(done.status, 0) << done.output << done.errors;
    const std::string of = std::string("of_") + forward + "/";
    const auto summary = nlohmann::json::parse(Read(Path(of + "summary.json")));
    const double k_n_per_m = summary["parameters"][0]["value"];
    const CommandResult compared =
        Taut({"compare", of + "fitted_a/trace.h5", of + "untuned_a/trace.h5", "--from_s", "1",
              "--json", "--channels", "body/hanging/position_z_m"});
    ASSERT_EQ(compared.status, 0) << compared.errors;
    const auto json = nlohmann::json::parse(compared.output);
    // It hangs m g / k lower than the untuned model, whose k is 100 N/m.
    EXPECT_NEAR(json["channels"][0]["bias"].get<double>(), 5.0 / 100 - 5.0 / k_n_per_m,
                forward[0] == 's' ? 1e-8 : 1e-4)
        << json;
    EXPECT_NE(done.output.find("taut view " + of + "fitted_a/trace.h5 --compare " + of +
                               "untuned_a/trace.h5\n"),
              std::string::npos)
        << done.output;
    if (forward[0] == 's') {  // at rest the cable carries the weight, as the summary reports
      const auto rests = nlohmann::json::parse(Read(Path(of + "fitted_a/summary.json")));
      EXPECT_NEAR(rests["system_max_tension_n"].get<double>(), 5, 1e-6) << rests;
    }
    for (const char* run : {"untuned_a", "fitted_a", "untuned_b", "fitted_b"}) {
      EXPECT_TRUE(std::filesystem::exists(Path(of + run + "/summary.json"))) << run;
    }
    // The page links to the existing files.
    EXPECT_EQ(
        Read(Path(of + "report.html")).find("href=\"fitted_a/report.html\"") != std::string::npos,
        std::filesystem::exists(Path(of + "fitted_a/report.html")));
  }
}

TEST_F(FitCommand, SaysWhetherMeasuredForcesCarryTheLoad) {
  std::string data = "time_s,node/ball/position_z_m,cable/c/tension_n\n";
  for (int i = 1; i <= 10; ++i) {
    data += std::to_string(i) + "," + std::to_string(0.05 - 0.045 + 0.01 * i) + ",4.5\n";
  }
  Write("a.csv", data);
  const std::string tension =
      "residuals:\n  - {channel: cable/c/tension_n, sd: 0.1, experiments: [a], window: "
      "{after_setpoint_s: [-0.1, 0.1]}}\ncarried: [{name: ball, bodies: [hanging], experiments: "
      "[a]}]\n";
  std::string text = Replaced(kFit, "residuals:\n", "");
  text = Replaced(text, "  - {channel: node/ball", "  - {channel: \"node/ball");
  text = Replaced(text, "position_z_m,", "position_z_m\",");
  const std::size_t at = text.find("  - {channel: \"node");
  const std::string position = text.substr(at, text.find('\n', at) + 1 - at);
  text = text.substr(0, at) + tension.substr(0, tension.find("carried")) + position +
         text.substr(at + position.size()) + tension.substr(tension.find("carried"));
  const CommandResult done = Fit(text);
  EXPECT_LE(done.status, 1) << done.errors;
  // 4.5 N of 5 N, each to 0.1 N: 90 % to 2 % / sqrt(10)
  EXPECT_NE(
      done.output.find("ball of a: measured forces carry 90 +- 0.6325 % of the expected value: "
                       "the difference from 100 % is 15.81 standard errors"),
      std::string::npos)
      << done.output << done.errors;
  const auto carried = Summary()["carried"];
  ASSERT_EQ(carried.size(), 1u);
  EXPECT_FALSE(carried[0]["consistent"]);
  EXPECT_NEAR(carried[0]["share"], 0.9, 1e-9);
  EXPECT_NE(Read(Path("out/report.html")).find("Consistency of measured forces"),
            std::string::npos);
}

TEST_F(FitCommand, AnAliasIsNamedAndNoGoodFit) {
  // At rest only m / k is identifiable.
  const CommandResult done =
      Fit(Replaced(kFit, "{parameter: k_n_per_m, prior: {sd: 20}}",
                   "{parameter: k_n_per_m, scale: 20}\n  - {parameter: mass_kg, scale: 0.1}"));
  EXPECT_EQ(done.status, 1) << done.output << done.errors;
  const auto summary = Summary();
  EXPECT_TRUE(summary["unidentifiable"]);
  EXPECT_EQ(summary["parameters"][0]["verdict"], "confounded");
  EXPECT_TRUE(summary["parameters"][0]["confounded_with"].contains("mass_kg"))
      << summary["parameters"][0];
}

TEST_F(FitCommand, AModelThatTheDataContradictIsRejected) {
  WriteData("a.csv", 110, 0.01, 1);  // ten times the stated noise
  EXPECT_EQ(Fit(kFit).status, 1);
  EXPECT_TRUE(Summary()["rejected"]);
}

TEST_F(FitCommand, AParameterThatNothingReadsIsAMistake) {
  // A point's radius has no effect at rest.
  const CommandResult done =
      Fit(Replaced(kFit, "k_n_per_m, prior: {sd: 20}", "radius_m, prior: {sd: 0.001}"));
  EXPECT_EQ(done.status, 3) << done.output;
  EXPECT_EQ(done.errors,
            "fit.yaml:8:5: error: estimate: no compared value depends on radius_m (leave it "
            "out, or compare a channel that it affects)\n");
}

TEST_F(FitCommand, ChecksWithoutFitting) {
  const CommandResult done = Fit(kFit, {"--check"});
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.output.find("f: 1 parameters from 10 data points in 10 groups, 10 held out"),
            std::string::npos)
      << done.output;
  EXPECT_FALSE(std::filesystem::exists(Path("out")));
}

TEST_F(FitCommand, GoesOnFromWhatItKnowsToTheSameBits) {
  EXPECT_EQ(Fit(kFit, {"--resume"}).status, 3);  // nothing there
  ASSERT_EQ(Fit(kFit).status, 0);
  const std::string first = Read(Path("out/summary.json"));
  ASSERT_EQ(Fit(kFit, {"--resume", "--threads", "1"}).status, 0);
  EXPECT_EQ(Read(Path("out/summary.json")), first);
  const CommandResult other = Fit(Replaced(kFit, "sd: 0.001", "sd: 0.002"));
  EXPECT_EQ(other.status, 3);
  EXPECT_NE(other.errors.find("belongs to another fit, which differs in data, fit"),
            std::string::npos)
      << other.errors;
}

TEST_F(FitCommand, KilledAgainAndAgainItComesToTheSameEnd) {
  ASSERT_EQ(Fit(Replaced(kFit, "forward: static", "forward: dynamic")).status, 0);
  const std::string whole = Read(Path("out/summary.json"));
  for (double wait_s = 0.03;; wait_s *= 1.3) {  // grows, so that the loop ends on any machine
    const pid_t pid = Start({"fit", "fit.yaml", "--out", "killed", "--quiet"});
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    kill(pid, SIGKILL);
    if (End(pid).status == 0) break;
  }
  EXPECT_EQ(Read(Path("killed/summary.json")), whole);
}

}  // namespace
}  // namespace taut::test
