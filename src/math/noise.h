/// Smooth random heights.
#pragma once

#include <cstdint>

namespace taut::math {

/// Between -1 and 1: at whole x and y a random number of that place, evenly spread, and between
/// them a smooth course with continuous curvature. The same bits on every machine.
double Noise(std::uint64_t seed, double x, double y) noexcept;

}  // namespace taut::math
