/// Parameter search (optimization): runs a study until its budget is used up. All data are in one
/// folder, so a study can be stopped, killed and resumed with a bit-identical result.
///
/// Threads: any number may call these functions concurrently, each with a different folder,
/// evaluator and diagnostics. The study is read-only. Any thread may set `stop`.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/rollout.h"
#include "taut/study.h"

namespace taut {

/// Result of one candidate.
struct Evaluation {
  std::int64_t id = 0;
  int search = 0;              ///< Index of the search in the study that proposed the candidate.
  std::vector<double> values;  ///< Values of the study's parameters, in their units.
  double score = 0;            ///< NaN after a failure.
  std::string failed;          ///< Reason of a failure; otherwise empty.
  double elapsed_s = 0;        ///< Working time of the study at the end of this evaluation.
  std::vector<std::uint64_t> seeds;  ///< One per world.
  std::vector<RolloutResult> worlds;
};

/// Returns the first world of candidate `values`, which has no perturbations.
RolloutWorld NominalWorld(const StudySpec& study, const std::vector<double>& values);
/// Returns all worlds of candidate `values`. Perturbations depend on the study's seed and, with
/// `PerturbationSpec::redraw`, on `evaluation`.
std::vector<RolloutWorld> CandidateWorlds(const StudySpec& study, const std::vector<double>& values,
                                          std::int64_t evaluation);

/// Returns the value of a parameter at position x in [0, 1] between its bounds.
double ParameterValue(const StudyParameter& parameter, double x);

/// Evaluates candidates in this process or in the processes of a cluster.
///
/// Threads: call `Evaluate` from one thread at a time. It calls `Done` from other threads.
class Evaluator {
 public:
  virtual ~Evaluator() = default;
  struct Candidate {
    std::int64_t id = 0;
    std::vector<double> values;
  };
  struct Trial {
    bool done = false;
    double score = 0;
    std::string failed;
    std::vector<std::uint64_t> seeds;
    std::vector<RolloutResult> worlds;
  };
  /// Called after each finished trial, in any order, by one thread at a time. Return false to stop.
  using Done = std::function<bool(std::size_t candidate, const Trial&)>;
  /// Returns false after a stop or a failure; after a failure, `error()` contains the reason.
  virtual bool Evaluate(std::span<const Candidate> candidates, const Done& done) = 0;
  virtual std::string error() const { return {}; }
};

/// Returns an evaluator for this process. Returns null and adds diagnostics if the model of the
/// experiment does not compile. `threads`, `stop`: see `RolloutOptions`.
std::unique_ptr<Evaluator> MakeEvaluator(const StudySpec& study, int threads,
                                         const std::atomic<bool>* stop, Diagnostics& out);

struct LearnProgress {
  std::int64_t evaluations = 0, budget = 0, failed = 0;
  std::optional<double> best_score;
  /// Simulated time per second of this session, all worlds together.
  double simulated_s_per_s = 0;
  double left_s = 0;  ///< Estimated remaining time.
};

struct LearnOptions {
  std::string folder;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const LearnProgress&)> progress;
  bool skip_damaged = false;  ///< Repeats evaluations with damaged records in the folder.
};

enum class LearnEnd {
  kFinished,
  kInterrupted,  ///< The study can be resumed.
  kFailed,       ///< The folder is missing or not writable, or processes of the cluster ended.
  kRefused,      ///< The folder contains another study or is damaged.
};

struct LearnSummary {
  LearnEnd end = LearnEnd::kFinished;
  std::int64_t evaluations = 0, failed = 0, resumed_from = 0;
  std::optional<Evaluation> best;
  double wall_s = 0, simulated_s = 0;  ///< Times of this session.
  std::vector<std::string> skipped;    ///< Damaged records: "evaluation 17: ...".
};

/// Runs or resumes a study. On failure or refusal, diagnostics contain the reason.
LearnSummary RunStudy(const StudySpec& study, Evaluator& evaluator, const LearnOptions& options,
                      Diagnostics& out);

/// Contents of the folder of a study.
struct StudyResult {
  std::string name;
  std::string taut_version;  ///< Version of taut that started the study.
  std::vector<StudyParameter> parameters;
  std::vector<Evaluation> evaluations;  ///< Evaluations, ordered by id.
  ExperimentSpec experiment;            ///< Resolved experiment.
  std::vector<std::string> skipped;     ///< Damaged records: "evaluation 17: ...".

  /// Returns the evaluation with the best score, the first one if equal. Null if all failed.
  const Evaluation* best() const;
  /// Returns the best `count` evaluations, best first.
  std::vector<const Evaluation*> top(std::size_t count) const;
  /// Returns the experiment with the values of a candidate in its controllers and scale factors.
  ExperimentSpec ExperimentWith(const std::vector<double>& values) const;
};

/// Reads the folder of a study. Returns nothing and adds diagnostics if it contains no study or,
/// unless `skip_damaged`, a damaged record.
std::optional<StudyResult> ReadStudyFolder(const std::string& folder, Diagnostics& out,
                                           bool skip_damaged = false);

}  // namespace taut
