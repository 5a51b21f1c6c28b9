// Cross-validation over groups (k-fold) and errors on held-out data.
#include <algorithm>
#include <cmath>

#include "fit/problem.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

std::vector<double> Starts(const FitProblem& problem) {
  std::vector<double> starts;
  for (const FitParameter& p : problem.parameters) starts.push_back(p.start);
  return starts;
}

/// Sums of the squared residuals of some groups, before and after the fit.
struct Squares {
  std::size_t count = 0;
  double untuned = 0, fitted = 0;
  void Add(double before, double after) {
    ++count;
    untuned += before * before;
    fitted += after * after;
  }
  FitErrors Errors() const {
    const double n = static_cast<double>(std::max<std::size_t>(count, 1));
    return {count, std::sqrt(untuned / n), std::sqrt(fitted / n), {}};
  }
};

/// Returns the residuals at the start values, then at each point. `why` receives an error message.
std::vector<Residuals> Evaluate(const FitProblem& problem,
                                const std::vector<std::vector<double>>& points, std::string& why) {
  std::vector<std::vector<double>> all = {Starts(problem)};
  all.insert(all.end(), points.begin(), points.end());
  auto answers = fit::Compute(problem, all);
  if (!answers) {
    why = "stopped";
    return {};
  }
  for (const Residuals& answer : *answers) {
    if (why.empty() && !answer.failed.empty()) why = answer.failed;
  }
  return std::move(*answers);
}

/// Returns the better of two searches, from the fit and from the start; null if both failed.
const FitTrack* Lower(const FitState& state, std::size_t first) {
  const FitTrack* best = nullptr;
  for (std::size_t t = first; t < first + 2; ++t) {
    const FitTrack& track = state.tracks[t];
    if (track.end == FitEnd::kFailed || track.end == FitEnd::kInterrupted) continue;
    if (best == nullptr || track.cost < best->cost) best = &track;
  }
  return best;
}

}  // namespace

FitErrors HoldOut(const FitProblem& test, const std::vector<double>& values) {
  FitErrors errors;
  const std::vector<Residuals> answers = Evaluate(test, {values}, errors.failed);
  if (!errors.failed.empty()) return errors;
  Squares squares;
  for (std::size_t i = 0; i < test.rows.size(); ++i) {
    squares.Add(answers[0].value[i], answers[1].value[i]);
  }
  return squares.Errors();
}

CrossValidation CrossValidate(const FitProblem& problem, const std::vector<double>& values,
                              int folds, const FitOptions& options) {
  CrossValidation result;
  const std::vector<int> groups = fit::Groups(problem);
  const std::size_t count =
      folds <= 0 ? groups.size() : std::min(groups.size(), static_cast<std::size_t>(folds));
  if (count < 2) {
    result.why = "there are fewer than two folds to leave out";
    return result;
  }
  result.folds.resize(count);
  std::vector<std::vector<bool>> left_out(
      count, std::vector<bool>(static_cast<std::size_t>(groups.back()) + 1, false));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    result.folds[g % count].groups.push_back(groups[g]);
    left_out[g % count][static_cast<std::size_t>(groups[g])] = true;
  }
  std::vector<FitJob> jobs;
  for (std::size_t f = 0; f < count; ++f) {
    jobs.push_back({values, {}, left_out[f]});
    jobs.push_back({Starts(problem), {}, left_out[f]});
  }
  const FitState state = RunFitJobs(problem, jobs, options);
  std::vector<std::vector<double>> points;
  for (std::size_t f = 0; f < count; ++f) {
    const FitTrack* track = state.tracks.empty() ? nullptr : Lower(state, 2 * f);
    if (track == nullptr) {
      result.why = state.tracks.empty() ? "stopped" : state.tracks[2 * f].why;
      return result;
    }
    result.folds[f].values = track->values;
    points.push_back(track->values);
  }
  const std::vector<Residuals> answers = Evaluate(problem, points, result.why);
  if (!result.why.empty()) return result;
  Squares all;
  for (std::size_t f = 0; f < count; ++f) {
    Squares squares;
    const fit::Rows rest(problem, left_out[f]);
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
      if (rest.counts(i)) continue;
      squares.Add(answers[0].value[i], answers[f + 1].value[i]);
      all.Add(answers[0].value[i], answers[f + 1].value[i]);
    }
    result.folds[f].errors = squares.Errors();
  }
  result.all = all.Errors();
  return result;
}

}  // namespace taut
