/// Fixture of the tests of `taut learn`: a small study, and access to its results
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "learn/study_log.h"
#include "taut/learn.h"
#include "tests/system/taut_command.h"

namespace taut::test {

inline const std::string kExperiment = R"(taut: 1
kind: experiment
base: )" TAUT_SOURCE_DIR R"(/share/experiments/sidewinder3_start.yaml
duration_s: 0.8
)";

inline const std::string kStudy = R"(taut: 1
kind: study
name: small
experiment: experiment.yaml
seed: 5
vary:
  - {name: frequency, each: motion.sine.frequency_hz, low: 0.5, high: 4, scale: log}
  - {each: motion.sine.*_1.phase_rad, low: -pi, high: pi}
objective: {measure: heading, direction: [0, 1, 0]}
worlds: {count: 2, friction: 0.2, mass: 0.1, start: {position_m: 0.001}, redraw: true}
search:
  - {method: monte_carlo, evaluations: 20}
  - {method: hill_climbing, evaluations: 20, batch: 8}
  - {method: nlopt, evaluations: 20, starts: 4}
  - {method: cma_es, evaluations: 24, batch: 6}
)";

inline std::string Replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, text.npos) << old;
  return at == text.npos ? text : text.replace(at, old.size(), by);
}

class Learn : public CommandTest {
 protected:
  Learn() {
    Write("experiment.yaml", kExperiment);
    Write("study.yaml", kStudy);
  }

  CommandResult Search(const std::string& out, std::vector<std::string> more = {},
                       const std::function<void()>& before = {}) {
    std::vector<std::string> arguments{"learn", "study.yaml", "--out", out, "--threads", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Taut(arguments, before);
  }

  StudyResult Result(const std::string& out) {
    Diagnostics found;
    const auto result = ReadStudyFolder(Path(out), found);
    EXPECT_TRUE(result) << found.Format();
    return result.value_or(StudyResult{});
  }

  /// Changes the contents of the log in a folder, with valid checksums.
  void Change(const std::string& out, const std::function<void(learn::LogContents&)>& change) {
    Diagnostics found;
    const auto log = learn::Log::Open(Path(out + "/study.sqlite"), found);
    auto contents = log ? log->Read(found) : std::nullopt;
    ASSERT_TRUE(contents) << found.Format();
    change(*contents);
    contents->version = 0;  // forces a new version
    EXPECT_TRUE(log->Begin(*contents, found)) << found.Format();
  }
  /// Changes the log by SQL, as another program would.
  void Sql(const std::string& out, const std::string& sql) {
    learn::Database log(Path(out + "/study.sqlite"), learn::Database::Open::kThatIsThere);
    EXPECT_TRUE(log.Execute(sql)) << log.TakeError();
  }

  /// Expects equal studies, except for times.
  void ExpectSame(const std::string& a, const std::string& b) {
    const StudyResult x = Result(a), y = Result(b);
    ASSERT_EQ(x.evaluations.size(), y.evaluations.size());
    for (std::size_t i = 0; i < x.evaluations.size(); ++i) {
      const Evaluation &p = x.evaluations[i], &q = y.evaluations[i];
      EXPECT_EQ(p.id, q.id);
      EXPECT_EQ(p.search, q.search);
      EXPECT_EQ(p.values, q.values) << i;
      EXPECT_EQ(p.failed, q.failed);
      EXPECT_TRUE(p.score == q.score || (std::isnan(p.score) && std::isnan(q.score))) << i;
      EXPECT_EQ(p.seeds, q.seeds);
      ASSERT_EQ(p.worlds.size(), q.worlds.size());
      for (std::size_t w = 0; w < p.worlds.size(); ++w) {
        EXPECT_EQ(p.worlds[w].state_hash, q.worlds[w].state_hash) << i << " " << w;
      }
    }
  }
};

}  // namespace taut::test
