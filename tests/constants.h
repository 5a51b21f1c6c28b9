/// Constants shared by many tests
#pragma once

#include <limits>
#include <numbers>

namespace taut {

inline constexpr double kG = 9.81;  // gravity of the scenes [m/s^2]
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace taut
