// The command at its limits: nothing to simulate, longest and shortest steps, missing or too large
// files, invalid numbers
#include <linux/capability.h>
#include <sys/prctl.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "taut/trace.h"
#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

const std::string kHangToLimits = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";

class Limits : public CommandTest {
 protected:
  /// Runs with these arguments and expects success and these warnings. Returns the trace.
  Trace Run(std::vector<std::string> arguments, const std::string& warnings = "") {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--quiet", "--out", Path("run")});
    const CommandResult result = Taut(arguments);
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(result.errors, warnings);
    Diagnostics out;
    auto trace = ReadTrace(Path("run/trace.h5"), out);
    EXPECT_TRUE(trace) << out.Format();
    return trace.value_or(Trace{});
  }
  nlohmann::json Summary() { return nlohmann::json::parse(Read(Path("run/summary.json"))); }

  void ExpectRefused(const std::vector<std::string>& arguments, int status,
                     const std::string& errors, const std::function<void()>& before = {}) {
    const CommandResult result = Taut(arguments, before);
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(result.errors, errors);
    EXPECT_EQ(result.output, "");
  }
};

TEST_F(Limits, AnExperimentWithoutDurationRecordsItsStart) {
  const Trace trace = Run({kHangToLimits, "--duration_s", "0"});
  EXPECT_EQ(trace.time_s, std::vector<double>{0});
  EXPECT_EQ(Summary().at("simulated_s"), 0.0);
}

TEST_F(Limits, AnExperimentOfOneStepRecordsItsStartAndItsEnd) {
  EXPECT_EQ(Run({kHangToLimits, "--duration_s", "0.001"}).time_s, (std::vector<double>{0, 0.001}));
  // A duration shorter than a step is one shorter step.
  EXPECT_EQ(Run({kHangToLimits, "--duration_s", "0.0004"}).time_s,
            (std::vector<double>{0, 0.0004}));
}

TEST_F(Limits, StepsOfASecondAndOfANanosecondAreTaken) {
  // The period of a pendulum of 1 m is 2 s, so that steps of 1 s cannot resolve it. At this step
  // its cable is implicit in tension and direction, a scheme that is stable at any tension
  // (theory/cables.md, 12a).
  const Trace coarse = Run({kHangToLimits, "--step_s", "1"});
  // Steps also end at the corners of the push: 0.5, 0.55 and 0.6 s.
  EXPECT_EQ(coarse.time_s.front(), 0.0);
  EXPECT_EQ(coarse.time_s.back(), 5.0);
  const Trace fine = Run({kHangToLimits, "--step_s", "1e-9", "--duration_s", "1e-6"});
  EXPECT_EQ(fine.time_s, (std::vector<double>{0, 1e-6}));
  for (const Trace* trace : {&coarse, &fine}) {
    for (const auto& column : trace->values) {
      for (const double value : column) EXPECT_TRUE(std::isfinite(value));
    }
  }
  // The mass is in equilibrium.
  const auto length = fine.Find("cable/cable/length_m");
  ASSERT_TRUE(length);
  EXPECT_NEAR(fine.values[*length][1], fine.values[*length][0], 1e-15);
}

TEST_F(Limits, NumbersOutOfRangeAreBadUsage) {
  for (const std::string text : {"0", "-1", "nan", "inf", "1e-10", "2", "fast"}) {
    ExpectRefused({"run", kHangToLimits, "--step_s", text}, 2,
                  "error: --step_s: \"" + text +
                      "\" is not a number from 1e-09 to 1\nsee `taut run --help`\n");
  }
  for (const std::string text : {"-1", "nan", "inf", "2e9"}) {
    ExpectRefused({"run", kHangToLimits, "--duration_s", text}, 2,
                  "error: --duration_s: \"" + text +
                      "\" is not a number from 0 to 1e+09\nsee `taut run --help`\n");
  }
  for (const std::string command : {"learn", "fit"}) {
    ExpectRefused({command, "a.yaml", "--threads", "1025"}, 2,
                  "error: --threads: \"1025\" is not a whole number from 0 to 1024\nsee `taut " +
                      command + " --help`\n");
  }
}

TEST_F(Limits, DurationsOfFilesAre1e9SecondsAtMost) {
  for (const std::string text : {"1e300", "2e9", "-1"}) {
    Write("long.yaml", "taut: 1\nkind: experiment\nname: long\nbase: " + kHangToLimits +
                           "\nduration_s: " + text + "\n");
    const CommandResult refused = Taut({"check", "long.yaml"});
    EXPECT_EQ(refused.status, 3) << refused.output;
    EXPECT_NE(refused.errors.find("long.yaml:5:13: error: duration_s must be within 0..1e9, got "),
              std::string::npos)
        << refused.errors;
  }
}

TEST_F(Limits, FilesThatAreAbsentOrUnreadableAreBadInput) {
  for (const char* const command : {"run", "check"}) {
    ExpectRefused({command, "absent.yaml"}, 3,
                  "absent.yaml: error: cannot open: No such file or directory\n");
    ExpectRefused({command, "."}, 3, ".: error: the path is a directory, not a file\n");
  }
  ExpectRefused({"learn", "."}, 3, ".: error: the path is a directory, not a file\n");
  ExpectRefused({"gait", "values", "."}, 3, ".: error: the path is a directory, not a file\n");
  Write("a.csv", "time_s,x_m\n0,1\n1,2\n");
  ExpectRefused({"compare", "a.csv", "a.csv", "--map", "."}, 3,
                ".: error: the path is a directory, not a file\n");
  for (const char* const folder : {"folder.h5", "folder.csv"}) {
    std::filesystem::create_directory(Path(folder));
    const CommandResult result = Taut({"compare", "a.csv", folder});
    EXPECT_EQ(result.status, 3) << result.errors;
    EXPECT_EQ(result.errors,
              std::string(folder) + "/trace.h5: error: cannot open: No such file or directory\n");
  }
  ExpectRefused({"compare", "a.csv", "a.csv", "--map", "folder.csv"}, 3,
                "folder.csv: error: the path is a directory, not a file\n");
  ExpectRefused({"compare", "none.h5", "none.csv"}, 3,
                "none.csv: error: cannot open: No such file or directory\n"
                "none.h5: error: cannot open: No such file or directory\n");
}

TEST_F(Limits, AnUnknownCommandIsAnsweredByThoseThatThereAre) {
  ExpectRefused({"levitate", "a.yaml"}, 2,
                "error: there is no command \"levitate\" (one of: new, check, view, run, report, "
                "compare, plot, fit, analyze, learn, size, list, ...)\nsee `taut --help`\n");
}

TEST_F(Limits, StrictRunsAndSearchesRefuseWarnings) {
  const std::string warning =
      "the parameter \"idle\" is not used (remove it, or use it in an expression)\n";
  Write("odd.yaml", "taut: 1\nkind: experiment\nbase: " + kHangToLimits +
                        "\nname: odd\nparameters: {idle: 1}\n");
  const CommandResult run = Taut({"run", "odd.yaml", "--quiet", "--duration_s", "0"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.errors, "odd.yaml:5:20: warning: " + warning);
  std::filesystem::remove_all(Path("runs"));
  ExpectRefused({"run", "odd.yaml", "--strict"}, 3, "odd.yaml:5:20: error: " + warning);
  EXPECT_FALSE(std::filesystem::exists(Path("runs")));
  Write("study.yaml",
        "taut: 1\nkind: study\nname: odd\nexperiment: odd.yaml\n"
        "vary: [{all: model.mass, low: 1, high: 2}]\nobjective: {measure: distance}\n"
        "search: [{method: monte_carlo, evaluations: 1}]\n");
  ExpectRefused({"learn", "study.yaml", "--strict"}, 3, "odd.yaml:5:20: error: " + warning);
}

TEST_F(Limits, AFileThatMayNotBeReadIsBadInput) {
  const std::string closed = Write("closed.yaml", "taut: 1\n");
  ASSERT_EQ(chmod(closed.c_str(), 0), 0);
  const auto as_others_do = [] {  // root can read everything unless it drops these capabilities
    for (const int right : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH}) {
      if (prctl(PR_CAPBSET_DROP, right) != 0 && geteuid() == 0) _exit(95);
    }
  };
  ExpectRefused({"check", "closed.yaml"}, 3, "closed.yaml: error: cannot open: Permission denied\n",
                as_others_do);
}

TEST_F(Limits, AModelOfAMillionNodesIsRefusedAtOnce) {
  std::string text = "taut: 1\nkind: model\nname: many\nnodes:\n";
  for (int i = 0; i < 1'000'000; ++i) text += "  n" + std::to_string(i) + ": [0, 0, 1]\n";
  Write("listed.yaml", text);
  ExpectRefused(
      {"check", "listed.yaml"}, 3,
      "listed.yaml: error: the file is larger than 10 MB (write repeated parts once, with "
      "`copies:`)\n");
  text.resize(text.find("  n250000:"));
  Write("fewer.yaml", text);
  ExpectRefused({"check", "fewer.yaml"}, 3,
                "fewer.yaml:200004:12: error: the file has more than 1000000 YAML nodes (an alias "
                "counts once for each use)\n");

  text = "taut: 1\nkind: model\nname: many\nbuilders: []\nparts:\n  seg:\n    nodes:\n";
  for (int i = 0; i < 100; ++i) text += "      n" + std::to_string(i) + ": [0, 0, 1]\n";
  Write("copied.yaml", text + "structure:\n  - {part: seg, copies: 10000}\n");
  ExpectRefused({"check", "copied.yaml"}, 3,
                "copied.yaml:109:5: error: the model has more than 100000 nodes (reduce the 10000 "
                "copies of this placement)\n");
}

TEST_F(Limits, MorePairsThanThereIsRoomForAreRefusedAtOnce) {
  ExpectRefused(
      {"check", TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml", "--set", "segments=2000"}, 3,
      "error: more than 200000000 pairs of shapes of moving bodies may collide: exclude shapes "
      "that "
      "cannot meet\n");
}

TEST_F(Limits, ARecordedChannelThatIsNotThereIsBadInput) {
  const std::string model = TAUT_SOURCE_DIR "/share/models/hanging_mass.yaml";
  Write("e.yaml", "taut: 1\nkind: experiment\nname: e\nmodel: " + model +
                      "\nduration_s: 1\nrecord:\n  channels:\n    - cable/*/tension_n\n"
                      "    - cable/*/tenson_n\n    - '*a*a*a*a*a*a*a*a*a*a*a*a*b'\n");
  const std::string known =
      "one of: cable/*/tension_n, cable/*/elastic_n, cable/*/length_m, cable/*/rate_m_per_s, "
      "cable/*/rest_length_m, cable/*/target_rest_length_m, body/*/position_x_m, "
      "body/*/position_y_m, body/*/position_z_m, body/*/orientation_w, body/*/orientation_x, "
      "body/*/orientation_y, ...";
  for (const char* const command : {"run", "check"}) {
    ExpectRefused(
        {command, "e.yaml"}, 3,
        "e.yaml:9:7: error: record.channels: no channel matches \"cable/*/tenson_n\" (did you "
        "mean \"cable/*/tension_n\"?)\n"
        "e.yaml:10:7: error: record.channels: no channel matches \"*a*a*a*a*a*a*a*a*a*a*a*a*b\" (" +
            known + ")\n");
  }
  EXPECT_FALSE(std::filesystem::exists(Path("runs"))) << "nothing may be overwritten";
}

}  // namespace
}  // namespace taut::test
