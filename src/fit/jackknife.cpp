// Standard errors by the delete-one-group jackknife (docs/theory/identification.md, eq. F.14).
#include <cmath>

#include "fit/linear_solve.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

using fit::Matrix;
using fit::Vector;

/// Minimum number of groups.
constexpr std::size_t kLeastGroups = 3;
/// If less than this share of a squared column remains without a group, only this group determines
/// the parameter.
constexpr double kOwn = 0.01;

std::vector<bool> Without(int group) {
  std::vector<bool> left_out(static_cast<std::size_t>(group) + 1, false);
  left_out.back() = true;
  return left_out;
}

/// Returns, per parameter, whether the data without a group determine it.
std::vector<bool> Seen(const fit::System& whole, const fit::System& part,
                       const std::vector<Eigen::Index>& free) {
  std::vector<bool> seen(static_cast<std::size_t>(whole.jacobian.cols()), false);
  const fit::Spread spread = fit::SpreadOf(fit::Columns(part.jacobian, free));
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double before = whole.jacobian.col(free[k]).head(whole.data_rows).squaredNorm();
    const double after = part.jacobian.col(free[k]).head(part.data_rows).squaredNorm();
    seen[static_cast<std::size_t>(free[k])] = !spread.endless[k] && after > kOwn * before;
  }
  return seen;
}

/// Returns `values` after one Gauss-Newton step of the free parameters.
std::vector<double> OneStep(const FitProblem& problem, const fit::System& part,
                            const std::vector<double>& values,
                            const std::vector<Eigen::Index>& free) {
  const Vector d = fit::LeastSquares(fit::Columns(part.jacobian, free), part.residual);
  std::vector<double> moved = values;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto j = static_cast<std::size_t>(free[k]);
    moved[j] += d[static_cast<Eigen::Index>(k)] * FitScale(problem.parameters[j]);
  }
  return moved;
}

/// Returns (G - 1) / G sum (x_g - mean)^2 (eq. F.14).
double Variance(const std::vector<GroupEffect>& groups, std::size_t parameter) {
  const double count = static_cast<double>(groups.size());
  double mean = 0, sum = 0;
  for (const GroupEffect& group : groups) mean += group.values[parameter] / count;
  for (const GroupEffect& group : groups) {
    sum += (group.values[parameter] - mean) * (group.values[parameter] - mean);
  }
  return (count - 1) / count * sum;
}

}  // namespace

JackknifeResult JackknifeGroups(const FitProblem& problem, const std::vector<double>& values,
                                const FitDerivatives& derivatives, Jackknife how,
                                const FitOptions& options) {
  JackknifeResult result;
  result.refit = how == Jackknife::kRefit;
  result.se.resize(values.size());
  const std::vector<int> groups = fit::Groups(problem);
  if (how == Jackknife::kOff) {
    result.why = "it was not requested";
  } else if (groups.size() < kLeastGroups) {
    result.why = "there are fewer than three groups to leave out";
  }
  if (!result.why.empty()) return result;

  const fit::System whole = fit::SystemOf(problem, {}, values, derivatives);
  const auto free = fit::FreeOf(problem, values, whole);
  std::vector<bool> seen(values.size(), true);
  std::vector<FitJob> jobs;
  for (const int group : groups) {
    const fit::System part = fit::SystemOf(problem, Without(group), values, derivatives);
    const std::vector<bool> here = Seen(whole, part, free);
    for (std::size_t j = 0; j < values.size(); ++j) seen[j] = seen[j] && here[j];
    jobs.push_back({values, {}, Without(group)});
    if (!result.refit) result.groups.push_back({group, OneStep(problem, part, values, free)});
  }
  if (result.refit) {
    const FitState state = RunFitJobs(problem, jobs, options);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (state.tracks.empty() || state.tracks[g].end == FitEnd::kInterrupted) {
        result.why = "stopped";
      } else if (state.tracks[g].end == FitEnd::kFailed) {
        result.why = state.tracks[g].why;
      }
      if (!result.why.empty()) return result;
      result.groups.push_back({groups[g], state.tracks[g].values});
    }
  }
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (seen[j]) result.se[j] = std::sqrt(Variance(result.groups, j));
  }
  return result;
}

}  // namespace taut
