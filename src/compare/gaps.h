/// Gaps in recordings, and statistics weighted by time.
///
/// The step between two rows is a gap if it exceeds five times the usual step nearby. The usual
/// step is the larger of two medians, of up to eight steps before and after it. So a change from
/// 100 Hz to 10 Hz is no gap, but a dropout of seconds is one.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace taut::compare {

/// Returns the tolerance for equal times [s], since CSV files may round times.
double TimeTolerance(double time_s);

/// Returns, for each i, whether there is a gap between rows i and i + 1 (one entry fewer than
/// rows). `time_s` must increase.
std::vector<bool> FindGaps(const std::vector<double>& time_s);

/// Returns the time spans of the gaps [s].
std::vector<std::pair<double, double>> GapSpans(const std::vector<double>& time_s,
                                                const std::vector<bool>& gaps);

/// Returns the duration that each row represents: half of the steps to both neighbors. At an end or
/// a gap, the missing half equals the other one; a row without neighbors represents the usual step.
/// If rows are evenly spaced, all weights are 1, so that weighted sums are bit-identical to
/// unweighted sums. `gaps`: result of `FindGaps`.
std::vector<double> TimeWeights(const std::vector<double>& time_s, const std::vector<bool>& gaps);

/// Returns the weighted mean; NaN without values.
double WeightedMean(const std::vector<double>& values, const std::vector<double>& weights);

/// Returns the median step between rows begin to end - 1 [s]; 0 for fewer than two rows.
double UsualStep(const std::vector<double>& time_s, std::size_t begin, std::size_t end);

/// Time spans without gaps, between rows with finite `values`. The ends are included.
class CoveredTime {
 public:
  CoveredTime(const std::vector<double>& time_s, const std::vector<double>& values);
  bool Covers(double time_s) const;

 private:
  std::vector<std::pair<double, double>> spans_;
};

}  // namespace taut::compare
