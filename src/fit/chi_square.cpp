// Chi-square distribution: tail probability and quantile.
#include <algorithm>
#include <cmath>

#include "math/elementary.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

/// log Gamma(x) for x > 0. Uses Stirling's series (Abramowitz and Stegun 6.1.41) for arguments >=
/// 16, where its first omitted term is below 1e-16. Smaller x are increased by Gamma(x + 1) = x
/// Gamma(x).
double LogGamma(double x) {
  double product = 1;
  for (; x < 16; x += 1) product *= x;
  const double y = 1 / (x * x);
  const double series =
      (1.0 / 12 + y * (-1.0 / 360 + y * (1.0 / 1260 + y * (-1.0 / 1680 + y * (1.0 / 1188))))) / x;
  const double half_log_two_pi = 0.91893853320467274178;
  return (x - 0.5) * math::Log(x) - x + half_log_two_pi + series - math::Log(product);
}

/// Regularized incomplete gamma function Q(a, x) = Gamma(a, x) / Gamma(a): for x < a + 1 by the
/// series of 1 - Q (6.5.29), otherwise by the continued fraction (6.5.31) with Lentz's method.
double UpperGamma(double a, double x) {
  if (x <= 0) return 1;
  const double front = math::Exp(a * math::Log(x) - x - LogGamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; std::fabs(term) > 1e-17 * sum; n += 1) sum += term *= x / n;
    return std::clamp(1 - front * sum, 0.0, 1.0);
  }
  const double tiny = 1e-300;
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, product = d;
  for (int i = 1; i < 1'000'000; ++i) {
    const double numerator = -i * (i - a);
    b += 2;
    d = numerator * d + b;
    if (std::fabs(d) < tiny) d = tiny;
    c = b + numerator / c;
    if (std::fabs(c) < tiny) c = tiny;
    d = 1 / d;
    product *= d * c;
    if (std::fabs(d * c - 1) < 1e-16) break;
  }
  return std::clamp(front * product, 0.0, 1.0);
}

}  // namespace

double ChiSquareTail(double chi2, double freedom) { return UpperGamma(0.5 * freedom, 0.5 * chi2); }

double ChiSquareQuantile(double tail, double freedom) {
  double low = 0, high = freedom + 1;
  while (ChiSquareTail(high, freedom) > tail) high *= 2;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (ChiSquareTail(middle, freedom) > tail ? low : high) = middle;
  }
  return high;
}

}  // namespace taut
