/// One step of the Levenberg-Marquardt method within bounds (eq. F.3 to F.5 of
/// docs/theory/identification.md).
#pragma once

#include <vector>

#include "fit/problem.h"

namespace taut::fit {

/// Quadratic |R d + q|^2 / 2, up to a constant. R has no more rows than columns.
struct Quadratic {
  Matrix R;
  Vector q;
  Vector gradient() const { return R.transpose() * q; }
  /// Returns the decrease of the quadratic by d.
  double Reduction(const Vector& d) const {
    return -gradient().dot(d) - 0.5 * (R * d).squaredNorm();
  }
};

/// Reduces a system by an orthogonal transformation (QR). Unlike normal equations, it does not
/// square the condition number.
Quadratic Reduce(const System& system);

/// Bounds of a step in scales, and parameters to keep fixed.
struct StepBox {
  Vector low, high;
  std::vector<bool> held;
};

/// Minimizes |R d + q|^2 + damping |D d|^2 with D = diag(weight) within the bounds. Parameters
/// whose unconstrained minimum is beyond a bound are set to this bound, one at a time, the worst
/// first.
Vector DampedStep(const Quadratic& quadratic, const Vector& weight, double damping,
                  const StepBox& box);

}  // namespace taut::fit
