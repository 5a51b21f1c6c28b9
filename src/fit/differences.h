/// Derivatives by differences: which points they need, and what follows from the answers. Equations
/// (F.6) to (F.9) of docs/theory/identification.md.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/problem.h"

namespace taut::fit {

/// Points about a value of one parameter, all within its bounds: +h, -h and, of both sizes, +h/2,
/// -h/2; next to a bound h, h/2 and, of both sizes, h/4 on the side that has room.
struct Stencil {
  std::size_t parameter = 0;
  bool central = true;
  std::vector<double> at;  ///< Values of the parameter.
};

/// `share`: of the problem's step.
Stencil MakeStencil(const FitProblem& problem, const std::vector<double>& values,
                    std::size_t parameter, bool both_sizes, double share = 1.0);

void AddPoints(const Stencil& stencil, const std::vector<double>& values,
               std::vector<std::vector<double>>& points);

/// The slope of the first size alone, of second order; of first order, or zero, where points
/// failed.
std::vector<double> Slope(const Stencil& stencil, double value, const std::vector<double>& residual,
                          std::span<const Residuals> answers);

/// Of both sizes, with their check.
FitColumn CheckedColumn(const Stencil& stencil, double value, double scale,
                        const std::vector<double>& residual, std::span<const Residuals> answers);

/// A column to be found: the derivative by a parameter about a point.
struct ColumnTask {
  std::size_t owner = 0;  ///< For who computes: of which search.
  std::size_t parameter = 0;
  const std::vector<double>* values = nullptr;
  const std::vector<double>* residual = nullptr;
  bool check = true;  ///< Else only the slope of `share` of the problem's step is found.
  double share = 1.0;
};

/// Computes points, of which `owners` are the tasks'. False: stopped.
using ComputePoints =
    std::function<bool(const std::vector<std::vector<double>>& points,
                       const std::vector<std::size_t>& owners, std::vector<Residuals>& answers)>;

/// Finds columns, all tasks' in one call, with their check. Those whose sizes disagree are looked
/// at again with a quarter of the step, up to five times; a shorter step is kept if its sizes agree
/// and it is no shorter than the standard error that its slope leaves: otherwise the kink is where
/// the errors are, and counts. Nothing: stopped.
std::optional<std::vector<FitColumn>> FindColumns(const FitProblem& problem,
                                                  std::span<const ColumnTask> tasks,
                                                  const ComputePoints& compute);

}  // namespace taut::fit
