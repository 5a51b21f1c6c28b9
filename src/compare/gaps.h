/// Gaps in recordings, and statistics weighted by time.
///
/// A distance of two rows is a gap if it is more than five times the usual distance around it: the
/// larger of two medians, of up to eight distances before it and after it. A logger that changes
/// from 100 Hz to 10 Hz has no gap, a logger that drops out for seconds has one.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace taut::compare {

/// Returns the largest difference of equal times [s], because CSV files may round times.
double TimeTolerance(double time_s);

/// Returns true at i if rows i and i + 1 have a gap between them; one entry fewer than rows.
/// `time_s` rises.
std::vector<bool> FindGaps(const std::vector<double>& time_s);

/// Returns the gaps as spans of time [s].
std::vector<std::pair<double, double>> GapSpans(const std::vector<double>& time_s,
                                                const std::vector<bool>& gaps);

/// Returns the time that each row represents: half of the distances to both neighbors. On a side
/// without a neighbor (an end, a gap) it is as long as on the other; a row without neighbors
/// represents the usual step. All are 1 if rows are evenly spaced, so that sums equal plain means
/// to the bit. `gaps`: from `FindGaps`.
std::vector<double> TimeWeights(const std::vector<double>& time_s, const std::vector<bool>& gaps);

/// Returns the mean of values with such weights; NaN without values.
double WeightedMean(const std::vector<double>& values, const std::vector<double>& weights);

/// Returns the median distance of rows; 0 for fewer than two.
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
