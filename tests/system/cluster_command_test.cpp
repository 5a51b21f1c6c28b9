// `taut learn` in several processes (MPI): the same result, and behavior if a process dies
#include <chrono>
#include <cmath>
#include <thread>

#include "taut/learn.h"
#include "tests/system/ranks.h"

namespace taut::test {
namespace {

const std::string kStudiedExperiment = R"(taut: 1
kind: experiment
base: )" TAUT_SOURCE_DIR R"(/share/experiments/sidewinder3_start.yaml
duration_s: 0.5
)";

std::string Study(int evaluations) {
  return R"(taut: 1
kind: study
name: small
experiment: experiment.yaml
seed: 5
vary:
  - {each: motion.sine.*_1.phase_rad, low: -pi, high: pi}
objective: {measure: distance}
worlds: {count: 2, friction: 0.2}
search:
  - {method: hill_climbing, evaluations: 30, batch: 7}
  - {method: nlopt, evaluations: 20, starts: 3}
  - {method: cma_es, batch: 6, evaluations: )" +
         std::to_string(evaluations) + "}\n";
}

class Mpi : public RanksTest {
 protected:
  void SetUp() override {
    Write("experiment.yaml", kStudiedExperiment);
    Write("study.yaml", Study(20));
    RanksTest::SetUp();
  }

  /// Starts `taut learn`.
  pid_t StartRanks(int ranks, const std::string& out, const std::string& study = "study.yaml") {
    return RanksTest::StartRanks(ranks, {"learn", study, "--out", out, "--quiet"});
  }

  std::vector<Evaluation> Evaluations(const std::string& out) {
    Diagnostics found;
    const auto result = ReadStudyFolder(Path(out), found);
    EXPECT_TRUE(result) << found.Format();
    return result ? result->evaluations : std::vector<Evaluation>{};
  }

  void ExpectSame(const std::string& a, const std::string& b) {
    const auto x = Evaluations(a), y = Evaluations(b);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_EQ(x[i].values, y[i].values);
      EXPECT_EQ(x[i].score, y[i].score);
      ASSERT_EQ(x[i].worlds.size(), y[i].worlds.size());
      for (std::size_t w = 0; w < x[i].worlds.size(); ++w) {
        EXPECT_EQ(x[i].worlds[w].state_hash, y[i].worlds[w].state_hash);
        EXPECT_EQ(x[i].worlds[w].energy_j, y[i].worlds[w].energy_j);
      }
    }
  }
};

TEST_F(Mpi, OneTwoAndThreeProcessesFindTheSame) {
  ASSERT_EQ(Taut({"learn", "study.yaml", "--out", "alone", "--quiet"}).status, 0);
  ASSERT_EQ(Evaluations("alone").size(), 70u);
  for (const int ranks : {1, 2, 3}) {
    const std::string out = "of_" + std::to_string(ranks);
    const CommandResult result = End(StartRanks(ranks, out));
    ASSERT_EQ(result.status, 0) << result.errors;
    ExpectSame("alone", out);
  }
}

TEST_F(Mpi, ARankThatDiesEndsAllAndTheSearchGoesOn) {
  Write("long.yaml", Study(100000));
  const pid_t pid = StartRanks(3, "dying", "long.yaml");
  while (!std::filesystem::exists(Path("dying/study.sqlite"))) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  // Ranks are mpirun's children.
  const std::string list =
      "/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid) + "/children";
  std::ifstream children(list);
  pid_t rank = 0, last = 0;
  while (children >> rank) last = rank;
  ASSERT_GT(last, 0);
  kill(last, SIGKILL);
  EXPECT_NE(End(pid).status, 0);
  // The completed evaluations are a prefix of any longer search. The new budget may be smaller or
  // larger than their number.
  const std::size_t done = Evaluations("dying").size();
  Write("long.yaml", Study(static_cast<int>(std::max<std::size_t>(done, 50)) - 50 + 10));
  const CommandResult resumed = End(StartRanks(2, "dying", "long.yaml"));
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  ASSERT_EQ(Taut({"learn", "long.yaml", "--out", "whole", "--quiet"}).status, 0);
  const std::vector<Evaluation> whole = Evaluations("whole"), both = Evaluations("dying");
  ASSERT_GE(both.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(both[i].id, whole[i].id);
    EXPECT_EQ(both[i].values, whole[i].values);
    EXPECT_EQ(both[i].score, whole[i].score);
  }
}

TEST_F(Mpi, BadInputIsSaidOnce) {
  Write("study.yaml", "taut: 1\nkind: study\nname: x\n");
  const CommandResult result = End(StartRanks(2, "bad"));
  EXPECT_EQ(result.status, 3);
  const std::string message = "study.yaml:1:1: error: the file needs the key \"experiment\"";
  const std::size_t at = result.errors.find(message);
  ASSERT_NE(at, std::string::npos) << result.errors;
  EXPECT_EQ(result.errors.find(message, at + 1), std::string::npos);
}

}  // namespace
}  // namespace taut::test
