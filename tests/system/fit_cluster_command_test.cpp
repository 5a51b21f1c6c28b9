// `taut fit` in several processes (MPI): equal bits for any number of processes
#include "tests/system/ranks.h"
#include "tests/unit/description/hanging_model.h"

namespace taut::test {
namespace {

/// Rows, equilibria and references together; another clock delay gives other residuals for the same
/// run.
const std::string kFittedExperiment = R"(taut: 1
kind: experiment
name: pull
model: model.yaml
parameters: {pull_n: 3}
gravity_m_per_s2: [0, 0, -10]
duration_s: 3
timeline:
  events: [{push: {name: p, node: ball, direction: [0, 0, -1], force_n: [[0, 0], [1, pull_n], [3, pull_n]]}}]
reference: [{source: a scale, cables_n: {c: 11.2}}]
load_cases: [{name: down, forces: [{node: ball, force_n: [0, 0, -2]}]}, {name: up, forces: [{node: ball, force_n: [0, 0, 1]}]}]
)";
const std::string kRanksFit = R"(taut: 1
kind: fit
name: f
experiments:
  - {name: runs, experiment: experiment.yaml, data: runs.csv}
  - {name: rests, experiment: experiment.yaml, data: rests.csv, forward: load_cases}
  - {name: seen_later, experiment: experiment.yaml, data: later.csv, forward: load_cases, use: test, set: {mass_kg: 0.6}}
estimate:
  - {parameter: k_n_per_m, low: 60, high: 160, prior: {sd: 20}}
  - {parameter: pull_n, low: 1, high: 5, prior: {sd: 0.5}}
  - {clock: data, delay_s: {low: -0.2, high: 0.5, sd: 0.2}, experiments: [runs]}
residuals:
  - {channel: node/ball/position_z_m, sd: 0.002, statistic: rows, experiments: [runs], window: {from_s: 0.5, to_s: 1.5}}
  - {channel: node/ball/position_z_m, sd: 0.002, experiments: [rests, seen_later]}
  - {reference: maxima, sd: 0.5, experiments: [runs]}
groups: window
search: {starts: 2, folds: 2, iterations: 5}
)";

class FitRanks : public RanksTest {
 protected:
  FitRanks() {
    Write("model.yaml", kHangingModel);
    Write("experiment.yaml", kFittedExperiment);
    std::string runs = "time_s,node/ball/position_z_m\n";
    for (int i = 0; i <= 60; ++i) {
      const double t = 0.05 * i, pull_n = t < 0.1 ? 0 : t < 1.1 ? 3.2 * (t - 0.1) : 3.2;
      runs += std::to_string(t) + "," + std::to_string(0.1 - (5 + pull_n) / 112) + "\n";
    }
    Write("runs.csv", runs);
    Write("rests.csv", "time_s,node/ball/position_z_m\n0,0.0375\n1,0.0643\n");
    Write("later.csv", "time_s,node/ball/position_z_m\n0,0.0286\n1,0.0554\n");
    Write("fit.yaml", kRanksFit);
  }
};

TEST_F(FitRanks, OneAndThreeProcessesFindTheSameBits) {
  const CommandResult alone = Taut({"fit", "fit.yaml", "--out", "alone"});
  ASSERT_EQ(alone.status, 0) << alone.output << alone.errors;
  const std::string whole = Read(Path("alone/summary.json"));
  for (const int ranks : {1, 3}) {
    const std::string out = "of_" + std::to_string(ranks);
    const CommandResult done = End(StartRanks(ranks, {"fit", "fit.yaml", "--out", out, "--quiet"}));
    ASSERT_EQ(done.status, 0) << done.errors;
    EXPECT_EQ(Read(Path(out + "/summary.json")), whole) << ranks;
  }
  // One process resumes the work of three.
  std::filesystem::remove(Path("of_3/summary.json"));
  const CommandResult resumed = Taut({"fit", "fit.yaml", "--out", "of_3", "--resume", "--quiet"});
  EXPECT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_EQ(Read(Path("of_3/summary.json")), whole);
}

TEST_F(FitRanks, MistakesAreSaidOnceAndEndAll) {
  Write("rests.csv", "time_s,node/ball/position_z_m\n0,0.0375\n");
  const CommandResult done = End(StartRanks(3, {"fit", "fit.yaml", "--out", "bad"}));
  EXPECT_EQ(done.status, 3);
  const std::string message = "has 2 load cases, but its data have 1 rows";
  const std::size_t at = done.errors.find(message);
  ASSERT_NE(at, std::string::npos) << done.errors;
  EXPECT_EQ(done.errors.find(message, at + 1), std::string::npos);
  Write("fit.yaml", kRanksFit);
  Write("rests.csv", "time_s,node/ball/position_z_m\n0,0.0375\n1,0.0643\n");
  EXPECT_EQ(End(StartRanks(3, {"fit", "fit.yaml", "--out", "bad", "--profile", "none"})).status, 2);
}

}  // namespace
}  // namespace taut::test
