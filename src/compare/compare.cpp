#include "taut/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "base/pattern.h"
#include "compare/common_clock.h"
#include "compare/lag.h"

namespace taut {
namespace {

using compare::CommonClock;
using compare::RowRange;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double Percent(double a, double b) { return b == 0.0 ? kNan : 100.0 * (a - b) / std::abs(b); }

Extreme Largest(const std::vector<double>& time_s, const std::vector<double>& values,
                RowRange rows) {
  Extreme largest{kNan, kNan};
  for (std::size_t i = rows.begin; i < rows.end; ++i) {
    if (std::isfinite(values[i]) && !(values[i] <= largest.value)) {
      largest = {values[i], time_s[i]};
    }
  }
  return largest;
}

WindowStatistics StatisticsOf(const std::vector<double>& values, RowRange rows) {
  WindowStatistics result{0, 0.0, kNan, kNan};
  for (std::size_t i = rows.begin; i < rows.end; ++i) {
    if (!std::isfinite(values[i])) continue;
    ++result.rows;
    result.mean += values[i];
    if (!(values[i] >= result.min)) result.min = values[i];
    if (!(values[i] <= result.max)) result.max = values[i];
  }
  result.mean = result.rows == 0 ? kNan : result.mean / static_cast<double>(result.rows);
  return result;
}

/// Sets what depends on the differences at the times of the common clock.
void CompareRows(const std::vector<double>& time_s, const std::vector<double>& a,
                 const std::vector<double>& b, ChannelComparison& result) {
  double sum = 0.0, squares = 0.0;
  result.error = {kNan, kNan};
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double difference = a[i] - b[i];
    if (!std::isfinite(difference)) continue;
    ++result.rows;
    sum += difference;
    squares += difference * difference;
    if (!(std::abs(difference) <= std::abs(result.error.value))) {
      result.error = {difference, time_s[i]};
    }
  }
  const double count = static_cast<double>(result.rows);
  result.bias = result.rows == 0 ? kNan : sum / count;
  result.rmse = result.rows == 0 ? kNan : std::sqrt(squares / count);
}

/// Evenly spaced times over the clock's span: a lag is a number of rows only if rows are even.
std::vector<double> EvenTimes(const CommonClock& clock) {
  std::vector<double> even(clock.time_s.size());
  const double first = clock.time_s.front();
  const double last = clock.time_s.back();
  for (std::size_t i = 0; i < even.size(); ++i) {
    const double part =
        even.size() < 2 ? 0.0 : static_cast<double>(i) / static_cast<double>(even.size() - 1);
    even[i] = i + 1 == even.size() ? last : first + part * (last - first);
  }
  return even;
}

/// Compares channel after channel on one clock.
class Comparer {
 public:
  Comparer(const Trace& a, const Trace& b, const CompareOptions& options, const CommonClock& clock)
      : a_(a), b_(b), options_(options), clock_(clock), even_s_(EvenTimes(clock)) {
    const double span_s = clock.time_s.back() - clock.time_s.front();
    step_s_ = clock.time_s.size() < 2 ? 0.0 : span_s / static_cast<double>(clock.time_s.size() - 1);
    for (std::size_t i = 0; i < even_s_.size(); ++i) {
      uneven_ = uneven_ || std::abs(even_s_[i] - clock.time_s[i]) > 1e-6 * step_s_;
    }
    rows_a_ = compare::RowsBetween(a.time_s, clock.from_s, clock.to_s);
    rows_b_ = compare::RowsBetween(b.time_s, clock.from_s, clock.to_s);
  }

  ChannelComparison Channel(std::size_t in_a, std::size_t in_b) const {
    const std::vector<double>& a = a_.values[in_a];
    const std::vector<double>& b = b_.values[in_b];
    ChannelComparison result;
    result.name = a_.channels[in_a].name;
    result.unit = a_.channels[in_a].unit;
    const auto on_clock_a = OnClock(a_.time_s, a, clock_.resample_a, rows_a_);
    const auto on_clock_b = OnClock(b_.time_s, b, clock_.resample_b, rows_b_);
    CompareRows(clock_.time_s, on_clock_a, on_clock_b, result);
    SetLag(on_clock_a, on_clock_b, result);
    result.max_a = Largest(a_.time_s, a, rows_a_);
    result.max_b = Largest(b_.time_s, b, rows_b_);
    result.max_error_percent = Percent(result.max_a.value, result.max_b.value);
    for (const TimeWindow& phase : options_.phases) {
      const double from_s = std::max(phase.from_s, clock_.from_s);
      const double to_s = std::min(phase.to_s, clock_.to_s);
      result.phases.push_back({StatisticsOf(a, compare::RowsBetween(a_.time_s, from_s, to_s)),
                               StatisticsOf(b, compare::RowsBetween(b_.time_s, from_s, to_s))});
    }
    return result;
  }

 private:
  std::vector<double> OnClock(const std::vector<double>& time_s, const std::vector<double>& values,
                              bool resample, RowRange rows) const {
    if (resample) return compare::Interpolate(time_s, values, clock_.time_s);
    return {values.begin() + static_cast<std::ptrdiff_t>(rows.begin),
            values.begin() + static_cast<std::ptrdiff_t>(rows.end)};
  }

  void SetLag(const std::vector<double>& a, const std::vector<double>& b,
              ChannelComparison& result) const {
    const int rows =
        step_s_ > 0.0
            ? static_cast<int>(std::min(1e6, std::floor(options_.max_lag_s / step_s_ + 1e-9)))
            : 0;
    const compare::Lag lag =
        uneven_ ? compare::FindLag(compare::Interpolate(clock_.time_s, a, even_s_),
                                   compare::Interpolate(clock_.time_s, b, even_s_), rows)
                : compare::FindLag(a, b, rows);
    result.lag_s = rows == 0 ? kNan : lag.rows * step_s_;
    result.lag_at_limit = rows > 0 && lag.at_limit;
    result.correlation = lag.correlation;
  }

  const Trace& a_;
  const Trace& b_;
  const CompareOptions& options_;
  const CommonClock& clock_;
  std::vector<double> even_s_;
  bool uneven_ = false;
  double step_s_ = 0.0;
  RowRange rows_a_, rows_b_;
};

std::vector<SystemMaximum> SystemMaxima(const std::vector<ChannelComparison>& channels,
                                        const std::vector<std::string>& patterns) {
  std::vector<SystemMaximum> result;
  for (const std::string& pattern : patterns) {
    SystemMaximum system{pattern, "", "", "", {kNan, kNan}, {kNan, kNan}, kNan};
    bool any = false;
    for (const ChannelComparison& channel : channels) {
      if (!base::Fits(pattern, channel.name)) continue;
      any = true;
      system.unit = channel.unit;
      if (channel.max_a.value > system.a.value || std::isnan(system.a.value)) {
        system.a = channel.max_a;
        system.channel_a = channel.name;
      }
      if (channel.max_b.value > system.b.value || std::isnan(system.b.value)) {
        system.b = channel.max_b;
        system.channel_b = channel.name;
      }
    }
    system.error_percent = Percent(system.a.value, system.b.value);
    if (any) result.push_back(std::move(system));
  }
  return result;
}

std::unordered_map<std::string, std::size_t> IndexOf(const Trace& trace) {
  std::unordered_map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < trace.channels.size(); ++i) index.emplace(trace.channels[i].name, i);
  return index;
}

}  // namespace

Comparison Compare(const Trace& a, const Trace& b, const CompareOptions& options) {
  const CommonClock clock = compare::MakeCommonClock(a.time_s, b.time_s, options);
  Comparison result;
  result.a = compare::SpanOf(a.time_s);
  result.b = compare::SpanOf(b.time_s);
  result.from_s = clock.from_s;
  result.to_s = clock.to_s;
  result.rows = clock.time_s.size();
  result.resampled = clock.resample_a || clock.resample_b;
  result.phases = options.phases;

  const auto index_a = IndexOf(a), index_b = IndexOf(b);
  for (const ChannelInfo& channel : b.channels) {
    if (!index_a.contains(channel.name) && base::FitsAny(options.channels, channel.name)) {
      result.only_b.push_back(channel.name);
    }
  }
  std::optional<Comparer> comparer;
  if (result.rows > 0) comparer.emplace(a, b, options, clock);
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    const ChannelInfo& channel = a.channels[i];
    if (!base::FitsAny(options.channels, channel.name)) continue;
    const auto in_b = index_b.find(channel.name);
    if (in_b == index_b.end()) {
      result.only_a.push_back(channel.name);
    } else if (const std::string& unit = b.channels[in_b->second].unit; unit != channel.unit) {
      result.unit_conflicts.push_back(
          fmt::format("{}: {} against {}", channel.name, channel.unit, unit));
    } else if (comparer) {
      result.channels.push_back(comparer->Channel(i, in_b->second));
    }
  }
  result.system = SystemMaxima(result.channels, options.system);
  return result;
}

}  // namespace taut
