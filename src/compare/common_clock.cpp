#include "compare/common_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/gaps.h"

namespace taut::compare {
namespace {

/// Compares times with a tolerance, since CSV files may round them.
bool SameTimes(const std::vector<double>& a, RowRange rows_a, const std::vector<double>& b,
               RowRange rows_b) {
  if (rows_a.end - rows_a.begin != rows_b.end - rows_b.begin) return false;
  for (std::size_t i = rows_a.begin, j = rows_b.begin; i < rows_a.end; ++i, ++j) {
    if (!(std::abs(a[i] - b[j]) <= TimeTolerance(a[i]))) return false;
  }
  return true;
}

double StepOf(const std::vector<double>& time_s, RowRange rows) {
  return UsualStep(time_s, rows.begin, rows.end);
}

}  // namespace

RowRange RowsBetween(const std::vector<double>& time_s, double from_s, double to_s) {
  const auto begin = std::lower_bound(time_s.begin(), time_s.end(), from_s - TimeTolerance(from_s));
  const auto end = std::upper_bound(begin, time_s.end(), to_s + TimeTolerance(to_s));
  return {static_cast<std::size_t>(begin - time_s.begin()),
          static_cast<std::size_t>(end - time_s.begin())};
}

CommonClock MakeCommonClock(const std::vector<double>& time_a_s,
                            const std::vector<double>& time_b_s, const CompareOptions& options) {
  CommonClock clock;
  if (time_a_s.empty() || time_b_s.empty()) return clock;
  clock.from_s = std::max(time_a_s.front(), time_b_s.front());
  clock.to_s = std::min(time_a_s.back(), time_b_s.back());
  if (options.from_s) clock.from_s = std::max(clock.from_s, *options.from_s);
  if (options.to_s) clock.to_s = std::min(clock.to_s, *options.to_s);
  if (!(clock.from_s <= clock.to_s)) return clock;

  const RowRange rows_a = RowsBetween(time_a_s, clock.from_s, clock.to_s);
  const RowRange rows_b = RowsBetween(time_b_s, clock.from_s, clock.to_s);
  const bool same = SameTimes(time_a_s, rows_a, time_b_s, rows_b);
  clock.resample_a = !same && StepOf(time_a_s, rows_a) < StepOf(time_b_s, rows_b);
  clock.resample_b = !same && !clock.resample_a;
  const std::vector<double>& time_s = clock.resample_a ? time_b_s : time_a_s;
  const RowRange rows = clock.resample_a ? rows_b : rows_a;
  clock.time_s.assign(time_s.begin() + static_cast<std::ptrdiff_t>(rows.begin),
                      time_s.begin() + static_cast<std::ptrdiff_t>(rows.end));
  return clock;
}

std::vector<double> Interpolate(const std::vector<double>& time_s,
                                const std::vector<double>& values, const std::vector<bool>& gaps,
                                const std::vector<double>& at_s) {
  std::vector<double> result;
  result.reserve(at_s.size());
  std::size_t next = 0;  // index of the first row after `at`
  for (const double at : at_s) {
    while (next < time_s.size() && time_s[next] <= at) ++next;
    if (next == 0) {
      result.push_back(values.front());
    } else if (next == time_s.size() || time_s[next - 1] == at) {
      result.push_back(values[next - 1]);
    } else if (gaps[next - 1]) {
      // CSV files may round times, so a time within the tolerance counts as equal to the row's
      // time.
      const bool on_next = time_s[next] - at <= TimeTolerance(at);
      const bool on_last = at - time_s[next - 1] <= TimeTolerance(at);
      result.push_back(on_next   ? values[next]
                       : on_last ? values[next - 1]
                                 : std::numeric_limits<double>::quiet_NaN());
    } else {
      const double part = (at - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
      result.push_back(values[next - 1] + part * (values[next] - values[next - 1]));
    }
  }
  return result;
}

TraceSpan SpanOf(const std::vector<double>& time_s) {
  if (time_s.empty()) return {};
  return {time_s.size(), time_s.front(), time_s.back(), StepOf(time_s, {0, time_s.size()}),
          GapSpans(time_s, FindGaps(time_s))};
}

}  // namespace taut::compare
