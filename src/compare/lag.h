/// Time lag between two signals by cross-correlation.
#pragma once

#include <vector>

namespace taut::compare {

struct Lag {
  double rows = 0.0;         ///< Positive: b comes later. NaN if undefined.
  bool at_limit = false;     ///< The best lag is the longest searched.
  double correlation = 0.0;  ///< Pearson's, at that lag. NaN likewise.
};

/// Finds the lag of at most `max_rows` rows at which a[i] and b[i + lag] correlate best; a parabola
/// through the best and its neighbors gives the fraction of a row. Rows at which either is not
/// finite are left out. All lags use the same middle rows of a, so that a signal with a trend does
/// not favor the lag that leaves its largest part out; the search removes at most half of the rows
/// at the ends.
Lag FindLag(const std::vector<double>& a, const std::vector<double>& b, int max_rows);

}  // namespace taut::compare
