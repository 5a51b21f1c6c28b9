/// One step of the Levenberg-Marquardt method within a box (eq. F.3 to F.5 of
/// docs/theory/identification.md).
#pragma once

#include <vector>

#include "fit/problem.h"

namespace taut::fit {

/// R d + q|^2 / 2, up to a constant: a reduced system with no more rows than columns.
struct Quadratic {
  Matrix R;
  Vector q;
  Vector gradient() const { return R.transpose() * q; }
  /// Returns the decrease of the quadratic by d.
  double Reduction(const Vector& d) const {
    return -gradient().dot(d) - 0.5 * (R * d).squaredNorm();
  }
};

/// Reduces a system by orthogonal transformation, which preserves the angles of columns up to
/// rounding (normal equations square the condition).
Quadratic Reduce(const System& system);

/// Bounds of a step in scales, and parameters that do not move.
struct StepBox {
  Vector low, high;
  std::vector<bool> held;
};

/// Returns argmin |R d + q|^2 + damping |D d|^2 with D = diag(weight) and d in the box. Parameters
/// whose free minimum is beyond a bound are set to it one after the other, the worst first.
Vector DampedStep(const Quadratic& quadratic, const Vector& weight, double damping,
                  const StepBox& box);

}  // namespace taut::fit
