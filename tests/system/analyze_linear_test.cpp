// Linear systems and frequency responses: `taut analyze --linear` and `--response`
#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "system/taut_command.h"

namespace taut {
namespace {

using nlohmann::json;

const std::string kMass = TAUT_SOURCE_DIR "/share/models/hanging_mass.yaml";
const char* const kForce = "node/mass/force_z";
const char* const kPlace = "node/mass/position_z";

class AnalyzeLinear : public test::CommandTest {
 protected:
  static std::vector<std::string> Damped(const std::vector<std::string>& more) {
    std::vector<std::string> all{"analyze", kMass, "--set", "damping_n_s_per_m=4"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void Refuses(const std::vector<std::string>& arguments, int status, const std::string& why) {
    const test::CommandResult shown = Taut(arguments);
    EXPECT_EQ(shown.status, status) << shown.errors;
    EXPECT_NE(shown.errors.find(why), std::string::npos) << shown.errors;
    EXPECT_EQ(shown.output, "");
  }
};

/// Closed form 1 / (m s^2 + c s + k); holding the force during a step adds a delay of half a step.
TEST_F(AnalyzeLinear, AMassOnASpringAndADamperRespondsAsItsClosedForm) {
  const test::CommandResult shown = Taut(Damped({"--response", kForce, kPlace, "--from_hz", "0.5",
                                                 "--to_hz", "32", "--points", "13", "--json"}));
  ASSERT_EQ(shown.status, 0) << shown.errors;
  const json result = json::parse(shown.output);
  EXPECT_EQ(result["derivatives"], "exact");
  EXPECT_EQ(result["period_s"], 0.001);
  const json& response = result["responses"].at(0);
  EXPECT_EQ(response["unit"], "m / (N)");
  ASSERT_EQ(response["frequency_hz"].size(), 13u);
  for (std::size_t i = 0; i < 13; ++i) {
    const double f = response["frequency_hz"][i];
    EXPECT_NEAR(f, 0.5 * std::pow(2.0, static_cast<double>(i) / 2), 1e-9 * f);
    const std::complex<double> s(0, 2 * std::numbers::pi * f);
    const std::complex<double> wanted = std::exp(-s * 0.0005) / (0.5 * s * s + 4.0 * s + 400.0);
    const double w_h = std::abs(s) * 0.001, bound = w_h * w_h + 1e-5;
    EXPECT_NEAR(response["gain"][i], std::abs(wanted), bound * std::abs(wanted)) << f;
    EXPECT_NEAR(std::remainder(response["phase_rad"][i].get<double>() - std::arg(wanted),
                               2 * std::numbers::pi),
                0, bound)
        << f;
  }
  // Poles of the closed form: s = (-c +- sqrt(c^2 - 4 m k)) / 2 m.
  const double own = std::sqrt(400 / 0.5), share = 4 / (2 * std::sqrt(400 * 0.5));
  int swings = 0;
  for (const json& mode : result["modes"]) {
    if (std::fabs(mode["damping"].get<double>() - share) > 1e-3) continue;
    ++swings;
    EXPECT_NEAR(mode["frequency_hz"], own * std::sqrt(1 - share * share) / (2 * std::numbers::pi),
                1e-3);
  }
  EXPECT_EQ(swings, 1);
}

TEST_F(AnalyzeLinear, TablesAndCsvSayTheSameAsJson) {
  const std::vector<std::string> asked{
      "--response", kForce, kPlace,    "--response", kForce,     "cable/cable/tension",
      "--from_hz",  "1",    "--to_hz", "10",         "--points", "3"};
  const auto with = [&](const char* flag) {
    std::vector<std::string> all = Damped(asked);
    all.emplace_back(flag);
    return Taut(all);
  };
  const test::CommandResult csv = with("--csv"), table = with("--tables");
  ASSERT_EQ(csv.status, 0) << csv.errors;
  const json result = json::parse(with("--json").output);
  ASSERT_EQ(result["responses"].size(), 2u);
  EXPECT_EQ(result["responses"][1]["unit"], "1");
  std::string lines = "input,output,unit,frequency_hz,gain,phase_rad\n";
  std::string rest = csv.output;
  EXPECT_TRUE(rest.starts_with(lines)) << rest;
  rest = rest.substr(lines.size());
  for (const json& response : result["responses"]) {
    EXPECT_NE(table.output.find("Response of " + response["output"].get<std::string>() + " to " +
                                kForce + "\n"),
              std::string::npos)
        << table.output;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string begin = std::string(kForce) + "," + response["output"].get<std::string>() +
                                "," + response["unit"].get<std::string>() + ",";
      ASSERT_TRUE(rest.starts_with(begin)) << rest;
      double f = 0, gain = 0, phase = 0;
      ASSERT_EQ(std::sscanf(rest.c_str() + begin.size(), "%lf,%lf,%lf\n", &f, &gain, &phase), 3);
      EXPECT_EQ(f, response["frequency_hz"][i].get<double>());
      EXPECT_EQ(gain, response["gain"][i].get<double>());
      EXPECT_EQ(phase, response["phase_rad"][i].get<double>());
      rest = rest.substr(rest.find('\n') + 1);
    }
  }
  EXPECT_EQ(rest, "");
}

TEST_F(AnalyzeLinear, NamesThatAreNoneAreErrors) {
  const std::vector<std::string> wrong = {
      "analyze", kMass,        "--response", "node/mass/force_y1",
      "nothing", "--response", kForce,       "node/mas/position_z"};
  const std::string it = kMass + ": error: there is no ";
  Refuses(wrong, 3, it + "input \"node/mass/force_y1\" (did you mean \"node/mass/force_y\"?)");
  Refuses(wrong, 3,
          it + "output \"nothing\" (expected one of 6 names, such as \"cable/cable/tension\"; "
               "--json lists");
  Refuses(wrong, 3, it + "output \"node/mas/position_z\" (did you mean \"node/mass/position_z\"?)");
}

TEST_F(AnalyzeLinear, FlagsThatDoNotGoTogetherAreBadUsage) {
  const auto with = [](const std::vector<std::string>& more) {
    std::vector<std::string> all{"analyze", kMass};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const std::vector<std::string> response{"--response", kForce, kPlace};
  const auto responds = [&](std::vector<std::string> more) {
    more.insert(more.begin(), response.begin(), response.end());
    return with(more);
  };
  Refuses(responds({"--to_hz", "501"}), 2,
          "increasing frequencies up to half the tick rate, 500 Hz");
  Refuses(responds({"--from_hz", "20", "--to_hz", "10"}), 2, "--from_hz 20, --to_hz 10");
  Refuses(responds({"--from_hz", "0"}), 2, "\"0\" is not a number from");
  Refuses(responds({"--points", "0"}), 2, "\"0\" is not a whole number from 1");
  Refuses(responds({"--csv", "--json"}), 2, "--json excludes --csv");
  Refuses(with({"--csv"}), 2, "--csv requires --response");
  Refuses(with({"--from_hz", "1"}), 2, "--from_hz requires --response");
  Refuses(with({"--response", kForce}), 2, "--response needs a value: --response INPUT OUTPUT");
  Refuses(with({"--linear"}), 2, "--linear needs a value: --linear FILE");
  for (const char* const other : {"--inverse", "--form"}) {
    Refuses(with({"--linear", "x.h5", other}), 2, std::string(other) + " excludes --linear");
  }
  Refuses(with({"--linear", "x.h5", "--out", "y"}), 2, "--out excludes --linear");
  Refuses(with({"--linear", "x.h5", "--load_case", "y"}), 2, "--load_case excludes --linear");
  EXPECT_FALSE(std::filesystem::exists(Path("x.h5")));
}

TEST_F(AnalyzeLinear, AFileThatCannotBeWrittenIsAnError) {
  Refuses({"analyze", kMass, "--linear", "nowhere/x.h5"}, 1, "nowhere/x.h5: error: cannot write");
}

/// A box may lie anywhere on the ground: it is linearized at its recorded place.
TEST_F(AnalyzeLinear, ThePoseOfARecordingIsWhereItRests) {
  Write("box.yaml",
        "taut: 1\nkind: model\nname: box\nnodes:\n  box: [0, 0, 0.05]\nbuilders:\n"
        "  - {match: box, box: {size_m: [0.2, 0.2, 0.1], mass_kg: 1, friction: 0.5}}\n");
  Write("lies.yaml",
        "taut: 1\nkind: experiment\nname: lies\nmodel: box.yaml\nduration_s: 1\nstart: settled\n"
        "terrain:\n  - {name: ground, plane: {height_m: 0, friction: 0.5}}\n");
  Write("seen.csv",
        "time_s,body/box/position_x_m,body/box/position_y_m,body/box/position_z_m,"
        "body/box/orientation_w,body/box/orientation_x,body/box/orientation_y,"
        "body/box/orientation_z\n0,0.7,0,0.05,1,0,0,0\n");
  const test::CommandResult shown =
      Taut({"analyze", "lies.yaml", "--pose", "seen.csv", "--linear", "x.h5", "--json"});
  ASSERT_EQ(shown.status, 0) << shown.errors;
  const json result = json::parse(shown.output);
  ASSERT_EQ(result["states"][0]["name"], "body/box/position_x");
  EXPECT_NEAR(result["states"][0]["at"].get<double>(), 0.7, 1e-6);
  EXPECT_TRUE(std::filesystem::exists(Path("x.h5")));
}

/// A box that a cord pulls over the ground until friction stops it: friction is then at its limit.
TEST_F(AnalyzeLinear, WhatIsAboutToSlipIsRefusedWithWhatMayHelp) {
  Write("pulled.yaml",
        "taut: 1\nkind: model\nname: pulled\nparameters: {friction: 0.5}\n"
        "nodes:\n  post: [1, 0, 0.05]\n  box: [0, 0, 0.05]\n"
        "pairs: [{name: cord, nodes: [post, box]}]\n"
        "builders:\n  - {match: post, anchor: {}}\n"
        "  - {match: box, box: {size_m: [0.2, 0.2, 0.1], mass_kg: 1, friction: friction}}\n"
        "  - {match: cord, cable: {stiffness_n_per_m: 20, damping_n_s_per_m: 1, rest_length_m: "
        "0.3}}\n");
  Write("pull.yaml",
        "taut: 1\nkind: experiment\nname: pull\nmodel: pulled.yaml\nduration_s: 1\n"
        "start: settled\nterrain:\n  - {name: ground, plane: {height_m: 0, friction: 0.5}}\n");
  Refuses({"analyze", "pull.yaml", "--linear", "x.h5"}, 1,
          "error: there is no linear system: body pulled is at the limit of slipping: its "
          "friction force is the largest possible (increase");
  EXPECT_FALSE(std::filesystem::exists(Path("x.h5")));
}

/// A ball in free fall, which has no equilibrium
TEST_F(AnalyzeLinear, WhatTremblesIsRefusedWithWhatMayHelp) {
  const test::CommandResult shown = Taut({"analyze", "never.yaml", "--linear", "x.h5"});
  EXPECT_EQ(shown.status, 3) << "there is no such file";
  WriteNeverSettles();
  const test::CommandResult falls = Taut({"analyze", "never.yaml", "--linear", "x.h5"});
  EXPECT_NE(falls.status, 0);
  EXPECT_FALSE(std::filesystem::exists(Path("x.h5")));
}

}  // namespace
}  // namespace taut
