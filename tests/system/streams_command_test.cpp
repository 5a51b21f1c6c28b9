// Closed or full standard streams: no run ends or loses data, but output that was not printed is an
// error.
#include <nlohmann/json.hpp>

#include "taut/trace.h"
#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

const std::string kHangOnStreams = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";

/// Closed and full streams as by a shell: `2>&-`, `>/dev/full`
std::function<void()> Closed(std::vector<int> descriptors) {
  return [descriptors] {
    for (const int descriptor : descriptors) close(descriptor);
  };
}
std::function<void()> Full(std::vector<int> descriptors) {
  return [descriptors] {
    const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
    for (const int descriptor : descriptors) {
      if (full < 0 || dup2(full, descriptor) < 0) _exit(96);
    }
  };
}
/// Output to a closed pipe, as in `| head -0`
void NobodyReads() {
  int ends[2];
  if (pipe(ends) != 0 || dup2(ends[1], STDOUT_FILENO) < 0 || dup2(ends[1], STDERR_FILENO) < 0) {
    _exit(96);
  }
  close(ends[0]);
  close(ends[1]);
}

class Streams : public CommandTest {
 protected:
  void SetUp() override {
    if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "this machine has no /dev/full";
  }

  /// Runs with output on both streams: a table, and a warning that the step is too long.
  CommandResult RunCoarse(const std::function<void()>& before) {
    std::filesystem::remove_all(Path("run"));
    const CommandResult result =
        Taut({"run", kHangOnStreams, "--step_s", "1", "--out", "run"}, before);
    Diagnostics out;
    const auto trace = ReadTrace(Path("run/trace.h5"), out);
    EXPECT_TRUE(trace) << out.Format();
    if (!trace) return result;
    EXPECT_FALSE(trace->unfinished);
    EXPECT_EQ(trace->time_s.back(), 5.0);
    const auto summary = nlohmann::json::parse(Read(Path("run/summary.json")));
    EXPECT_EQ(summary.at("simulated_s"), 5.0);
    return result;
  }
};

TEST_F(Streams, ThatAreClosedLoseNothingOfARun) {
  for (const std::vector<int>& closed : {std::vector<int>{2}, {1}, {0}, {1, 2}, {0, 1, 2}}) {
    const CommandResult result = RunCoarse(Closed(closed));
    EXPECT_EQ(result.status, 0) << result.errors;
    if (closed == std::vector<int>{1}) {
      EXPECT_NE(
          result.errors.find("warning: cannot write to standard output: Bad file descriptor\n"),
          std::string::npos)
          << result.errors;
    }
  }
}

TEST_F(Streams, ThatAreFullLoseNothingOfARun) {
  for (const std::vector<int>& full : {std::vector<int>{2}, {1}, {1, 2}}) {
    const CommandResult result = RunCoarse(Full(full));
    EXPECT_EQ(result.status, 0) << result.errors;
    if (full == std::vector<int>{1}) {
      EXPECT_NE(
          result.errors.find("warning: cannot write to standard output: No space left on device\n"),
          std::string::npos)
          << result.errors;
    }
  }
}

TEST_F(Streams, ThatNobodyReadsLoseNothingOfARun) { EXPECT_EQ(RunCoarse(NobodyReads).status, 0); }

TEST_F(Streams, BadInputKeepsItsStatus) {
  for (const auto& before : {Full({2}), Closed({2}), Closed({0, 1, 2})}) {
    EXPECT_EQ(Taut({"run", "none.yaml"}, before).status, 3);
    EXPECT_EQ(Taut({"check", "none.yaml"}, before).status, 3);
    EXPECT_EQ(Taut({"compare", "none.h5", "none.h5"}, before).status, 3);
    EXPECT_EQ(Taut({"view", "none.yaml"}, before).status, 3);
    EXPECT_EQ(Taut({"learn", "none.yaml"}, before).status, 3);
    EXPECT_EQ(Taut({"gait", "values", "none.yaml"}, before).status, 3);
    EXPECT_EQ(Taut({"run", "--nothing"}, before).status, 2);
  }
}

TEST_F(Streams, WhatWasToBePrintedAndWasNotIsAFailure) {
  const std::string gait = TAUT_SOURCE_DIR "/share/gaits/hand_tuned_sine.yaml";
  for (const auto& words : {std::vector<std::string>{"check", kHangOnStreams},
                            {"check", "--json", kHangOnStreams},
                            {"gait", "values", gait},
                            {"learn", "--parameters", kHangOnStreams},
                            {"--help"},
                            {"--version"}}) {
    const CommandResult full = Taut(words, Full({1}));
    EXPECT_EQ(full.status, 1) << words[0];
    EXPECT_EQ(full.errors, "error: cannot write to standard output: No space left on device\n")
        << words[0];
    const CommandResult closed = Taut(words, Closed({1}));
    EXPECT_EQ(closed.status, 1) << words[0];
    EXPECT_EQ(closed.errors, "error: cannot write to standard output: Bad file descriptor\n")
        << words[0];
    EXPECT_EQ(Taut(words, NobodyReads).status, 1) << words[0];
  }
  EXPECT_EQ(Taut({"check", kHangOnStreams, "--quiet"}, Full({1})).status, 0)
      << "there is nothing to print";
}

}  // namespace
}  // namespace taut::test
