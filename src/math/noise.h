/// Smooth lattice noise for random heights.
#pragma once

#include <cstdint>

namespace taut::math {

/// Returns noise between -1 and 1: at whole x and y a uniform random number of that lattice point,
/// and between them a smooth interpolation with continuous curvature. The same bits on every
/// machine.
double Noise(std::uint64_t seed, double x, double y) noexcept;

}  // namespace taut::math
