// Fits of single experiments, and tests of whether they agree (docs/theory/identification.md, eq.
// F.14a).
#include <algorithm>
#include <cmath>
#include <map>

#include "fit/format.h"
#include "fit/linear_solve.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

using fit::Vector;

/// Names at most this many experiments in a sentence.
constexpr std::size_t kMostNamed = 4;

std::vector<int> ExperimentsOf(const FitProblem& problem) {
  std::vector<int> all;
  for (const FitRow& row : problem.rows) all.push_back(row.experiment);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Returns all other experiments, as left-out groups.
std::vector<bool> Others(const std::vector<int>& experiments, int kept) {
  std::vector<bool> left_out(static_cast<std::size_t>(experiments.back()) + 1, true);
  left_out[static_cast<std::size_t>(kept)] = false;
  return left_out;
}

std::string NameOf(const FitProblem& problem, int experiment) {
  const auto e = static_cast<std::size_t>(experiment);
  return e < problem.experiment_names.size() ? problem.experiment_names[e]
                                             : "experiment " + std::to_string(experiment);
}

/// Returns estimates and errors from the linear system of one experiment at `values`. `step`: also
/// make a Gauss-Newton step.
AloneFit Estimates(const FitProblem& problem, const fit::System& part,
                   const std::vector<double>& values, bool step) {
  AloneFit alone;
  alone.value.resize(values.size());
  alone.se.resize(values.size());
  const std::vector<Eigen::Index> free = fit::FreeOf(problem, values, part);
  if (free.empty()) return alone;
  const fit::Matrix jacobian = fit::Columns(part.jacobian, free);
  const fit::Spread spread = fit::SpreadOf(jacobian);
  Vector d = Vector::Zero(static_cast<Eigen::Index>(free.size()));
  if (step) d = fit::LeastSquares(jacobian, part.residual);
  const fit::Matrix data = jacobian.topRows(part.data_rows);
  const double chi2 = (part.residual.head(part.data_rows) + data * d).squaredNorm();
  const double freedom =
      static_cast<double>(part.data_rows) - (spread.covariance * (data.transpose() * data)).trace();
  // With as many parameters as data, the residuals contain no information about their sds.
  const double factor = freedom >= 1 ? std::sqrt(std::max(1.0, chi2 / freedom)) : 1.0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto j = static_cast<std::size_t>(free[k]);
    const FitParameter& p = problem.parameters[j];
    if (spread.endless[k] || data.col(i).squaredNorm() == 0) continue;
    const double se = factor * FitScale(p) * std::sqrt(spread.covariance(i, i));
    if (se > fit::kEstimatedShare * (fit::HasPrior(p) ? p.prior_sd : FitScale(p))) continue;
    alone.value[j] = values[j] + d[i] * FitScale(p);
    alone.se[j] = se;
  }
  return alone;
}

/// Fits by full searches, with derivatives at each result.
void Refit(const FitProblem& by_experiment, const std::vector<double>& values,
           const std::vector<int>& experiments, const FitOptions& options,
           ExperimentsAlone& result) {
  std::vector<FitJob> jobs;
  for (const int e : experiments) jobs.push_back({values, {}, Others(experiments, e)});
  const FitState state = RunFitJobs(by_experiment, jobs, options);
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    if (state.tracks.empty() || state.tracks[i].end == FitEnd::kInterrupted) {
      result.why = "stopped";
      return;
    }
    const FitTrack& track = state.tracks[i];
    const FitDerivatives here = track.end == FitEnd::kFailed
                                    ? FitDerivatives{}
                                    : Differentiate(by_experiment, track.values);
    if (!here.done) {
      result.why = track.end == FitEnd::kFailed ? track.why : here.why;
      return;
    }
    const fit::System part = fit::SystemOf(by_experiment, jobs[i].left_out, track.values, here);
    result.fits.push_back(Estimates(by_experiment, part, track.values, false));
    result.fits.back().experiment = experiments[i];
  }
}

/// Compares the estimates of one parameter. Returns nothing for fewer than two estimates.
std::optional<Homogeneity> Compare(const FitProblem& problem, const ExperimentsAlone& alone,
                                   std::size_t j) {
  double weights = 0, mean = 0;
  std::vector<std::pair<double, const AloneFit*>> by_distance;
  for (const AloneFit& fit : alone.fits) {
    if (!fit.value[j] || !(*fit.se[j] > 0)) continue;
    const double weight = 1 / (*fit.se[j] * *fit.se[j]);
    weights += weight;
    mean += weight * *fit.value[j];
    by_distance.emplace_back(0.0, &fit);
  }
  if (by_distance.size() < 2) return std::nullopt;
  mean /= weights;
  Homogeneity test;
  test.parameter = j;
  test.freedom = static_cast<double>(by_distance.size()) - 1;
  for (auto& [distance, fit] : by_distance) {
    distance = std::fabs(*fit->value[j] - mean) / *fit->se[j];
    test.chi2 += distance * distance;
  }
  test.p = ChiSquareTail(test.chi2, test.freedom);
  test.apart = test.p < fit::kByChance;
  std::stable_sort(by_distance.begin(), by_distance.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  const FitParameter& p = problem.parameters[j];
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(kMostNamed, by_distance.size()); ++i) {
    const AloneFit& fit = *by_distance[i].second;
    texts.push_back(fit::Brief(*fit.value[j], p.unit) + " +- " + fit::Brief(*fit.se[j], p.unit) +
                    " from " + NameOf(problem, fit.experiment));
  }
  test.sentence = p.name + ": " + fit::List(texts) +
                  (by_distance.size() > kMostNamed ? ", ..." : "") +
                  " alone (p = " + fit::Brief(test.p) + ")";
  return test;
}

}  // namespace

ExperimentsAlone FitExperimentsAlone(const FitProblem& problem, const std::vector<double>& values,
                                     const FitDerivatives& derivatives, Jackknife how,
                                     const FitOptions& options) {
  ExperimentsAlone result;
  const std::vector<int> experiments = ExperimentsOf(problem);
  if (how == Jackknife::kOff) {
    result.why = "it was not requested";
  } else if (experiments.size() < 2) {
    result.why = "there is only one experiment";
  }
  if (!result.why.empty()) return result;
  FitProblem by_experiment = problem;
  for (FitRow& row : by_experiment.rows) row.group = row.experiment;
  if (how == Jackknife::kRefit) {
    Refit(by_experiment, values, experiments, options, result);
  } else {
    for (const int e : experiments) {
      const fit::System part =
          fit::SystemOf(by_experiment, Others(experiments, e), values, derivatives);
      result.fits.push_back(Estimates(by_experiment, part, values, true));
      result.fits.back().experiment = e;
    }
  }
  if (!result.why.empty()) return result;
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (auto test = Compare(problem, result, j)) result.tested.push_back(std::move(*test));
  }
  return result;
}

}  // namespace taut
