/// What all optimisers share: points of the unit cube from random numbers.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/random.h"
#include "taut/optimizer.h"

namespace taut::learn {

/// Random numbers of draw number `index` of an optimiser.
inline math::Random DrawOf(const OptimizerStart& start, std::uint64_t index) {
  return {start.seed, 0x100u + start.stream, index};
}

inline UnitPoint UniformPoint(std::size_t dimensions, math::Random random) {
  UnitPoint point(dimensions);
  for (double& x : point) x = random.Uniform();
  return point;
}

/// Mirrors a number at 0 and 1 until it lies between them: a step across a bound comes back as far
/// as it went, so that the bounds do not collect points as they would if it stopped there.
inline double Reflect(double x) {
  const double period = x - 2.0 * std::floor(0.5 * x);  // in [0, 2)
  return period <= 1.0 ? period : 2.0 - period;
}

/// Better, with NaN the worst; equal scores are not better.
inline bool Better(double a, double b) { return !std::isnan(a) && (std::isnan(b) || a > b); }

}  // namespace taut::learn
