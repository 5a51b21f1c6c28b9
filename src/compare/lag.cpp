#include "compare/lag.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace taut::compare {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Sums over pairs of rows of products of deviations from the means.
struct Moments {
  double count = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  double size_a = 0.0, size_b = 0.0;  ///< Largest absolute values of a and b.

  /// Returns Pearson's correlation. Returns NaN if a signal is constant up to rounding.
  double Correlation() const {
    constexpr double kRoundOff = 1e-12;
    const double least_a = kRoundOff * size_a, least_b = kRoundOff * size_b;
    if (!(aa > count * least_a * least_a) || !(bb > count * least_b * least_b)) return kNan;
    return ab / std::sqrt(aa * bb);
  }
};

/// Returns the moments of `count` pairs of rows. Skips pairs with values that are not finite.
Moments FiniteMoments(const double* a, const double* b, std::size_t count) {
  Moments m;
  double mean_a = 0.0, mean_b = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    m.count += 1.0;
    mean_a += a[i];
    mean_b += b[i];
    m.size_a = std::max(m.size_a, std::abs(a[i]));
    m.size_b = std::max(m.size_b, std::abs(b[i]));
  }
  mean_a /= m.count;
  mean_b /= m.count;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    const double x = a[i] - mean_a, y = b[i] - mean_b;
    m.aa += x * x;
    m.bb += y * y;
    m.ab += x * y;
  }
  return m;
}

/// Returns the RMS of the difference of `count` rows without its mean. Skips pairs with values that
/// are not finite.
double RmsOfDifference(const double* a, const double* b, std::size_t count) {
  double rows = 0.0, sum = 0.0, squares = 0.0;
  const auto each = [&](const auto& use) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(a[i]) && std::isfinite(b[i])) use(a[i] - b[i]);
    }
  };
  each([&](double d) { rows += 1.0, sum += d; });
  const double mean = sum / rows;
  each([&](double d) { squares += (d - mean) * (d - mean); });
  return std::sqrt(squares / rows);
}

/// Computes correlations of a fixed range of a with shifted b. If all rows are finite, the part of
/// a is computed once, and four accumulators sum, so that compilers vectorize the loop.
class Correlator {
 public:
  Correlator(const std::vector<double>& a, const std::vector<double>& b, std::size_t begin,
             std::size_t count)
      : a_(a.data() + begin), b_(b.data() + begin), count_(count) {
    const auto finite = [](double value) { return std::isfinite(value); };
    all_finite_ = std::all_of(a_, a_ + count, finite) && std::all_of(b.begin(), b.end(), finite);
    if (!all_finite_) return;
    const Moments alone = FiniteMoments(a_, a_, count);
    known_ = alone;
    double mean = 0.0;
    for (std::size_t i = 0; i < count; ++i) mean += a_[i] / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) centred_a_.push_back(a_[i] - mean);
    for (const double value : b) known_.size_b = std::max(known_.size_b, std::abs(value));
  }

  double At(std::ptrdiff_t lag) const {
    if (!all_finite_) return FiniteMoments(a_, b_ + lag, count_).Correlation();
    const double* b = b_ + lag;
    double sum[4] = {}, bb[4] = {}, ab[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= count_; i += 4) {
      for (std::size_t j = 0; j < 4; ++j) sum[j] += b[i + j];
    }
    for (; i < count_; ++i) sum[0] += b[i];
    const double mean = (sum[0] + sum[1] + sum[2] + sum[3]) / static_cast<double>(count_);
    for (i = 0; i + 4 <= count_; i += 4) {
      for (std::size_t j = 0; j < 4; ++j) {
        const double y = b[i + j] - mean;
        bb[j] += y * y;
        ab[j] += centred_a_[i + j] * y;
      }
    }
    for (; i < count_; ++i) {
      bb[0] += (b[i] - mean) * (b[i] - mean);
      ab[0] += centred_a_[i] * (b[i] - mean);
    }
    Moments m = known_;
    m.bb = bb[0] + bb[1] + bb[2] + bb[3];
    m.ab = ab[0] + ab[1] + ab[2] + ab[3];
    return m.Correlation();
  }

 private:
  const double* a_;
  const double* b_;
  std::size_t count_;
  bool all_finite_ = false;
  Moments known_;
  std::vector<double> centred_a_;
};

}  // namespace

Lag FindLag(const std::vector<double>& a, const std::vector<double>& b, int max_rows) {
  const std::size_t rows = std::min(a.size(), b.size());
  const auto margin =
      std::min(static_cast<std::ptrdiff_t>(max_rows), static_cast<std::ptrdiff_t>(rows / 4));
  const std::size_t begin = static_cast<std::size_t>(margin);
  const Correlator correlator(a, b, begin, rows - 2 * begin);
  std::vector<double> at;  // correlations at lags -margin to margin
  for (std::ptrdiff_t lag = -margin; lag <= margin; ++lag) at.push_back(correlator.At(lag));

  std::ptrdiff_t best = -1;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (std::isfinite(at[i]) && (best < 0 || at[i] > at[static_cast<std::size_t>(best)])) {
      best = static_cast<std::ptrdiff_t>(i);
    }
  }
  if (best < 0) return {kNan, false, kNan, kNan};
  const double* const from = a.data() + begin;
  const double* const to = b.data() + begin;
  const std::size_t count = rows - 2 * begin;
  const double without = RmsOfDifference(from, to, count);
  Lag result{static_cast<double>(best - margin), best == 0 || best == 2 * margin,
             at[static_cast<std::size_t>(best)],
             RmsOfDifference(from, to + (best - margin), count) / without};
  if (!result.at_limit) {
    const double before = at[static_cast<std::size_t>(best) - 1];
    const double after = at[static_cast<std::size_t>(best) + 1];
    const double bend = before - 2.0 * result.correlation + after;
    if (bend < 0.0) {  // also false for NaN
      const double part = 0.5 * (before - after) / bend;
      result.rows += part;
      result.correlation -= 0.25 * (before - after) * part;
    }
  }
  result.correlation = std::clamp(result.correlation, -1.0, 1.0);  // rounding and the parabola may
                                                                   // exceed 1
  return result;
}

}  // namespace taut::compare
