/// Derivatives by differences: stencils of points, and slopes with a check from the computed
/// residuals (eq. F.6 to F.9 of docs/theory/identification.md).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/problem.h"

namespace taut::fit {

/// Points around a value of one parameter, all within its bounds: +h, -h and, with both sizes,
/// +h/2, -h/2. Next to a bound: h, h/2 and, with both sizes, h/4 on the other side.
struct Stencil {
  std::size_t parameter = 0;
  bool central = true;
  std::vector<double> at;  ///< Values of the parameter.
};

/// `share`: step length as a share of the problem's step.
Stencil MakeStencil(const FitProblem& problem, const std::vector<double>& values,
                    std::size_t parameter, bool both_sizes, double share = 1.0);

void AddPoints(const Stencil& stencil, const std::vector<double>& values,
               std::vector<std::vector<double>>& points);

/// Returns the slope of the first size alone, of second order; of first order, or zero, where
/// points failed.
std::vector<double> Slope(const Stencil& stencil, double value, const std::vector<double>& residual,
                          std::span<const Residuals> answers);

/// Returns the slope from both sizes, with its check.
FitColumn CheckedColumn(const Stencil& stencil, double value, double scale,
                        const std::vector<double>& residual, std::span<const Residuals> answers);

/// Task of one column: derivative with respect to a parameter at a point.
struct ColumnTask {
  std::size_t owner = 0;  ///< Index of the search, for `ComputePoints`.
  std::size_t parameter = 0;
  const std::vector<double>* values = nullptr;
  const std::vector<double>* residual = nullptr;
  bool check = true;  ///< Otherwise only the slope with `share` of the problem's step is computed.
  double share = 1.0;
};

/// Computes points; `owners` are the tasks' owners. Returns false if it was stopped.
using ComputePoints =
    std::function<bool(const std::vector<std::vector<double>>& points,
                       const std::vector<std::size_t>& owners, std::vector<Residuals>& answers)>;

/// Computes the columns of all tasks in one call, with their check. Columns whose sizes disagree
/// are repeated with a quarter of the step, up to five times. A shorter step is kept if its sizes
/// agree and it is at least as long as the standard error that its slope implies; otherwise the
/// kink lies within the error and is reported. Returns nothing if it was stopped.
std::optional<std::vector<FitColumn>> FindColumns(const FitProblem& problem,
                                                  std::span<const ColumnTask> tasks,
                                                  const ComputePoints& compute);

}  // namespace taut::fit
