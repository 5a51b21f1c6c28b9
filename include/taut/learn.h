/// Searching: a study, run until its budget is spent. Everything is kept in one folder, so that it
/// can be stopped, killed and resumed, and comes to the same end bit for bit.
///
/// Threads: any number may call these functions at once, each with a folder, an evaluator and
/// diagnostics of its own; they only read a study. Whoever sets `stop` may be any thread.
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

/// One candidate's trial.
struct Evaluation {
  std::int64_t id = 0;
  int search = 0;                    ///< Which of the study's searches asked for it.
  std::vector<double> values;        ///< Of the study's parameters, in their units.
  double score = 0;                  ///< NaN if it failed.
  std::string failed;                ///< Why; empty if it did not.
  double elapsed_s = 0;              ///< Working time of the study when it was done.
  std::vector<std::uint64_t> seeds;  ///< A world each.
  std::vector<RolloutResult> worlds;
};

/// Candidate `values` in the first of its worlds, which nothing perturbs.
RolloutWorld NominalWorld(const StudySpec& study, const std::vector<double>& values);
/// All its worlds. Perturbations follow from the study's seed, and from `evaluation` if the study
/// wants other worlds each time.
std::vector<RolloutWorld> CandidateWorlds(const StudySpec& study, const std::vector<double>& values,
                                          std::int64_t evaluation);

/// What a parameter is at x in [0, 1] of its bounds.
double ParameterValue(const StudyParameter& parameter, double x);

/// Tries candidates: here, or on the processes of a cluster. One thread at a time; it calls `Done`
/// from threads of its own.
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
  /// Called with each trial when it is done, by one thread at a time, in any order. False stops.
  using Done = std::function<bool(std::size_t candidate, const Trial&)>;
  /// False if it was stopped, or failed (then `error()`).
  virtual bool Evaluate(std::span<const Candidate> candidates, const Done& done) = 0;
  virtual std::string error() const { return {}; }
};

/// The one for this process.
std::unique_ptr<Evaluator> MakeEvaluator(const StudySpec& study, int threads,
                                         const std::atomic<bool>* stop, Diagnostics& out);

struct LearnProgress {
  std::int64_t evaluations = 0, budget = 0, failed = 0;
  std::optional<double> best_score;
  double simulated_s_per_s = 0;  ///< Of this session, all worlds together.
  double left_s = 0;             ///< Expected.
};

struct LearnOptions {
  std::string folder;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const LearnProgress&)> progress;
  bool skip_damaged = false;  ///< Do evaluations again whose record in the folder is damaged.
};

enum class LearnEnd {
  kFinished,
  kInterrupted,  ///< It can go on from here.
  kFailed,       ///< The folder cannot be written, or is gone; processes of the cluster are.
  kRefused,      ///< The folder holds another study, or is damaged.
};

struct LearnSummary {
  LearnEnd end = LearnEnd::kFinished;
  std::int64_t evaluations = 0, failed = 0, resumed_from = 0;
  std::optional<Evaluation> best;
  double wall_s = 0, simulated_s = 0;  ///< Of this session.
  std::vector<std::string> skipped;    ///< What was damaged: "evaluation 17: ...".
};

/// Runs or resumes. Diagnostics say why if it failed or was refused.
LearnSummary RunStudy(const StudySpec& study, Evaluator& evaluator, const LearnOptions& options,
                      Diagnostics& out);

/// A study's folder, read back.
struct StudyResult {
  std::string name;
  std::string taut_version;  ///< Version that began the study.
  std::vector<StudyParameter> parameters;
  std::vector<Evaluation> evaluations;  ///< By id.
  ExperimentSpec experiment;            ///< As it was resolved.
  std::vector<std::string> skipped;     ///< What was damaged: "evaluation 17: ...".

  /// The best, or nothing if none succeeded; of equal ones the first.
  const Evaluation* best() const;
  /// The best `count`, best first.
  std::vector<const Evaluation*> top(std::size_t count) const;
  /// The experiment with a candidate's values in its controllers and scales.
  ExperimentSpec ExperimentWith(const std::vector<double>& values) const;
};

/// Nothing and diagnostics if the folder holds no study, or if any record of it is damaged, unless
/// those are to be skipped.
std::optional<StudyResult> ReadStudyFolder(const std::string& folder, Diagnostics& out,
                                           bool skip_damaged = false);

}  // namespace taut
