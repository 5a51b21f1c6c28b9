#include "math/noise.h"

#include <cmath>

#include "math/random.h"

namespace taut::math {
namespace {

constexpr std::uint32_t kStream = 0x6e6f6973;  // differs from all other random streams

double AtCorner(std::uint64_t seed, std::int64_t x, std::int64_t y) noexcept {
  const auto place = static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 |
                     static_cast<std::uint32_t>(y);
  return Random(seed, kStream, place).Uniform(-1.0, 1.0);
}

/// Returns a smooth step from 0 to 1 with zero slope and curvature at both ends.
double Ease(double t) noexcept { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }

}  // namespace

double Noise(std::uint64_t seed, double x, double y) noexcept {
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto i = static_cast<std::int64_t>(x0), j = static_cast<std::int64_t>(y0);
  const double u = Ease(x - x0), v = Ease(y - y0);
  const double a = AtCorner(seed, i, j), b = AtCorner(seed, i + 1, j);
  const double c = AtCorner(seed, i, j + 1), d = AtCorner(seed, i + 1, j + 1);
  const double low = a + u * (b - a), high = c + u * (d - c);
  return low + v * (high - low);
}

}  // namespace taut::math
