// Identifiability of parameters: standard errors, null space, correlations and verdicts
// (docs/theory/identification.md, section 4).
#include <algorithm>
#include <cmath>

#include "fit/contradictions.h"
#include "fit/format.h"
#include "fit/linear_solve.h"
#include "fit/problem.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

using fit::Brief;
using fit::Change;
using fit::kInfinite;
using fit::Matrix;
using fit::Vector;

/// Columns of the Jacobian below this norm count as zero [residuals per scale].
constexpr double kDead = 1e-6;
/// Correlation above which a report names both estimates.
constexpr double kTogether = 0.95;
/// Parameters with less than this share of the largest compensating change are not named.
constexpr double kNamed = 0.2;

/// Free parameters (not at a bound), with the Jacobian and its decompositions in scales.
struct Local {
  const FitProblem& problem;
  const FitDerivatives& derivatives;
  std::vector<Eigen::Index> free;
  Matrix data;             ///< Jacobian of the data.
  std::vector<bool> null;  ///< Whether a direction of `svd` belongs to the null space.
  fit::Singular svd;       ///< Decomposition of `data`.
  fit::Spread spread;      ///< Covariance of the data and priors, without null directions.

  const FitParameter& parameter(std::size_t k) const {
    return problem.parameters[static_cast<std::size_t>(free[k])];
  }
};

/// Returns the error of a direction's singular value due to errors of the derivatives (eq. F.12).
double DirectionError(const Local& local, Eigen::Index direction) {
  double sum = 0;
  for (std::size_t k = 0; k < local.free.size(); ++k) {
    sum += std::fabs(local.svd.V(static_cast<Eigen::Index>(k), direction)) *
           local.derivatives.columns[static_cast<std::size_t>(local.free[k])].error;
  }
  return sum;
}

Local MakeLocal(const FitProblem& problem, const std::vector<double>& values,
                const FitDerivatives& derivatives) {
  const fit::System system = fit::SystemOf(problem, {}, values, derivatives);
  Local local{problem, derivatives, fit::FreeOf(problem, values, system), {}, {}, {}, {}};
  const Matrix all = fit::Columns(system.jacobian, local.free);
  local.data = all.topRows(system.data_rows);
  const auto n = static_cast<Eigen::Index>(local.free.size());
  if (n == 0) return local;
  local.svd = fit::Decompose(local.data);
  // A matrix with the same J^T J as the data, without null directions: diag(s) V^T.
  Matrix stacked = Matrix::Zero(n + all.rows() - system.data_rows, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double s = local.svd.value[k];
    const double least = std::max(fit::kNullShare * local.svd.value[0], DirectionError(local, k));
    local.null.push_back(s <= least);
    if (!local.null.back()) stacked.row(k) = s * local.svd.V.col(k).transpose();
  }
  stacked.bottomRows(all.rows() - system.data_rows) = all.bottomRows(all.rows() - system.data_rows);
  local.spread = fit::SpreadOf(stacked);
  return local;
}

std::vector<FitDirection> Directions(const Local& local) {
  std::vector<FitDirection> directions;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(local.null.size()); ++k) {
    FitDirection direction;
    direction.singular = local.svd.value[k];
    direction.null = local.null[static_cast<std::size_t>(k)];
    direction.fixed = !direction.null && direction.singular >= std::sqrt(3.0);
    direction.direction.assign(local.problem.parameters.size(), 0.0);
    for (std::size_t j = 0; j < local.free.size(); ++j) {
      direction.direction[static_cast<std::size_t>(local.free[j])] =
          local.svd.V(static_cast<Eigen::Index>(j), k);
    }
    directions.push_back(std::move(direction));
  }
  return directions;
}

/// Returns the changes of all free parameters if parameter k moves by one scale and the others are
/// refitted. The changes are in the null space if parameter k belongs to it; otherwise they follow
/// from the covariance (eq. F.13).
Vector Trade(const Local& local, std::size_t k) {
  const auto i = static_cast<Eigen::Index>(k);
  Vector d = local.spread.covariance.col(i);
  if (local.spread.endless[k]) d = local.spread.null * local.spread.null.row(i).transpose();
  return d / d[i];
}

double ScaleIn(const FitParameter& p) { return fit::HasPrior(p) ? p.prior_sd : FitScale(p); }

void Classify(const Local& local, std::size_t k, ParameterVerdict& verdict) {
  const FitParameter& p = local.parameter(k);
  const auto i = static_cast<Eigen::Index>(k);
  const double scale = FitScale(p), column = local.data.col(i).norm();
  const double prior = fit::HasPrior(p) ? scale / p.prior_sd : 0.0;
  verdict.se_alone = scale / std::sqrt(column * column + prior * prior);
  verdict.se =
      local.spread.endless[k] ? kInfinite : scale * std::sqrt(local.spread.covariance(i, i));
  verdict.sd_ratio = verdict.se / ScaleIn(p);
  if (column <= kDead) {
    verdict.kind = Determined::kDead;
  } else if (verdict.sd_ratio <= fit::kEstimatedShare) {
    verdict.kind = Determined::kEstimated;
  } else if (verdict.se_alone <= fit::kEstimatedShare * ScaleIn(p)) {
    verdict.kind = Determined::kConfounded;
  } else {
    verdict.kind = fit::HasPrior(p) ? Determined::kPrior : Determined::kWeak;
  }
  if (verdict.kind != Determined::kConfounded) return;
  const Vector d = Trade(local, k);
  verdict.confounded_residual = (local.data * d).norm();
  double largest = 0;
  for (Eigen::Index j = 0; j < d.size(); ++j) {
    if (j != i) largest = std::max(largest, std::fabs(d[j]));
  }
  if (verdict.confounded_residual > scale / (fit::kEstimatedShare * ScaleIn(p))) {
    // A compensating change leaves the residuals nearly unchanged. This change does not: its
    // direction counts as null only because of the errors of the derivatives (eq. F.12).
    verdict.kind = Determined::kUnreliable;
    verdict.contradictions.push_back(
        "its derivatives are too inaccurate: a change that they do not resolve moves the residuals "
        "by " +
        Brief(verdict.confounded_residual) + " standard deviations in all");
    return;
  }
  verdict.confounded_with.emplace_back(local.free[k], scale);
  for (Eigen::Index j = 0; j < d.size(); ++j) {
    if (j == i || std::fabs(d[j]) < kNamed * largest) continue;
    const auto other = static_cast<std::size_t>(j);
    verdict.confounded_with.emplace_back(local.free[other],
                                         d[j] * FitScale(local.parameter(other)));
  }
}

std::string With(const FitProblem& problem,
                 const std::vector<std::pair<std::size_t, double>>& confounded_with) {
  std::vector<std::string> parts;
  for (std::size_t k = 1; k < confounded_with.size(); ++k) {
    const FitParameter& p = problem.parameters[confounded_with[k].first];
    parts.push_back(p.name + " " + Change(confounded_with[k].second, p.unit));
  }
  return fit::List(parts);
}

std::string Against(const FitProblem& problem,
                    const std::vector<std::pair<std::size_t, double>>& confounded_with) {
  std::vector<std::string> names;
  for (std::size_t k = 1; k < confounded_with.size(); ++k) {
    names.push_back(problem.parameters[confounded_with[k].first].name);
  }
  return fit::List(names);
}

/// Returns a text that names the parameters correlated with an estimate.
std::string Together(const FitProblem& problem, const Identifiability& all, std::size_t j) {
  const std::size_t n = problem.parameters.size();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = all.correlation[j * n + i];
    if (i != j && std::fabs(r) > kTogether) {
      names.push_back(problem.parameters[i].name + " (" + Brief(r) + ")");
    }
  }
  return names.empty() ? "" : "; it is correlated with " + fit::List(names);
}

/// Returns whether the step was shortened to less than the standard error.
bool Bends(const FitColumn& column, double se) {
  return column.step_share < 1.0 && se > column.step;
}

std::string Sentence(const FitProblem& problem, const Identifiability& all, std::size_t j,
                     const FitColumn& column) {
  const FitParameter& p = problem.parameters[j];
  const ParameterVerdict& v = all.parameters[j];
  const std::string value = p.name + " = " + Brief(v.value, p.unit);
  const std::string error = " +- " + Brief(v.se, p.unit);
  std::string text;
  switch (v.kind) {
    case Determined::kEstimated:
      text = value + error + ": estimated" + Together(problem, all, j);
      break;
    case Determined::kPrior:
      text = value + error + ": held by its prior; the data leave " + Brief(100 * v.sd_ratio) +
             " % of its standard deviation";
      break;
    case Determined::kAtBound:
      text = value + ": at its " + (v.value <= p.low ? "lower" : "upper") +
             " bound; the optimum lies beyond it";
      break;
    case Determined::kDead:
      text = p.name + ": without influence; no residual depends on it";
      if (column.curved > kDead)
        text = p.name + ": without influence here; residuals depend on it only to second order";
      break;
    case Determined::kWeak:
      text = value + error + ": weakly identified, even if all others were known (+- " +
             Brief(v.se_alone, p.unit) + ")";
      if (v.sd_ratio < kInfinite && v.se_alone < 0.9 * v.se) text += Together(problem, all, j);
      break;
    case Determined::kConfounded:
      text = value + error + ": confounded with " + Against(problem, v.confounded_with) + "; " +
             Change(v.confounded_with[0].second, p.unit) + " with " +
             With(problem, v.confounded_with) + " changes the residuals by only " +
             Brief(v.confounded_residual) +
             " standard deviations in all (if the others were known: +- " +
             Brief(v.se_alone, p.unit) + ")";
      break;
    case Determined::kUnreliable:
      text = fit::UnreliableText(p, v);
      break;
  }
  if (column.kink) {
    text += "; its derivative depends on the step by " + Brief(100 * column.kink_share) +
            " %, and no shorter step resolves it: a kink or noise";
  } else if (Bends(column, v.se)) {
    text += "; its derivative was computed with steps of " + Brief(column.step, p.unit) +
            ", shorter than its error, and longer steps disagree";
  }
  if (!column.failed.empty())
    text += "; neighboring points could not be computed: " + column.failed;
  return text;
}

void Correlate(const Local& local, Identifiability& all) {
  const std::size_t n = local.problem.parameters.size();
  all.correlation.assign(n * n, 0.0);
  all.covariance.assign(n * n, 0.0);
  for (std::size_t k = 0; k < local.free.size(); ++k) {
    for (std::size_t m = 0; m < local.free.size(); ++m) {
      const auto i = static_cast<std::size_t>(local.free[k]);
      const auto j = static_cast<std::size_t>(local.free[m]);
      const auto& C = local.spread.covariance;
      const auto ki = static_cast<Eigen::Index>(k), mi = static_cast<Eigen::Index>(m);
      const bool endless = local.spread.endless[k] || local.spread.endless[m];
      const double variance = C(ki, ki) * C(mi, mi);
      if (!endless && variance > 0) all.correlation[i * n + j] = C(ki, mi) / std::sqrt(variance);
      if (!endless) {
        all.covariance[i * n + j] =
            C(ki, mi) * FitScale(local.parameter(k)) * FitScale(local.parameter(m));
      } else if (k == m) {
        all.covariance[i * n + j] = kInfinite;
      }
    }
  }
}

}  // namespace

Identifiability Identify(const FitProblem& problem, const std::vector<double>& values,
                         const FitDerivatives& derivatives) {
  const std::size_t n = problem.parameters.size();
  Identifiability all;
  const Local local = MakeLocal(problem, values, derivatives);
  all.parameters.resize(n);
  for (std::size_t j = 0; j < n; ++j) {
    const FitParameter& p = problem.parameters[j];
    ParameterVerdict& verdict = all.parameters[j];
    verdict.kind = Determined::kAtBound;  // free parameters are classified below
    verdict.value = values[j];
    if (fit::HasPrior(p)) verdict.pull = (values[j] - fit::PriorMean(p)) / p.prior_sd;
  }
  for (std::size_t k = 0; k < local.free.size(); ++k) {
    Classify(local, k, all.parameters[static_cast<std::size_t>(local.free[k])]);
  }
  all.directions = Directions(local);
  for (const FitDirection& direction : all.directions) {
    all.fixed += direction.fixed ? 1 : 0;
    if (direction.null) all.condition = kInfinite;
  }
  if (!all.directions.empty() && all.condition == 0) {
    all.condition = all.directions.front().singular / all.directions.back().singular;
  }
  if (!local.free.empty()) {
    const Matrix H = local.spread.covariance * (local.data.transpose() * local.data);
    all.effective = H.trace();
    all.effective_square = (H * H).trace();
    all.endless = static_cast<int>(local.spread.null.cols());
  }
  Correlate(local, all);
  for (std::size_t j = 0; j < n; ++j) {
    const FitColumn& column = derivatives.columns[j];
    all.parameters[j].kink = column.kink || Bends(column, all.parameters[j].se);
    all.parameters[j].sentence = Sentence(problem, all, j, derivatives.columns[j]);
  }
  return all;
}

}  // namespace taut
