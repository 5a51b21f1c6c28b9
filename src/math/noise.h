/// Smooth lattice noise for random terrain heights.
#pragma once

#include <cstdint>

namespace taut::math {

/// Returns noise between -1 and 1: a uniform random number at each lattice point (whole x and y),
/// and an interpolation with continuous curvature between them. The result has the same bits on
/// every machine.
double Noise(std::uint64_t seed, double x, double y) noexcept;

}  // namespace taut::math
