#include "compare/channel_comparer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/gaps.h"
#include "compare/lag.h"
#include "compare/wrapped_angle.h"

namespace taut::compare {
namespace {

constexpr double kUnknownValue = std::numeric_limits<double>::quiet_NaN();

/// Finite rows of a trace in a range, limited to times that the other trace's channel covers.
struct SharedRows {
  std::vector<double> time_s, values;
};

SharedRows RowsShared(const std::vector<double>& time_s, const std::vector<double>& values,
                      RowRange rows, const CoveredTime& other) {
  SharedRows shared;
  for (std::size_t i = rows.begin; i < rows.end; ++i) {
    if (!std::isfinite(values[i]) || !other.Covers(time_s[i])) continue;
    shared.time_s.push_back(time_s[i]);
    shared.values.push_back(values[i]);
  }
  return shared;
}

Extreme LargestOf(const SharedRows& rows) {
  Extreme largest{kUnknownValue, kUnknownValue};
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    if (!(rows.values[i] <= largest.value)) largest = {rows.values[i], rows.time_s[i]};
  }
  return largest;
}

WindowStatistics StatisticsOf(const SharedRows& rows) {
  WindowStatistics result{rows.values.size(), kUnknownValue, kUnknownValue, kUnknownValue};
  for (const double value : rows.values) {
    if (!(value >= result.min)) result.min = value;
    if (!(value <= result.max)) result.max = value;
  }
  result.mean = WeightedMean(rows.values, TimeWeights(rows.time_s, FindGaps(rows.time_s)));
  return result;
}

/// Sets all results that depend on differences at the times of the common clock. `usual_s`: usual
/// step of the clock.
void CompareRows(const CommonClock& clock, double usual_s, const std::vector<double>& a,
                 const std::vector<double>& b, ChannelComparison& result) {
  std::vector<double> time_s, differences;
  result.error = {kUnknownValue, kUnknownValue};
  for (std::size_t i = 0; i < clock.time_s.size(); ++i) {
    const double difference = a[i] - b[i];
    if (!std::isfinite(difference)) continue;
    time_s.push_back(clock.time_s[i]);
    differences.push_back(difference);
    if (!(std::abs(difference) <= std::abs(result.error.value))) {
      result.error = {difference, clock.time_s[i]};
    }
  }
  result.rows = time_s.size();
  result.bias = result.rmse = kUnknownValue;
  result.missing_s = clock.to_s - clock.from_s;
  if (time_s.empty()) return;
  const std::vector<bool> gaps = FindGaps(time_s);
  const std::vector<double> weights = TimeWeights(time_s, gaps);
  result.bias = WeightedMean(differences, weights);
  for (double& difference : differences) difference *= difference;
  result.rmse = std::sqrt(WeightedMean(differences, weights));
  result.missing_s = 0;
  for (const auto& [from_s, to_s] : GapSpans(time_s, gaps)) result.missing_s += to_s - from_s;
  // Add the time before the first and after the last finite row. Ignore less than two steps, which
  // may be due to different clocks.
  const double least_s = 2 * usual_s;
  for (const double end_s : {time_s.front() - clock.from_s, clock.to_s - time_s.back()}) {
    if (end_s > least_s) result.missing_s += end_s;
  }
}

/// Returns evenly spaced times over the clock's span, since a lag in rows requires even spacing.
/// The spacing is the usual step of the clock, so that gaps do not make it coarser.
std::vector<double> EvenTimes(const CommonClock& clock, double usual_s) {
  const double first = clock.time_s.front(), last = clock.time_s.back();
  const std::size_t rows = clock.time_s.size();
  const double wanted = usual_s > 0 ? std::round((last - first) / usual_s) + 1 : 1.0;
  const double count =
      std::clamp(wanted, static_cast<double>(rows), 8.0 * static_cast<double>(rows));
  std::vector<double> even(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < even.size(); ++i) {
    const double part =
        even.size() < 2 ? 0.0 : static_cast<double>(i) / static_cast<double>(even.size() - 1);
    even[i] = i + 1 == even.size() ? last : first + part * (last - first);
  }
  return even;
}

}  // namespace

double Percent(double a, double b) {
  return b == 0.0 ? kUnknownValue : 100.0 * (a - b) / std::abs(b);
}

ChannelComparer::ChannelComparer(const Trace& a, const Trace& b, const CompareOptions& options,
                                 const CommonClock& clock)
    : a_(a),
      b_(b),
      options_(options),
      clock_(clock),
      gaps_a_(FindGaps(a.time_s)),
      gaps_b_(FindGaps(b.time_s)),
      gaps_clock_(FindGaps(clock.time_s)),
      usual_s_(UsualStep(clock.time_s, 0, clock.time_s.size())),
      even_s_(EvenTimes(clock, usual_s_)) {
  const double span_s = clock.time_s.back() - clock.time_s.front();
  step_s_ = even_s_.size() < 2 ? 0.0 : span_s / static_cast<double>(even_s_.size() - 1);
  uneven_ = even_s_.size() != clock.time_s.size();
  for (std::size_t i = 0; !uneven_ && i < even_s_.size(); ++i) {
    uneven_ = std::abs(even_s_[i] - clock.time_s[i]) > 1e-6 * step_s_;
  }
  rows_a_ = RowsBetween(a.time_s, clock.from_s, clock.to_s);
  rows_b_ = RowsBetween(b.time_s, clock.from_s, clock.to_s);
  const std::vector<QuaternionChannels> of_b = FindQuaternions(b);
  for (const QuaternionChannels& in_a : FindQuaternions(a)) {
    for (const QuaternionChannels& in_b : of_b) {
      if (a.channels[in_a[0]].name == b.channels[in_b[0]].name)
        quaternions_.push_back({in_a, in_b});
    }
  }
}

std::vector<double> ChannelComparer::OnClock(const std::vector<double>& time_s,
                                             const std::vector<double>& values,
                                             const std::vector<bool>& gaps, bool resample,
                                             RowRange rows) const {
  if (resample) return Interpolate(time_s, values, gaps, clock_.time_s);
  return {values.begin() + static_cast<std::ptrdiff_t>(rows.begin),
          values.begin() + static_cast<std::ptrdiff_t>(rows.end)};
}

ChannelComparer::Columns ChannelComparer::SingleColumns(std::size_t in_a, std::size_t in_b) const {
  Columns of{a_.values[in_a], b_.values[in_b], {}, {}};
  const double period_a = a_.channels[in_a].period, period_b = b_.channels[in_b].period;
  if (period_a > 0) Unwrap(of.a, period_a);  // must precede interpolation between rows
  if (period_b > 0) Unwrap(of.b, period_b);
  of.clock_a = OnClock(a_.time_s, of.a, gaps_a_, clock_.resample_a, rows_a_);
  of.clock_b = OnClock(b_.time_s, of.b, gaps_b_, clock_.resample_b, rows_b_);
  // A wrapped channel lacks the number of turns: take it from the other trace.
  if (period_b > 0) {
    AlignTurns(of.clock_a, period_b, of.clock_b);
    AlignTurns(Interpolate(a_.time_s, of.a, gaps_a_, b_.time_s), period_b, of.b);
  } else if (period_a > 0) {
    AlignTurns(of.clock_b, period_a, of.clock_a);
    AlignTurns(Interpolate(b_.time_s, of.b, gaps_b_, a_.time_s), period_a, of.a);
  }
  return of;
}

const ChannelComparer::Columns& ChannelComparer::ColumnsOf(std::size_t in_a, std::size_t in_b) {
  const auto pair = std::find_if(quaternions_.begin(), quaternions_.end(), [&](const Pair& p) {
    return std::find(p.in_a.begin(), p.in_a.end(), in_a) != p.in_a.end();
  });
  if (pair == quaternions_.end()) {
    single_ = SingleColumns(in_a, in_b);
    return single_;
  }
  const auto which = static_cast<std::size_t>(pair - quaternions_.begin());
  if (turned_ != which) {
    turned_ = which;
    QuaternionRows a, b, clock_a, clock_b, a_at_b;
    for (std::size_t i = 0; i < 4; ++i) {
      a[i] = a_.values[pair->in_a[i]];
      b[i] = b_.values[pair->in_b[i]];
    }
    MakeContinuous(a);
    MakeContinuous(b);  // must precede interpolation between rows
    for (std::size_t i = 0; i < 4; ++i) {
      clock_a[i] = OnClock(a_.time_s, a[i], gaps_a_, clock_.resample_a, rows_a_);
      clock_b[i] = OnClock(b_.time_s, b[i], gaps_b_, clock_.resample_b, rows_b_);
      a_at_b[i] = Interpolate(a_.time_s, a[i], gaps_a_, b_.time_s);
    }
    AlignTo(clock_a, clock_b);
    AlignTo(a_at_b, b);
    for (std::size_t i = 0; i < 4; ++i) {
      columns_[i] = {std::move(a[i]), std::move(b[i]), std::move(clock_a[i]),
                     std::move(clock_b[i])};
    }
  }
  const auto at = std::find(pair->in_a.begin(), pair->in_a.end(), in_a) - pair->in_a.begin();
  return columns_[static_cast<std::size_t>(at)];
}

ChannelComparison ChannelComparer::Compare(std::size_t in_a, std::size_t in_b) {
  const Columns& of = ColumnsOf(in_a, in_b);
  ChannelComparison result;
  result.name = a_.channels[in_a].name;
  result.unit = a_.channels[in_a].unit;
  CompareRows(clock_, usual_s_, of.clock_a, of.clock_b, result);
  SetLag(of, result);
  const CoveredTime covered_a(a_.time_s, of.a), covered_b(b_.time_s, of.b);
  result.max_a = LargestOf(RowsShared(a_.time_s, of.a, rows_a_, covered_b));
  result.max_b = LargestOf(RowsShared(b_.time_s, of.b, rows_b_, covered_a));
  result.max_error_percent = Percent(result.max_a.value, result.max_b.value);
  for (const TimeWindow& phase : options_.phases) {
    const double from_s = std::max(phase.from_s, clock_.from_s);
    const double to_s = std::min(phase.to_s, clock_.to_s);
    const RowRange in_a_s = RowsBetween(a_.time_s, from_s, to_s);
    const RowRange in_b_s = RowsBetween(b_.time_s, from_s, to_s);
    result.phases.push_back({StatisticsOf(RowsShared(a_.time_s, of.a, in_a_s, covered_b)),
                             StatisticsOf(RowsShared(b_.time_s, of.b, in_b_s, covered_a))});
  }
  return result;
}

void ChannelComparer::SetLag(const Columns& of, ChannelComparison& result) const {
  const int rows =
      step_s_ > 0.0
          ? static_cast<int>(std::min(1e6, std::floor(options_.max_lag_s / step_s_ + 1e-9)))
          : 0;
  const Lag lag = uneven_
                      ? FindLag(Interpolate(clock_.time_s, of.clock_a, gaps_clock_, even_s_),
                                Interpolate(clock_.time_s, of.clock_b, gaps_clock_, even_s_), rows)
                      : FindLag(of.clock_a, of.clock_b, rows);
  result.lag_s = rows == 0 ? kUnknownValue : lag.rows * step_s_;
  result.lag_at_limit = rows > 0 && lag.at_limit;
  result.correlation = lag.correlation;
  result.lag_rms_ratio = lag.rms_ratio;
}

}  // namespace taut::compare
