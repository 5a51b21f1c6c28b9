// Random starts of parameter fits, drawn from priors and bounds.
#include <algorithm>
#include <cmath>

#include "fit/problem.h"
#include "math/random.h"

namespace taut {
namespace {

constexpr std::uint32_t kStream = 0x0066'6974;  // "fit": random number stream of starts

/// Draws from a normal distribution truncated to the bounds, by rejection sampling.
double DrawNormal(const FitParameter& p, math::Random& random) {
  double value = fit::PriorMean(p);
  for (int attempt = 0; attempt < 64; ++attempt) {
    value = fit::PriorMean(p) + p.prior_sd * random.Normal();
    if (value >= p.low && value <= p.high) return value;
  }
  return std::clamp(value, p.low, p.high);  // the prior is far outside of its bounds
}

}  // namespace

std::vector<double> DrawFitStart(const FitProblem& problem, std::uint64_t seed,
                                 std::uint64_t number) {
  std::vector<double> values;
  math::Random random(seed, kStream, number);
  for (const FitParameter& p : problem.parameters) {
    if (number == 0) {
      values.push_back(p.start);
    } else if (fit::HasPrior(p)) {
      values.push_back(DrawNormal(p, random));
    } else {
      const double reach = 4.0 * FitScale(p);
      const bool bounded = std::isfinite(p.low) && std::isfinite(p.high);
      values.push_back(random.Uniform(bounded ? p.low : std::max(p.low, p.start - reach),
                                      bounded ? p.high : std::min(p.high, p.start + reach)));
    }
  }
  return values;
}

}  // namespace taut
