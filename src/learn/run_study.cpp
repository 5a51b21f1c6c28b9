// Runs and resumes a study: optimizers, evaluations and log.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "learn/difference.h"
#include "learn/random_points.h"
#include "learn/study_log.h"
#include "taut/files.h"
#include "taut/learn.h"
#include "taut/optimizer.h"
#include "taut/version.h"

namespace taut {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using learn::Log;
using learn::LogContents;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::string LogPath(const std::string& folder) {
  return (fs::path(folder) / "study.sqlite").string();
}

/// Returns the experiment as text, without the comment about its source file.
std::string ExperimentText(const ExperimentSpec& experiment) {
  ExperimentSpec portable = experiment;
  portable.compare_with.reset();  // contains a path, which may differ between machines
  const std::string text = ResolvedYaml(portable);
  return text.substr(text.find("taut: 1"));
}

/// Returns the start of the search: the values in the experiment, clamped to the bounds.
UnitPoint FirstPoint(const StudySpec& study) {
  std::vector<ControllerSpec> controllers = study.experiment.controllers;
  std::vector<ScaleSpec> scales = TunableScales(study.experiment.robot);
  std::map<std::string, double> present;
  for (const Tunable& t : FindTunables(controllers, scales, study.experiment.robot)) {
    present[t.name] = *t.value;
  }
  UnitPoint point;
  for (const StudyParameter& p : study.parameters) {
    const double value = std::min(p.high, std::max(p.low, present[p.targets[0]]));
    double low = 0, high = 1;  // bisection: inverts ParameterValue to the last bit
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (ParameterValue(p, middle) < value ? low : high) = middle;
    }
    point.push_back(ParameterValue(p, 0.0) >= value ? 0.0 : high);
  }
  return point;
}

class StudyRun {
 public:
  StudyRun(const StudySpec& study, Evaluator& evaluator, const LearnOptions& options, Log& log,
           std::vector<Evaluation> known)
      : study_(study), evaluator_(evaluator), options_(options), log_(log) {
    for (Evaluation& evaluation : known) {
      before_s_ = std::max(before_s_, evaluation.elapsed_s);
      known_.emplace(evaluation.id, std::move(evaluation));
    }
    summary_.resumed_from = static_cast<std::int64_t>(known_.size());
    for (const SearchSpec& search : study.searches) budget_ += search.evaluations;
  }

  LearnSummary Run(Diagnostics& out) {
    started_ = Clock::now();
    if (!SameNumbers(out)) {
      summary_.end = LearnEnd::kRefused;
      return std::move(summary_);
    }
    OptimizerStart start{FirstPoint(study_), std::nullopt, study_.seed, 0};
    for (std::size_t s = 0; s < study_.searches.size(); ++s) {
      start.stream = static_cast<std::uint32_t>(s);
      if (!Search(static_cast<int>(s), start, out)) break;
    }
    // The log may have been deleted since the last evaluation.
    if (out.ok() && !log_.IsThere(out)) summary_.end = LearnEnd::kFailed;
    summary_.wall_s = SinceStart();
    summary_.simulated_s = simulated_s_;
    return std::move(summary_);
  }

 private:
  double SinceStart() const {
    return std::chrono::duration<double>(Clock::now() - started_).count();
  }
  bool Stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  /// Checks that this build of taut reproduces the log: repeats one evaluation and compares the
  /// final states.
  bool SameNumbers(Diagnostics& out) {
    for (const auto& known : known_) {
      const auto id = known.first;
      const auto& logged = known.second;
      if (!logged.failed.empty()) continue;  // a failed evaluation has no final state
      const Evaluator::Candidate again{id, logged.values};
      bool same = true;
      evaluator_.Evaluate({&again, 1}, [&](std::size_t, const Evaluator::Trial& trial) {
        same = trial.worlds.size() == logged.worlds.size();
        for (std::size_t w = 0; same && w < trial.worlds.size(); ++w) {
          same = trial.worlds[w].state_hash == logged.worlds[w].state_hash;
        }
        return same;
      });
      if (same) return true;
      out.Error("study.other_study", {LogPath(options_.folder)},
                "another build of taut wrote the folder: evaluation " + std::to_string(id) +
                    " now ends in a different state",
                "choose another folder with `--out`");
      return false;
    }
    return true;
  }

  /// Runs one of the study's searches. `start`: set to the best point so far. Returns false if the
  /// study must stop.
  bool Search(int number, OptimizerStart& start, Diagnostics& out) {
    const SearchSpec& search = study_.searches[static_cast<std::size_t>(number)];
    const auto optimizer = MakeOptimizer(search, start);
    for (std::int64_t left = search.evaluations; left > 0;) {
      std::vector<UnitPoint> points = optimizer->Ask();
      // The budget may end within a batch. Then the remaining points are not evaluated, and the
      // optimizer is not updated.
      const auto count = std::min(left, static_cast<std::int64_t>(points.size()));
      points.resize(static_cast<std::size_t>(count));
      std::vector<double> scores;
      if (!EvaluateBatch(number, points, scores, out)) return false;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (!learn::Better(scores[i], start.score.value_or(kNothing))) continue;
        start.score = scores[i];
        start.point = points[i];
      }
      left -= count;
      if (left > 0) optimizer->Tell(scores);
    }
    if (!start.score) start.score = kNothing;  // all points were evaluated and failed
    return true;
  }

  bool EvaluateBatch(int number, const std::vector<UnitPoint>& points, std::vector<double>& scores,
                     Diagnostics& out) {
    const std::int64_t first = next_id_;
    next_id_ += static_cast<std::int64_t>(points.size());
    scores.assign(points.size(), 0.0);
    std::vector<Evaluator::Candidate> missing;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::int64_t id = first + static_cast<std::int64_t>(i);
      std::vector<double> values;
      for (std::size_t p = 0; p < study_.parameters.size(); ++p) {
        values.push_back(ParameterValue(study_.parameters[p], points[i][p]));
      }
      const auto logged = known_.find(id);
      if (logged == known_.end()) {
        missing.push_back({id, std::move(values)});
      } else if (logged->second.values != values) {
        out.Error(
            "study.other_values", {LogPath(options_.folder)},
            "evaluation " + std::to_string(id) + " has other values than the search requests now",
            "the file was changed, or written by another build of taut");
        return End(LearnEnd::kRefused);
      } else {
        scores[static_cast<std::size_t>(id - first)] = logged->second.score;
        Count(logged->second);
      }
    }
    if (missing.empty()) return true;
    if (Stopped()) return End(LearnEnd::kInterrupted);
    const bool finished =
        evaluator_.Evaluate(missing, [&](std::size_t c, const Evaluator::Trial& trial) {
          Evaluation evaluation{missing[c].id, number,       missing[c].values,
                                trial.score,   trial.failed, before_s_ + SinceStart(),
                                trial.seeds,   trial.worlds};
          scores[static_cast<std::size_t>(evaluation.id - first)] = trial.score;
          simulated_s_ += study_.experiment.duration_s * static_cast<double>(trial.worlds.size());
          ++done_now_;
          if (!log_.Add(evaluation, out)) return false;
          Count(evaluation);
          Report();
          return !Stopped();
        });
    if (out.ok() && !evaluator_.error().empty()) {
      out.Error("study.not_evaluated", {}, evaluator_.error(),
                "run the same command again to resume");
    }
    if (!out.ok()) return End(LearnEnd::kFailed);
    return finished || End(LearnEnd::kInterrupted);
  }

  /// Sets the end of the study and returns false.
  bool End(LearnEnd end) {
    summary_.end = end;
    return false;
  }

  void Count(const Evaluation& evaluation) {
    ++summary_.evaluations;
    if (!evaluation.failed.empty()) ++summary_.failed;
    if (std::isnan(evaluation.score) || !evaluation.failed.empty()) return;
    // For equal scores, the lowest id is the best, independent of the order of completion.
    const bool better =
        !summary_.best || evaluation.score > summary_.best->score ||
        (evaluation.score == summary_.best->score && evaluation.id < summary_.best->id);
    if (better) summary_.best = evaluation;
  }

  void Report() {
    if (!options_.progress) return;
    LearnProgress p;
    p.evaluations = summary_.evaluations;
    p.budget = budget_;
    p.failed = summary_.failed;
    if (summary_.best) p.best_score = summary_.best->score;
    const double wall_s = SinceStart();
    if (wall_s > 0) {
      p.simulated_s_per_s = simulated_s_ / wall_s;
      p.left_s =
          static_cast<double>(budget_ - p.evaluations) * wall_s / static_cast<double>(done_now_);
    }
    options_.progress(p);
  }

  const StudySpec& study_;
  Evaluator& evaluator_;
  const LearnOptions& options_;
  Log& log_;
  std::map<std::int64_t, Evaluation> known_;
  LearnSummary summary_;
  std::int64_t next_id_ = 0, budget_ = 0, done_now_ = 0;
  double before_s_ = 0, simulated_s_ = 0;
  Clock::time_point started_;
};

/// Loads the experiment text of a log by writing it to a file.
std::optional<ExperimentSpec> LoggedExperiment(const std::string& folder, const std::string& text,
                                               Diagnostics& out) {
  const fs::path file = fs::path(folder) / "experiment.yaml";
  if (!WriteWholeFile(file.string(), text, out)) return std::nullopt;
  return LoadExperiment(file.string(), {}, out);
}

/// Returns whether two texts define the same experiment. Texts of earlier versions lack newer keys,
/// so the logged text is read and written again.
bool SameExperiment(const std::string& folder, const std::string& logged, const std::string& text) {
  Diagnostics unread;
  const auto experiment = LoggedExperiment(folder, logged, unread);
  return experiment && ExperimentText(*experiment) == text;
}

/// Checks that the log belongs to this study. Initializes an empty log. Logs of other versions of
/// taut are accepted here; `SameNumbers` compares their results.
bool Claim(const StudySpec& study, const std::string& folder, LogContents& log, Diagnostics& out) {
  log.facts.emplace("name", study.name);
  if (log.facts.emplace("taut_version", kVersion).second) log.version = 0;
  const std::pair<const char*, std::string> facts[] = {
      {"study", StudyText(study)}, {"experiment", ExperimentText(study.experiment)}};
  for (const auto& [name, text] : facts) {
    const auto [fact, is_new] = log.facts.emplace(name, text);
    if (is_new) log.version = 0;  // empty, or the process was killed before it wrote the facts
    if (is_new || fact->second == text) continue;
    if (fact->first == "experiment" && SameExperiment(folder, fact->second, text)) continue;
    out.Error(
        "study.other_study", {LogPath(folder)},
        std::string("the folder contains another study: its ") + name + " differs\n" +
            learn::Difference(fact->second, text),
        "choose another folder with `--out`, or undo the change; only `evaluations` of the last "
        "search may change");
  }
  if (log.version == 0) log.parameters = study.parameters;
  return out.ok();
}

}  // namespace

LearnSummary RunStudy(const StudySpec& study, Evaluator& evaluator, const LearnOptions& options,
                      Diagnostics& out) {
  LearnSummary none;
  none.end = LearnEnd::kFailed;
  const auto lock = FolderLock::Take(options.folder, out);
  if (!lock) return none;
  const std::string path = LogPath(options.folder);
  const auto log = Log::Open(path, out);
  if (!log) return none;
  auto contents = log->Read(out);
  if (!contents || !Accept(*contents, path, options.skip_damaged, out) ||
      !Claim(study, options.folder, *contents, out)) {
    none.end = LearnEnd::kRefused;
    return none;
  }
  if (!log->Begin(*contents, out)) return none;
  auto summary =
      StudyRun(study, evaluator, options, *log, std::move(contents->evaluations)).Run(out);
  summary.skipped = std::move(contents->damage);
  return summary;
}

std::optional<StudyResult> ReadStudyFolder(const std::string& folder, Diagnostics& out,
                                           bool skip_damaged) {
  const std::string path = LogPath(folder);
  const auto log = Log::OpenToRead(path, out);
  auto contents = log ? log->Read(out) : std::nullopt;
  if (!contents || !Accept(*contents, path, skip_damaged, out)) return std::nullopt;
  if (contents->version == 0) {
    out.Error("study.log_empty", {path}, "the log is empty", "run `taut learn STUDY` first");
    return std::nullopt;
  }
  StudyResult result;
  result.name = contents->facts["name"];
  result.taut_version = contents->facts["taut_version"];
  result.parameters = std::move(contents->parameters);
  result.evaluations = std::move(contents->evaluations);
  result.skipped = std::move(contents->damage);
  auto experiment = LoggedExperiment(folder, contents->facts["experiment"], out);
  if (!experiment) return std::nullopt;
  result.experiment = std::move(*experiment);
  return result;
}

}  // namespace taut
