// Score tests of effects that a fit does not estimate (docs/theory/identification.md, eq. F.15b).
#include <algorithm>
#include <cmath>

#include "fit/format.h"
#include "fit/linear_solve.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

using fit::Vector;

/// If the parameters leave less than this share of an effect's squared slope uncompensated, the
/// effect is confounded with them.
constexpr double kSeparate = 1e-6;
/// Changes of parameters below this multiple of their standard errors are not named.
constexpr double kNamedChange = 1;

/// Returns the slope of the effect in the rows of `system`, weighted as its data.
Vector Weighted(const FitProblem& problem, const FitDerivatives& derivatives, const FitAlias& alias,
                Eigen::Index rows) {
  Vector out = Vector::Zero(rows);
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const double weight = fit::LossWeight(problem.rows[i], derivatives.residual[i]);
    out[static_cast<Eigen::Index>(i)] = std::sqrt(weight) * alias.slope[i];
  }
  return out;
}

std::string Sentence(const FitProblem& problem, const AliasTest& test,
                     const std::vector<double>& error) {
  if (test.confounded) {
    return test.name + " is not estimated, and other parameters would compensate for it";
  }
  std::string text = test.name + " is not estimated: with " + fit::Brief(test.value, test.unit) +
                     " +- " + fit::Brief(test.se, test.unit) + ", chi-square would be smaller by " +
                     fit::Brief(test.fall) + " (p = " + fit::Brief(test.p) + ")";
  std::vector<std::string> changes;
  for (std::size_t j = 0; j < test.change.size(); ++j) {
    if (!(std::fabs(test.change[j]) > kNamedChange * error[j])) continue;
    const FitParameter& p = problem.parameters[j];
    changes.push_back(p.name + " would change by " + fit::Change(test.change[j], p.unit) + ", " +
                      fit::Brief(std::fabs(test.change[j]) / error[j]) + " of its standard errors");
  }
  return changes.empty() ? text : text + ", and " + fit::List(changes);
}

}  // namespace

std::vector<AliasTest> TestAliases(const FitProblem& problem, const std::vector<double>& values,
                                   const FitDerivatives& derivatives,
                                   std::span<const FitAlias> aliases) {
  std::vector<AliasTest> out;
  const fit::System system = fit::SystemOf(problem, {}, values, derivatives);
  const std::vector<Eigen::Index> free = fit::FreeOf(problem, values, system);
  const fit::Matrix jacobian = fit::Columns(system.jacobian, free);
  const fit::Spread spread = fit::SpreadOf(jacobian);
  const fit::Matrix inverse = spread.covariance * jacobian.transpose();
  const double chi2 = system.residual.squaredNorm();
  const double freedom =
      static_cast<double>(system.residual.size()) - static_cast<double>(free.size()) - 1;
  for (const FitAlias& alias : aliases) {
    AliasTest& test = out.emplace_back();
    test.name = alias.name, test.unit = alias.unit, test.value = alias.neutral;
    test.change.assign(values.size(), 0.0);
    test.se_ratio.assign(values.size(), 1.0);
    const Vector slope = Weighted(problem, derivatives, alias, system.residual.size());
    const Vector answer = -(inverse * slope);  // changes of the parameters per unit of the effect
    const Vector rest = slope + jacobian * answer;
    const double information = rest.squaredNorm();
    std::vector<double> error(values.size(), fit::kInfinite);
    if (!(information > kSeparate * slope.squaredNorm())) {
      test.confounded = true;
      test.se = fit::kInfinite;
      test.sentence = Sentence(problem, test, error);
      continue;
    }
    const double score = rest.dot(system.residual), change = -score / information;
    test.fall = score * score / information;
    // Scale by the reduced chi-square: sds that are all too small would make every effect
    // significant.
    const double left = std::max(chi2 - test.fall, 0.0);
    const double factor = freedom >= 1 ? std::max(1.0, left / freedom) : 1.0;
    test.value = alias.neutral + change;
    test.se = std::sqrt(factor / information);
    test.p = ChiSquareTail(test.fall / factor, 1);
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const auto j = static_cast<std::size_t>(free[k]);
      const double scale = FitScale(problem.parameters[j]), variance = spread.covariance(i, i);
      test.change[j] = change * answer[i] * scale;
      if (!(variance > 0) || spread.endless[k]) continue;
      error[j] = scale * std::sqrt(variance);
      test.se_ratio[j] = std::sqrt(1 + answer[i] * answer[i] / information / variance);
    }
    test.sentence = Sentence(problem, test, error);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const AliasTest& a, const AliasTest& b) { return a.fall > b.fall; });
  return out;
}

}  // namespace taut
