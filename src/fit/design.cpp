// Optimal design of the next measurement: Bayesian D-optimality with greedy selection
// (docs/theory/identification.md, section 7).
#include "taut/fit_design.h"

#include <algorithm>
#include <cmath>

#include "fit/format.h"
#include "fit/linear_solve.h"
#include "math/elementary.h"

namespace taut {
namespace {

using fit::Matrix;

std::vector<std::string> Wrong(const std::vector<FitParameter>& parameters,
                               const DesignCandidate& candidate) {
  std::vector<std::string> wrong;
  if (candidate.jacobian.size() != candidate.sd.size() * parameters.size()) {
    wrong.push_back(candidate.name + ": its Jacobian must have one row per standard deviation");
  }
  for (const double sd : candidate.sd) {
    if (sd > 0) continue;
    wrong.push_back(candidate.name + ": a standard deviation is not above 0");
    break;
  }
  return wrong;
}

double PriorIn(const FitParameter& p) { return fit::HasPrior(p) ? p.prior_sd : FitScale(p); }

/// Returns J^T J of a candidate in units of the priors. Omits rows that could not be computed.
Matrix Information(const std::vector<FitParameter>& parameters, const DesignCandidate& candidate) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Matrix sum = Matrix::Zero(n, n);
  for (std::size_t i = 0; i < candidate.sd.size(); ++i) {
    fit::Vector row(n);
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      row[static_cast<Eigen::Index>(j)] =
          candidate.jacobian[i * parameters.size() + j] * PriorIn(parameters[j]) / candidate.sd[i];
    }
    if (row.allFinite()) sum += row * row.transpose();
  }
  return sum;
}

/// Computes the value of a candidate. Eigenvalues of J^T J are s^2. A direction counts as fixed if
/// s >= sqrt(3), which reduces a prior sd by the factor 1 / sqrt(1 + s^2) <= 1 / 2.
DesignWorth Worth(const std::string& name, const Matrix& information) {
  const Eigen::Index n = information.rows();
  DesignWorth worth;
  worth.name = name;
  const fit::Singular svd = fit::Decompose(information);  // symmetric matrix: singular values are
                                                          // its eigenvalues
  Matrix covariance = Matrix::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double square = svd.value[k];
    worth.fixed += square >= 3.0 * (1 - 1e-12) ? 1 : 0;
    worth.information += 0.5 * math::Log(1 + square);
    covariance += svd.V.col(k) * svd.V.col(k).transpose() / (1 + square);
  }
  for (Eigen::Index j = 0; j < n; ++j) worth.sd_ratio.push_back(std::sqrt(covariance(j, j)));
  return worth;
}

std::string Fixes(const DesignWorth& worth, std::size_t parameters) {
  return std::to_string(worth.fixed) + " of " + std::to_string(parameters) + " combinations";
}

}  // namespace

DesignRanking RankDesigns(const std::vector<FitParameter>& parameters, const DesignCandidate& base,
                          const std::vector<DesignCandidate>& candidates) {
  DesignRanking ranking;
  ranking.wrong = Wrong(parameters, base);
  for (const DesignCandidate& candidate : candidates) {
    const auto more = Wrong(parameters, candidate);
    ranking.wrong.insert(ranking.wrong.end(), more.begin(), more.end());
  }
  if (parameters.empty()) ranking.wrong.emplace_back("there is no parameter");
  if (!ranking.wrong.empty()) return ranking;

  Matrix have = Information(parameters, base);
  std::vector<Matrix> adds;
  ranking.now = Worth(base.name, have);
  for (const DesignCandidate& candidate : candidates) {
    adds.push_back(Information(parameters, candidate));
    ranking.alone.push_back(Worth(candidate.name, have + adds.back()));
  }
  std::vector<bool> taken(candidates.size(), false);
  for (std::size_t turn = 0; turn < candidates.size(); ++turn) {
    std::optional<std::size_t> best;
    DesignWorth worth;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      if (taken[c]) continue;
      DesignWorth here = Worth(candidates[c].name, have + adds[c]);
      if (best && !(here.information > worth.information)) continue;
      best = c;
      worth = std::move(here);
    }
    taken[*best] = true;
    have += adds[*best];
    ranking.order.push_back(*best);
    ranking.greedy.push_back(std::move(worth));
  }
  const std::size_t n = parameters.size();
  ranking.sentences.push_back("the present measurements determine " + Fixes(ranking.now, n));
  double before = ranking.now.information;
  for (const DesignWorth& worth : ranking.greedy) {
    ranking.sentences.push_back("with " + worth.name + ": " + Fixes(worth, n) + ", " +
                                fit::Brief(worth.information - before) + " nats more");
    before = worth.information;
  }
  return ranking;
}

}  // namespace taut
