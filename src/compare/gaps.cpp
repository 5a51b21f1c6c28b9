#include "compare/gaps.h"

#include <algorithm>
#include <cmath>

namespace taut::compare {
namespace {

constexpr double kGapFactor = 5.0;
constexpr std::size_t kNeighbors = 8;  ///< Number of steps considered on each side.

std::vector<double> DistancesOf(const std::vector<double>& time_s, std::size_t begin,
                                std::size_t end) {
  std::vector<double> distances;
  for (std::size_t i = begin + 1; i < end; ++i) distances.push_back(time_s[i] - time_s[i - 1]);
  return distances;
}

/// Returns the upper median of steps begin to end - 1; 0 if there are none.
double MedianOf(const std::vector<double>& distances, std::size_t begin, std::size_t end) {
  if (begin >= end) return 0.0;
  std::vector<double> some(distances.begin() + static_cast<std::ptrdiff_t>(begin),
                           distances.begin() + static_cast<std::ptrdiff_t>(end));
  const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
  std::nth_element(some.begin(), middle, some.end());
  return *middle;
}

}  // namespace

double TimeTolerance(double time_s) { return 1e-9 * std::max(1.0, std::abs(time_s)); }

std::vector<bool> FindGaps(const std::vector<double>& time_s) {
  const std::vector<double> distances = DistancesOf(time_s, 0, time_s.size());
  std::vector<bool> gaps(distances.size(), false);
  if (distances.size() < 2) return gaps;
  const double least = *std::min_element(distances.begin(), distances.end());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] <= kGapFactor * least) continue;
    const std::size_t first = i < kNeighbors ? 0 : i - kNeighbors;
    const std::size_t end = std::min(distances.size(), i + 1 + kNeighbors);
    const double usual = std::max(MedianOf(distances, first, i), MedianOf(distances, i + 1, end));
    gaps[i] = distances[i] > kGapFactor * usual;
  }
  return gaps;
}

std::vector<std::pair<double, double>> GapSpans(const std::vector<double>& time_s,
                                                const std::vector<bool>& gaps) {
  std::vector<std::pair<double, double>> spans;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i]) spans.emplace_back(time_s[i], time_s[i + 1]);
  }
  return spans;
}

std::vector<double> TimeWeights(const std::vector<double>& time_s, const std::vector<bool>& gaps) {
  const double usual_s = UsualStep(time_s, 0, time_s.size());
  std::vector<double> weights(time_s.size(), 1.0);
  if (!(usual_s > 0)) return weights;
  double least = INFINITY, most = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const bool before = i > 0 && !gaps[i - 1];
    const bool after = i + 1 < time_s.size() && !gaps[i];
    const double before_s = before ? time_s[i] - time_s[i - 1] : 0.0;
    const double after_s = after ? time_s[i + 1] - time_s[i] : 0.0;
    weights[i] = before && after ? 0.5 * (before_s + after_s)
                 : before        ? before_s
                 : after         ? after_s
                                 : usual_s;
    least = std::min(least, weights[i]);
    most = std::max(most, weights[i]);
  }
  if (most - least <= 1e-6 * most) std::fill(weights.begin(), weights.end(), 1.0);
  return weights;
}

double WeightedMean(const std::vector<double>& values, const std::vector<double>& weights) {
  double sum = 0, time = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += weights[i] * values[i];
    time += weights[i];
  }
  return sum / time;
}

double UsualStep(const std::vector<double>& time_s, std::size_t begin, std::size_t end) {
  const std::vector<double> distances = DistancesOf(time_s, begin, end);
  return MedianOf(distances, 0, distances.size());
}

CoveredTime::CoveredTime(const std::vector<double>& time_s, const std::vector<double>& values) {
  std::vector<double> finite_s;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (std::isfinite(values[i])) finite_s.push_back(time_s[i]);
  }
  const std::vector<bool> gaps = FindGaps(finite_s);
  for (std::size_t i = 0; i < finite_s.size(); ++i) {
    if (i == 0 || gaps[i - 1]) spans_.emplace_back(finite_s[i], finite_s[i]);
    spans_.back().second = finite_s[i];
  }
}

bool CoveredTime::Covers(double time_s) const {
  const double tolerance = TimeTolerance(time_s);
  const auto after = std::upper_bound(
      spans_.begin(), spans_.end(), time_s + tolerance,
      [](double t, const std::pair<double, double>& span) { return t < span.first; });
  return after != spans_.begin() && time_s - tolerance <= (after - 1)->second;
}

}  // namespace taut::compare
