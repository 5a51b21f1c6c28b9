/// Common clock of two traces.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/compare.h"

namespace taut::compare {

/// The rows of one trace in a span of time: begin .. end - 1.
struct RowRange {
  std::size_t begin = 0, end = 0;
};
RowRange RowsBetween(const std::vector<double>& time_s, double from_s, double to_s);

/// Times at which two traces are compared: the rows of the trace with the longer usual step. The
/// other is interpolated linearly between its rows.
struct CommonClock {
  double from_s = 0.0, to_s = -1.0;
  std::vector<double> time_s;
  bool resample_a = false, resample_b = false;
};
CommonClock MakeCommonClock(const std::vector<double>& time_a_s,
                            const std::vector<double>& time_b_s, const CompareOptions& options);

/// Returns the values of a channel at `at_s`, which rises; held before the first row and after the
/// last. NaN next to NaN and inside of gaps (`FindGaps`).
std::vector<double> Interpolate(const std::vector<double>& time_s,
                                const std::vector<double>& values, const std::vector<bool>& gaps,
                                const std::vector<double>& at_s);

TraceSpan SpanOf(const std::vector<double>& time_s);

}  // namespace taut::compare
