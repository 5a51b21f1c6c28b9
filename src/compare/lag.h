/// By how much one signal comes after another.
#pragma once

#include <vector>

namespace taut::compare {

struct Lag {
  double rows = 0.0;         ///< Positive: b comes later. NaN if it cannot be told.
  bool at_limit = false;     ///< The best was the longest looked at.
  double correlation = 0.0;  ///< Pearson's, at that lag. NaN likewise.
};

/// Finds the lag of at most `max_rows` rows at which a[i] and b[i + lag] correlate best; a
/// parabola through the best and its neighbours gives the fraction of a row. Rows at which either
/// is not finite are left out. All lags see the same rows of a, the middle ones, so that a signal
/// with a trend does not favour the lag that leaves its largest part out; the search never takes
/// more than half of the rows away from the ends.
Lag FindLag(const std::vector<double>& a, const std::vector<double>& b, int max_rows);

}  // namespace taut::compare
