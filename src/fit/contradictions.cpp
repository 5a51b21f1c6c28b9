#include "fit/contradictions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/format.h"
#include "fit/problem.h"

namespace taut::fit {
namespace {

/// Jackknife errors contradict errors by J^T J if they are larger by the factor kSeveral, and if
/// the probability of this by chance is below kByChance.
constexpr double kSeveral = 2;
/// Rise of chi-square below which the data do not distinguish two minima: the quantile of
/// chi-square with one degree of freedom for kByChance.
constexpr double kSameFit = 10.83;
/// The result of another start contradicts an estimate if both values are farther apart than this
/// multiple of the distance that the rise of chi-square permits.
constexpr double kFarther = 3;
/// One standard error away from the fit, chi-square should rise by 1. If the standard error is
/// wrong by a factor of 2, this rise changes by a factor of 4.
constexpr double kLeastRise = 0.25, kMostRise = 4;

bool Estimated(const ParameterVerdict& v) { return v.kind == Determined::kEstimated; }

/// Point at a distance of one standard error of one parameter from the fit.
struct PointAway {
  std::vector<double> values;
  /// Whether all other parameters follow as in a refit. Confounded parameters do not follow,
  /// because their errors are infinite; chi-square then rises by more than after a refit.
  bool refitted = true;
};

/// Returns the point at a distance of one standard error of parameter `j` from the fit, in the
/// direction of `sign`. The other parameters follow as in a refit (eq. F.13). Returns nothing
/// beyond the bounds.
std::optional<PointAway> OneErrorAway(const FitProblem& problem, const FitVerdict& verdict,
                                      std::size_t j, double sign) {
  const std::vector<double>& covariance = verdict.identifiability.covariance;
  const std::size_t n = problem.parameters.size();
  const double se = std::sqrt(covariance[j * n + j]);
  if (!(se > 0)) return std::nullopt;
  PointAway point{verdict.values};
  for (std::size_t i = 0; i < n; ++i) {
    const double shared = covariance[j * n + i];
    point.refitted = point.refitted && std::isfinite(covariance[i * n + i]);
    if (std::isfinite(shared)) point.values[i] += sign * shared / se;
    if (point.values[i] < problem.parameters[i].low ||
        point.values[i] > problem.parameters[i].high) {
      return std::nullopt;
    }
  }
  return point;
}

}  // namespace

std::string UnreliableText(const FitParameter& p, const ParameterVerdict& v) {
  std::string text =
      p.name + " = " + Brief(v.value, p.unit) + " +- " + Brief(v.error(), p.unit) + ": unreliable";
  for (const std::string& clause : v.contradictions) text += "; " + clause;
  return text;
}

void ContradictByResiduals(const FitProblem& problem, double least_p, FitVerdict& verdict) {
  const ChiSquare& data = verdict.data;
  if (!(data.p < least_p) || !(data.value > data.freedom) || !(data.freedom > 0)) return;
  const double factor = std::sqrt(data.value / data.freedom);
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    ParameterVerdict& v = verdict.identifiability.parameters[j];
    if (!std::isfinite(v.se) || v.kind == Determined::kAtBound) continue;
    v.se_residuals = std::min(factor * v.se, std::max(v.se, problem.parameters[j].prior_sd));
    if (!Estimated(v)) continue;
    v.contradictions.push_back("the residuals are " + Brief(factor) +
                               " times as large as their standard deviations");
  }
}

void ContradictByGroups(const FitProblem& problem, FitVerdict& verdict) {
  const double freedom = static_cast<double>(verdict.jackknife.groups.size()) - 1;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    ParameterVerdict& v = verdict.identifiability.parameters[j];
    if (!std::isfinite(v.se)) continue;
    v.se_jackknife = verdict.jackknife.se[j];
    if (!v.se_jackknife) continue;
    const std::string& unit = problem.parameters[j].unit;
    const double ratio = v.se > 0 ? *v.se_jackknife / v.se : 0;
    // For independent groups, (G - 1) ratio^2 has a chi-square distribution with G - 1 degrees of
    // freedom (eq. F.14).
    v.groups_apart =
        ratio > kSeveral && ChiSquareTail(freedom * ratio * ratio, freedom) < kByChance;
    const bool small = v.sd_ratio * ratio <= kEstimatedShare;
    if (v.groups_apart && Estimated(v) && !small) {
      v.contradictions.push_back("its estimates without one group or another differ, +- " +
                                 Brief(*v.se_jackknife, unit) +
                                 " (by J^T J, which ignores groups: +- " + Brief(v.se, unit) + ")");
      continue;
    }
    v.sentence += "; leaving out groups: +- " + Brief(*v.se_jackknife, unit);
    if (v.groups_apart) {
      v.sentence +=
          ", " + Brief(ratio) +
          " times the error by J^T J: residuals within a group are correlated, use this error";
    }
  }
}

void ContradictByStarts(const FitProblem& problem, const FitResult& fit, FitVerdict& verdict) {
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    ParameterVerdict& v = verdict.identifiability.parameters[j];
    if (!Estimated(v)) continue;
    double farthest = 1;
    const FitTrack* other = nullptr;
    for (const FitTrack& track : fit.state.tracks) {
      if (track.end == FitEnd::kFailed) continue;
      const double rise = 2 * (track.cost - fit.cost);
      if (!(rise <= kSameFit)) continue;
      const double allowed = kFarther * v.error() * std::sqrt(std::max(rise, 1.0));
      const double distance = std::fabs(track.values[j] - v.value);
      if (!(distance > farthest * allowed)) continue;
      farthest = distance / allowed;
      other = &track;
    }
    if (other == nullptr) continue;
    v.contradictions.push_back(
        "another start ended at " + Brief(other->values[j], problem.parameters[j].unit) +
        " with a chi-square larger by only " + Brief(2 * (other->cost - fit.cost)));
  }
}

void ContradictByCost(const FitProblem& problem, FitVerdict& verdict) {
  std::vector<std::vector<double>> points;
  std::vector<std::size_t> of;
  std::vector<bool> refitted(problem.parameters.size(), true);
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    if (!Estimated(verdict.identifiability.parameters[j])) continue;
    for (const double sign : {1.0, -1.0}) {
      auto point = OneErrorAway(problem, verdict, j, sign);
      if (!point) continue;
      refitted[j] = point->refitted;
      points.push_back(std::move(point->values));
      of.push_back(j);
    }
  }
  if (points.empty()) return;
  const auto answers = Compute(problem, points);
  if (!answers) return;  // the computation was stopped
  const std::vector<bool> all;
  const Rows rows(problem, all);
  const double best = Cost(problem, rows, verdict.values, verdict.derivatives.residual);
  std::vector<std::vector<double>> rises(problem.parameters.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(*answers)[i].failed.empty()) continue;
    rises[of[i]].push_back(2 * (Cost(problem, rows, points[i], (*answers)[i].value) - best));
  }
  for (std::size_t j = 0; j < rises.size(); ++j) {
    const double most = refitted[j] ? kMostRise : std::numeric_limits<double>::infinity();
    const auto wrong = [most](double rise) { return rise < kLeastRise || rise > most; };
    if (std::none_of(rises[j].begin(), rises[j].end(), wrong)) continue;
    std::vector<std::string> texts;
    for (const double rise : rises[j]) texts.push_back(Change(rise, {}));
    verdict.identifiability.parameters[j].contradictions.push_back(
        "one standard error away, chi-square changes by " + List(texts) + " instead of +1");
  }
}

void ContradictByExperiments(FitVerdict& verdict) {
  for (const Homogeneity& test : verdict.alone.tested) {
    if (!test.apart) continue;
    verdict.contradiction = true;
    verdict.identifiability.parameters[test.parameter].contradictions.push_back(
        "experiments fitted alone disagree (p = " + Brief(test.p) + ")");
  }
}

void ContradictByAliases(double least_p, FitVerdict& verdict) {
  for (const AliasTest& test : verdict.aliases) {
    if (test.confounded || !(test.p < least_p)) continue;
    for (std::size_t j = 0; j < test.change.size(); ++j) {
      ParameterVerdict& v = verdict.identifiability.parameters[j];
      if (!Estimated(v) || !(std::fabs(test.change[j]) > v.error())) continue;
      v.contradictions.push_back("it would change by more than its error if the " + test.name +
                                 " were estimated");
    }
  }
}

void ApplyContradictions(const FitProblem& problem, FitVerdict& verdict) {
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    ParameterVerdict& v = verdict.identifiability.parameters[j];
    if (!Estimated(v) || v.contradictions.empty()) continue;
    v.kind = Determined::kUnreliable;
    v.sentence = UnreliableText(problem.parameters[j], v);
  }
}

}  // namespace taut::fit
