/// Runge-Kutta integrator of Dormand and Prince, order 5 with an error estimate of order 4, for
/// smooth reference motions. Used by tests only; shares no code with the step.
///
/// Source: Dormand, Prince, "A family of embedded Runge-Kutta formulae", J. Comp. Appl. Math. 6
/// (1980), table 2.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace taut::mechanics {

/// Integrates y' = f(t, y) from `t` to `end` and returns y there. Steps are chosen so that the
/// estimated error of each stays below `tolerance` times max(1, |y_i|), the largest over all i.
/// Throws std::runtime_error if the step becomes shorter than 1e-14 of the interval.
template <size_t N, class F>
std::array<double, N> Integrate(const F& f, double t, std::array<double, N> y, double end,
                                double tolerance = 1e-12) {
  using Y = std::array<double, N>;
  static constexpr double kA[7][6] = {
      {},
      {1.0 / 5},
      {3.0 / 40, 9.0 / 40},
      {44.0 / 45, -56.0 / 15, 32.0 / 9},
      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
      {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr double kC[7] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
  static constexpr double kError[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                       -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
  const double span = end - t;
  double h = span / 1000;
  while (t < end) {
    h = std::min(h, end - t);
    Y k[7], stage{};
    for (int i = 0; i < 7; ++i) {
      stage = y;
      for (int j = 0; j < i; ++j) {
        for (size_t n = 0; n < N; ++n) stage[n] += h * kA[i][j] * k[j][n];
      }
      k[i] = f(t + kC[i] * h, stage);
    }
    double error = 0;
    for (size_t n = 0; n < N; ++n) {
      double e = 0;
      for (int i = 0; i < 7; ++i) e += kError[i] * k[i][n];
      error = std::max(error, std::abs(h * e) / std::max(1.0, std::abs(y[n])));
    }
    if (error <= tolerance) t += h, y = stage;  // the last stage is the result of order 5
    h *= std::clamp(0.9 * std::pow(tolerance / std::max(error, 1e-300), 0.2), 0.2, 5.0);
    if (!(h > 1e-14 * span)) throw std::runtime_error("Integrate: the step became too short");
  }
  return y;
}

}  // namespace taut::mechanics
