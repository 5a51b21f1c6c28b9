/// Finite differences: stencils of points, and checked slopes from computed residuals (eq. F.6 to
/// F.9 of docs/theory/identification.md).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/problem.h"

namespace taut::fit {

/// Points of one parameter around its value, within its bounds: +h, -h and, for both step sizes,
/// +h/2, -h/2. Near a bound, all points are on one side: h, h/2 and, for both sizes, h/4.
struct Stencil {
  std::size_t parameter = 0;
  bool central = true;
  std::vector<double> at;  ///< Values of the parameter at the points.
};

/// `share`: factor of the problem's step length.
Stencil MakeStencil(const FitProblem& problem, const std::vector<double>& values,
                    std::size_t parameter, bool both_sizes, double share = 1.0);

void AddPoints(const Stencil& stencil, const std::vector<double>& values,
               std::vector<std::vector<double>>& points);

/// Returns the slope for the full step size only, of second order. If points failed, the slope has
/// first order or is zero.
std::vector<double> Slope(const Stencil& stencil, double value, const std::vector<double>& residual,
                          std::span<const Residuals> answers);

/// Computes the slope from both step sizes and checks it for kinks.
FitColumn CheckedColumn(const Stencil& stencil, double value, double scale,
                        const std::vector<double>& residual, std::span<const Residuals> answers);

/// Task to compute one column: derivative with respect to one parameter at one point.
struct ColumnTask {
  std::size_t owner = 0;  ///< Index of the search, for `ComputePoints`.
  std::size_t parameter = 0;
  const std::vector<double>* values = nullptr;
  const std::vector<double>* residual = nullptr;
  bool check = true;  ///< False: computes the slope for one step size only, the problem's step
                      ///< times `share`.
  double share = 1.0;
};

/// Computes points. `owners`: per point, `ColumnTask::owner`. Returns false if stopped.
using ComputePoints =
    std::function<bool(const std::vector<std::vector<double>>& points,
                       const std::vector<std::size_t>& owners, std::vector<Residuals>& answers)>;

/// Computes and checks the columns of all tasks, with few calls of `compute`. If the slopes for the
/// step and for half of the step disagree, the column is repeated with a quarter of the step, up to
/// five times. A shorter step is kept if its two slopes agree and if the step is at least the
/// standard error implied by the slope. Otherwise the column is reported as a kink. Returns nothing
/// if stopped.
std::optional<std::vector<FitColumn>> FindColumns(const FitProblem& problem,
                                                  std::span<const ColumnTask> tasks,
                                                  const ComputePoints& compute);

}  // namespace taut::fit
