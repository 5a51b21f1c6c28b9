// The command `taut check`
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace taut {
namespace {

std::string Text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class CheckCommand : public ::testing::Test {
 protected:
  CheckCommand()
      : folder_(::testing::TempDir() + "taut_check_" +
                ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
  }
  ~CheckCommand() override { std::filesystem::remove_all(folder_); }

  struct Outcome {
    int status = -1;
    std::string output, errors;
  };
  Outcome Run(const std::string& arguments) {
    const std::string command = "cd '" TAUT_SOURCE_DIR "' && '" TAUT_COMMAND "' check " +
                                arguments + " >'" + folder_ + "/out' 2>'" + folder_ + "/err'";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), Text(folder_ + "/out"), Text(folder_ + "/err")};
  }

  std::string folder_;
};

TEST_F(CheckCommand, ShowsMassesLengthsTensionsAndLoads) {
  const Outcome spine = Run("models/tetraspine3.yaml --tables");
  EXPECT_EQ(spine.status, 0);
  EXPECT_EQ(spine.errors, "");
  EXPECT_EQ(
      spine.output.rfind("share/models/tetraspine3.yaml: good: model tetraspine3, 3 bodies, 12 "
                         "cables, 18 nodes; moving mass 2.349243 kg\n",
                         0),
      0u)
      << spine.output;
  for (const char* part :
       {"3 bodies, 12 cables, 18 nodes; moving mass 2.349243 kg",
        "segment_0  0.713081  0.793276  0.000000  0.125465            0.0148116 "
        " 0.0157328  0.0241226  6 spheres, 8 rods\n",
        "inner_top_1    0.213953     0.126678   20.000     229.16       20  "
        "segment_0 - segment_1  0.07 m/s 50 N\n",
        "segment_0        -30.913  0.000  -12.946          0.0000  -2.5616  "
        "0.0000     0.000  0.000  -6.995\n",
        "Possible collisions: 3 pairs of bodies, 588 pairs of shapes; also with the "
        "terrain of an experiment\n",
        "segment_0 - segment_2              196\n"}) {
    EXPECT_NE(spine.output.find(part), std::string::npos) << part << "\nis not in\n"
                                                          << spine.output;
  }
}

TEST_F(CheckCommand, ShowsAnExperimentAndItsRobot) {
  const Outcome push = Run("experiments/push_20n.yaml --tables");
  EXPECT_EQ(push.status, 0) << push.errors;
  EXPECT_NE(push.output.find("Experiment push_20n: 60 s in steps of 0.001 s, 1 controller\n"),
            std::string::npos);
  EXPECT_NE(push.output.find("Cables per integration scheme: 12 explicit\n"), std::string::npos);
  EXPECT_NE(push.output.find("segment_0.tip"), std::string::npos);
  EXPECT_NE(push.output.find("Model tetraspine3: 3 bodies"), std::string::npos);
  EXPECT_NE(push.output.find("with 1 terrain surface\n"), std::string::npos);
}

TEST_F(CheckCommand, PrintsAVerdictATenLineSummaryAndTheNextCommand) {
  for (const char* const file :
       {"models/tetraspine3.yaml", "models/superball.yaml", "experiments/push_20n.yaml",
        "experiments/drop_six_strut.yaml", "gaits/hand_tuned_sine.yaml"}) {
    const Outcome outcome = Run(file);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.output.rfind("share/" + std::string(file) + ": good: ", 0), 0u)
        << outcome.output;
    EXPECT_LE(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 11) << outcome.output;
    const std::size_t last = outcome.output.rfind('\n', outcome.output.size() - 2);
    EXPECT_EQ(outcome.output.compare(last + 1, 11, "next: taut "), 0) << outcome.output;
    EXPECT_GT(Run(std::string(file) + " --tables").output.size(), outcome.output.size());
  }
}

TEST_F(CheckCommand, CablesWithTheSameTagsShareALine) {
  const Outcome prism = Run("models/prism3.yaml");
  for (const char* const line : {"\n  3 cables lower: ", "\n  3 cables upper: ",
                                 "\n  3 cables side: length 0.2066 m, tension "
                                 "20.000 N, stiffness 1000 N/m\n",
                                 "\n  3 rods: axial force "}) {
    EXPECT_NE(prism.output.find(line), std::string::npos) << line << "\n" << prism.output;
  }
  const Outcome spine = Run("models/tetraspine3.yaml --set segments=12");
  EXPECT_NE(spine.output.find("\n  11 cables outer_right: "), std::string::npos) << spine.output;
}

TEST_F(CheckCommand, AFolderOfARunNamesItsInputs) {
  std::filesystem::create_directories(folder_ + "/run");
  std::ofstream(folder_ + "/run/inputs.yaml") << "taut: 1\n";
  const Outcome refused = Run("'" + folder_ + "/run'");
  EXPECT_EQ(refused.status, 3);
  EXPECT_EQ(refused.errors, folder_ +
                                "/run: error: the path is a directory, not a file (the "
                                "experiment of this run is in " +
                                folder_ + "/run/inputs.yaml)\n");
}

TEST_F(CheckCommand, QuietSaysNothingAboutAGoodFile) {
  const Outcome outcome = Run("models/rod.yaml --quiet");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output + outcome.errors, "");
}

TEST_F(CheckCommand, SetChangesParameters) {
  EXPECT_NE(Run("models/tetraspine3.yaml --set segments=12").output.find("12 bodies, 66 cables"),
            std::string::npos);
  const Outcome unknown = Run("models/tetraspine3.yaml --set segment=12");
  EXPECT_EQ(unknown.status, 3);
  EXPECT_EQ(
      unknown.errors,
      "--set segment=12: error: there is no parameter \"segment\" (did you mean \"segments\"?)\n");
  EXPECT_EQ(Run("models/tetraspine3.yaml --set segments").status, 2);
}

TEST_F(CheckCommand, JsonHoldsTheSameNumbers) {
  const Outcome outcome = Run("models/tetraspine3.yaml --json");
  EXPECT_EQ(outcome.status, 0);
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["ok"], true);
  EXPECT_NEAR(json["bodies"][1]["mass_kg"].get<double>(), 0.913080891, 1e-9);
  EXPECT_EQ(json["cables"].size(), 12u);
  EXPECT_EQ(json["cables"][5]["name"], "inner_top_1");
  EXPECT_NEAR(json["cables"][5]["tension_n"].get<double>(), 20.0, 1e-12);
  EXPECT_EQ(json["nodes"][3]["name"], "segment_0.tip");
}

TEST_F(CheckCommand, ErrorsGoToStderrWithTheirPlace) {
  const std::string path = folder_ + "/bad.yaml";
  std::ofstream(path) << "taut: 1\nkind: model\nname: bad\nnodes: {a: [0, 0]}\nbuilder: []\n";
  const std::string wanted = path + ":4:12: error: nodes.a must have 3 numbers, got 2\n" + path +
                             ":5:1: error: unknown key \"builder\" (did you mean \"builders\"?)\n";
  const Outcome text = Run("'" + path + "' --quiet");
  EXPECT_EQ(text.status, 3);
  EXPECT_EQ(text.output, "");
  EXPECT_EQ(text.errors, wanted);
  const Outcome outcome = Run("'" + path + "' --json");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.errors, wanted);
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["ok"], false);
  EXPECT_EQ(json["errors"].size(), 2u);
  EXPECT_EQ(json["errors"][0]["line"], 4);
  const Outcome missing = Run("no_such.yaml");
  EXPECT_EQ(missing.status, 3);
  EXPECT_EQ(missing.errors, "no_such.yaml: error: cannot open: No such file or directory\n");
}

TEST_F(CheckCommand, WarningsAreErrorsWithStrict) {
  const std::string path = folder_ + "/odd.yaml";
  std::ofstream(path) << Text(TAUT_SOURCE_DIR "/share/models/rod.yaml") << "inertia: exact\n";
  EXPECT_EQ(Run("'" + path + "' --quiet --strict").errors, "");
  const std::string where = "--set height_m=1";
  std::string text = Text(path);
  text.replace(text.find("front: [length_m / 2, 0, height_m]"), 34,
               "front: [length_m / 2, 0, 0.5]");
  text.replace(text.find("back: [-length_m / 2, 0, height_m]"), 34,
               "back: [-length_m / 2, 0, 0.5]");
  std::ofstream(path) << text;
  const std::string what =
      ": the parameter \"height_m\" is not used (remove it, or use it in an expression)\n";
  const Outcome warned = Run("'" + path + "' " + where + " --json");
  EXPECT_EQ(warned.status, 0);
  EXPECT_EQ(warned.errors, where + ": warning" + what);
  const auto good = nlohmann::json::parse(warned.output);
  EXPECT_EQ(good["ok"], true);
  EXPECT_EQ(good["warnings"][0]["file"], where);
  const Outcome refused = Run("'" + path + "' " + where + " --json --strict");
  EXPECT_EQ(refused.status, 3);
  EXPECT_EQ(refused.errors, where + ": error" + what);
  EXPECT_EQ(nlohmann::json::parse(refused.output)["errors"].size(), 1u);
}

TEST_F(CheckCommand, ShippedFilesHaveNoWarnings) {
  int count = 0;
  for (const char* const folder : {"models", "experiments", "gaits"}) {
    for (const auto& file :
         std::filesystem::directory_iterator(TAUT_SOURCE_DIR "/share/" + std::string(folder))) {
      if (file.path().extension() != ".yaml") continue;  // a mesh
      const Outcome outcome = Run("'" + file.path().string() + "' --quiet --strict");
      EXPECT_EQ(outcome.status, 0) << outcome.errors;
      ++count;
    }
  }
  EXPECT_GE(count, 30);
}

TEST_F(CheckCommand, ARobotInTheGroundIsRefused) {
  const std::string path = folder_ + "/low.yaml";
  std::ofstream(path) << "taut: 1\nkind: experiment\nname: low\nmodel: " TAUT_SOURCE_DIR
                         "/share/models/rod.yaml\nset: {height_m: -0.01}\nduration_s: 1\n"
                         "terrain: [{name: ground, plane: {height_m: 0}}]\n";
  const Outcome refused = Run("'" + path + "'");
  EXPECT_EQ(refused.status, 3);
  EXPECT_EQ(refused.errors,
            path +
                ":7:11: error: the rod \"back-front\" is 0.015 m deep in the terrain \"ground\" at "
                "the start, more than half the thickness of the thinner one, 0.005 m (move the "
                "robot with `place`)\n");
  EXPECT_EQ(
      Run("'" + path + "' --set height_m=0.002 --quiet").errors,
      path +
          ":7:11: warning: the rod \"back-front\" is 0.003 m deep in the terrain \"ground\" at "
          "the start (the contact solver separates them without adding velocity)\n");
}

TEST_F(CheckCommand, AnInstructionSetThatNobodyKnowsIsRefused) {
  setenv("TAUT_SIMD", "fastest", 1);
  const Outcome refused = Run("models/rod.yaml");
  unsetenv("TAUT_SIMD");
  EXPECT_EQ(refused.status, 3);
  EXPECT_EQ(
      refused.errors.find(
          "error: the environment variable TAUT_SIMD is \"fastest\" (expected one of: "
          "scalar, sse2, neon, simd128, avx2, avx512; this build of taut on this machine supports: "
          "scalar"),
      0u)
      << refused.errors;
}

TEST_F(CheckCommand, WrongUsageIsNotABadFile) {
  EXPECT_EQ(Run("").status, 2);
  EXPECT_EQ(Run("models/rod.yaml --no-such-flag").status, 2);
  const Outcome help = Run("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_NE(help.output.find("taut check models/tetraspine3.yaml\n"), std::string::npos);
}

}  // namespace
}  // namespace taut
