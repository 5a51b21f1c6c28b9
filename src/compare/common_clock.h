/// Common clock of two traces.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/compare.h"

namespace taut::compare {

/// Rows of a trace in a time span: begin to end - 1.
struct RowRange {
  std::size_t begin = 0, end = 0;
};
RowRange RowsBetween(const std::vector<double>& time_s, double from_s, double to_s);

/// Times at which two traces are compared: the rows of the trace with the longer usual step. The
/// other trace is interpolated linearly.
struct CommonClock {
  double from_s = 0.0, to_s = -1.0;
  std::vector<double> time_s;
  bool resample_a = false, resample_b = false;
};
CommonClock MakeCommonClock(const std::vector<double>& time_a_s,
                            const std::vector<double>& time_b_s, const CompareOptions& options);

/// Interpolates a channel at the times `at_s`, which must increase. Constant before the first and
/// after the last row. Returns NaN next to NaN and inside gaps (`FindGaps`).
std::vector<double> Interpolate(const std::vector<double>& time_s,
                                const std::vector<double>& values, const std::vector<bool>& gaps,
                                const std::vector<double>& at_s);

TraceSpan SpanOf(const std::vector<double>& time_s);

}  // namespace taut::compare
