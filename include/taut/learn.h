/// Parameter search (optimization): runs a study until its budget is spent. All data is kept in one
/// folder, so that a study can be stopped, killed and resumed with a bit-identical result.
///
/// Threads: any number may call these functions at once, each with a separate folder, evaluator and
/// diagnostics; a study is only read. `stop` may be set from any thread.
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
  int search = 0;                    ///< Index of the study's search that proposed it.
  std::vector<double> values;        ///< Of the study's parameters, in their units.
  double score = 0;                  ///< NaN if it failed.
  std::string failed;                ///< Reason of a failure; else empty.
  double elapsed_s = 0;              ///< Working time of the study at its end.
  std::vector<std::uint64_t> seeds;  ///< One per world.
  std::vector<RolloutResult> worlds;
};

/// Returns the first world of candidate `values`, which has no perturbation.
RolloutWorld NominalWorld(const StudySpec& study, const std::vector<double>& values);
/// Returns all worlds of candidate `values`. Perturbations follow from the study's seed and, with
/// `PerturbationSpec::redraw`, from `evaluation`.
std::vector<RolloutWorld> CandidateWorlds(const StudySpec& study, const std::vector<double>& values,
                                          std::int64_t evaluation);

/// Returns the value of a parameter at position x in [0, 1] between its bounds.
double ParameterValue(const StudyParameter& parameter, double x);

/// Evaluates candidates, in this process or on the processes of a cluster.
///
/// Threads: call it from one thread at a time; it calls `Done` from other threads.
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
  /// Called with each finished trial, by one thread at a time, in any order. Return false to stop.
  using Done = std::function<bool(std::size_t candidate, const Trial&)>;
  /// Returns false if it was stopped or failed; after a failure, `error()` has the reason.
  virtual bool Evaluate(std::span<const Candidate> candidates, const Done& done) = 0;
  virtual std::string error() const { return {}; }
};

/// Returns the evaluator for this process, or null with diagnostics if the experiment's model does
/// not compile. `threads`, `stop`: as in `RolloutOptions`.
std::unique_ptr<Evaluator> MakeEvaluator(const StudySpec& study, int threads,
                                         const std::atomic<bool>* stop, Diagnostics& out);

struct LearnProgress {
  std::int64_t evaluations = 0, budget = 0, failed = 0;
  std::optional<double> best_score;
  double simulated_s_per_s = 0;  ///< Of this session, all worlds together.
  double left_s = 0;             ///< Estimated remaining time.
};

struct LearnOptions {
  std::string folder;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const LearnProgress&)> progress;
  bool skip_damaged = false;  ///< Repeats evaluations whose record in the folder is damaged.
};

enum class LearnEnd {
  kFinished,
  kInterrupted,  ///< Can be resumed.
  kFailed,       ///< The folder cannot be written or is gone, or processes of the cluster are gone.
  kRefused,      ///< The folder contains another study or is damaged.
};

struct LearnSummary {
  LearnEnd end = LearnEnd::kFinished;
  std::int64_t evaluations = 0, failed = 0, resumed_from = 0;
  std::optional<Evaluation> best;
  double wall_s = 0, simulated_s = 0;  ///< Of this session.
  std::vector<std::string> skipped;    ///< Damaged records: "evaluation 17: ...".
};

/// Runs or resumes a study. On failure or refusal, diagnostics have the reason.
LearnSummary RunStudy(const StudySpec& study, Evaluator& evaluator, const LearnOptions& options,
                      Diagnostics& out);

/// Contents of a study's folder.
struct StudyResult {
  std::string name;
  std::string taut_version;  ///< Version that began the study.
  std::vector<StudyParameter> parameters;
  std::vector<Evaluation> evaluations;  ///< Ordered by id.
  ExperimentSpec experiment;            ///< Resolved.
  std::vector<std::string> skipped;     ///< Damaged records: "evaluation 17: ...".

  /// Returns the evaluation with the best score, the first of equal ones, or null if none
  /// succeeded.
  const Evaluation* best() const;
  /// Returns the best `count` evaluations, best first.
  std::vector<const Evaluation*> top(std::size_t count) const;
  /// Returns the experiment with a candidate's values in its controllers and scales.
  ExperimentSpec ExperimentWith(const std::vector<double>& values) const;
};

/// Reads a study's folder. Returns nothing, with diagnostics, if it contains no study or, unless
/// `skip_damaged`, if any record is damaged.
std::optional<StudyResult> ReadStudyFolder(const std::string& folder, Diagnostics& out,
                                           bool skip_damaged = false);

}  // namespace taut
