/// Derivatives by differences: which points they need, and what follows from the answers. Equations
/// (F.6) to (F.9) of docs/theory/identification.md.
#pragma once

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

Stencil MakeStencil(const FitProblem& problem, const std::vector<double>& values,
                    std::size_t parameter, bool both_sizes);

void AddPoints(const Stencil& stencil, const std::vector<double>& values,
               std::vector<std::vector<double>>& points);

/// The slope of the first size alone, of second order; of first order, or zero, where points
/// failed.
std::vector<double> Slope(const Stencil& stencil, double value, const std::vector<double>& residual,
                          std::span<const Residuals> answers);

/// Of both sizes, with their check.
FitColumn CheckedColumn(const Stencil& stencil, double value, double scale,
                        const std::vector<double>& residual, std::span<const Residuals> answers);

}  // namespace taut::fit
