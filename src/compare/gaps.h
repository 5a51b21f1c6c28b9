/// Gaps in recordings, and statistics over time instead of rows.
///
/// A distance of two rows is a gap if it is more than five times as long as the distances around it
/// usually are: the larger of two medians, of up to eight distances before it and after it. A
/// logger that changes from 100 Hz to 10 Hz has none, one that drops out for seconds has.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace taut::compare {

/// Times that differ by no more are the same: those of a CSV file lose digits [s].
double TimeTolerance(double time_s);

/// Whether nothing was recorded between rows i and i + 1; one entry fewer than rows. `time_s`
/// rises.
std::vector<bool> FindGaps(const std::vector<double>& time_s);

/// The gaps as spans of time [s].
std::vector<std::pair<double, double>> GapSpans(const std::vector<double>& time_s,
                                                const std::vector<bool>& gaps);

/// Time for which each row stands: half of the distances to both neighbors. On a side without one
/// (an end, a gap) as long as on the other; a row without neighbors stands for the usual step. All
/// 1 if rows are evenly spaced, so that sums are those of plain means to the bit.
/// `gaps`: those of `FindGaps`.
std::vector<double> TimeWeights(const std::vector<double>& time_s, const std::vector<bool>& gaps);

/// Mean of values with such weights; NaN without values.
double WeightedMean(const std::vector<double>& values, const std::vector<double>& weights);

/// Median distance of rows; 0 of fewer than two.
double UsualStep(const std::vector<double>& time_s, std::size_t begin, std::size_t end);

/// Spans of time without gaps, ends included, of the rows at which `values` is finite.
class CoveredTime {
 public:
  CoveredTime(const std::vector<double>& time_s, const std::vector<double>& values);
  bool Covers(double time_s) const;

 private:
  std::vector<std::pair<double, double>> spans_;
};

}  // namespace taut::compare
