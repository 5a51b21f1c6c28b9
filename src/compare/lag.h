/// Time lag between two signals by cross-correlation.
#pragma once

#include <vector>

namespace taut::compare {

struct Lag {
  double rows = 0.0;         ///< Positive: b is delayed. NaN if undefined.
  bool at_limit = false;     ///< Whether the best lag is the longest one searched.
  double correlation = 0.0;  ///< Pearson's correlation at this lag; NaN if undefined.
  /// RMS of the difference without its mean at this lag (whole rows), relative to the RMS without
  /// lag; NaN if undefined.
  double rms_ratio = 0.0;
};

/// Finds the lag, of at most `max_rows` rows, at which a[i] and b[i + lag] correlate best. A
/// parabola through the best value and its neighbors yields the fraction of a row. Rows with values
/// that are not finite are skipped. All lags use the same middle rows of a; otherwise a signal with
/// a trend would favor the lag that excludes its largest part. At most half of the rows are
/// excluded at the ends.
Lag FindLag(const std::vector<double>& a, const std::vector<double>& b, int max_rows);

}  // namespace taut::compare
