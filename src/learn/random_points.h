/// Random points in the unit cube, used by all optimizers.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/random.h"
#include "taut/optimizer.h"

namespace taut::learn {

/// Returns the random numbers for draw `index` of an optimizer.
inline math::Random DrawOf(const OptimizerStart& start, std::uint64_t index) {
  return {start.seed, 0x100u + start.stream, index};
}

inline UnitPoint UniformPoint(std::size_t dimensions, math::Random random) {
  UnitPoint point(dimensions);
  for (double& x : point) x = random.Uniform();
  return point;
}

/// Mirrors a number at 0 and 1 until it is between them. Clamping would accumulate points at the
/// bounds.
inline double Reflect(double x) {
  const double period = x - 2.0 * std::floor(0.5 * x);  // in [0, 2)
  return period <= 1.0 ? period : 2.0 - period;
}

/// Returns whether score a is better than b. NaN is the worst score; equal scores are not better.
inline bool Better(double a, double b) { return !std::isnan(a) && (std::isnan(b) || a > b); }

}  // namespace taut::learn
