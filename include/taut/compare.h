/// Comparison of two traces: errors, lag, correlation and extremes (docs/compare.md). Typical
/// pairs: simulation and measurement, two simulators, two versions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut {

/// Mapping from the names, units and axes of a foreign trace to taut's (docs/formats/mapping.md).
struct Mapping {
  /// Rule for one channel name, or for a pattern with one `*`, whose match replaces the `*` in
  /// `to`. The first matching rule applies.
  struct Rule {
    std::string from, to;
    std::string unit;     ///< Unit of the result; empty: the unit in the name.
    double scale = 1.0;   ///< result = scale * value + offset
    double offset = 0.0;  ///< In the unit of the result.
    /// Period of values that wrap, in the unit of the result; 0: no wrapping.
    double period = 0.0;
  };
  /// Rules in order, including those for the components of vectors and quaternions.
  std::vector<Rule> rules;
  std::optional<TableLayout> table;  ///< Layout of a file that is a plain table instead of a trace.
};

/// Reads a mapping file (JSON). On an error, returns nothing and adds diagnostics.
std::optional<Mapping> LoadMapping(const std::string& path, Diagnostics& out);

/// Returns the trace with the mapping applied. Channels without a matching rule keep their names.
/// Returns nothing and adds an error if two channels would get the same name. Diagnostics cite
/// `path`.
std::optional<Trace> ApplyMapping(const Mapping& mapping, Trace trace, const std::string& path,
                                  Diagnostics& out);

/// Reads a file and applies the mapping. The file is a table if the mapping has a table layout,
/// otherwise a trace (`ReadTraceOfRun`). Diagnostics about rules that match no table column cite
/// `mapping_path`.
std::optional<Trace> ReadMapped(const std::string& path, const Mapping& mapping,
                                const std::string& mapping_path, Diagnostics& out);

/// Reads a trace or, with a mapping file, a log or the trace of another program. `mapping_path`: ""
/// for a trace with taut's names. Warns of an unfinished trace; `use` completes the warning:
/// "compared". `is_log`: set to whether the file is not a trace of a simulator.
std::optional<Trace> ReadTraceOrLog(const std::string& path, const std::string& mapping_path,
                                    const std::string& use, Diagnostics& out,
                                    bool* is_log = nullptr);

/// Named time span, both ends included.
struct TimeWindow {
  std::string name;
  double from_s = 0.0, to_s = 0.0;
};

struct CompareOptions {
  std::vector<std::string> channels;   ///< Name patterns with `*`; empty: all.
  std::optional<double> from_s, to_s;  ///< Time span to compare; rows outside are ignored.
  std::vector<TimeWindow> phases;
  double max_lag_s = 0.5;  ///< Largest lag to search; 0: no search.
  /// Patterns of channels, one `SystemMaximum` each. A pattern without a match is ignored.
  std::vector<std::string> system = {"cable/*/tension_n", "cable/*/elastic_n"};
};

/// Extreme value and its time.
struct Extreme {
  double value = 0.0;
  double time_s = 0.0;
};

/// Statistics of the rows of a trace within a time window and within the time range of both traces.
/// Each row is weighted by half the time between its neighbors. NaN without rows.
struct WindowStatistics {
  std::size_t rows = 0;
  double mean = 0.0, min = 0.0, max = 0.0;
};

/// Comparison of one channel. Trace b is the reference, differences are a - b, means are over time.
/// Since q and -q are the same orientation, quaternions in b get the sign of those in a, and signs
/// are continuous in time. A channel with a period is unwrapped; its differences are modulo the
/// period. Undefined values are NaN: the lag of a constant, a percentage of zero.
struct ChannelComparison {
  std::string name, unit;
  std::size_t rows = 0;    ///< Compared rows on the common clock: both traces have a number.
  double missing_s = 0.0;  ///< Part of the common time in which a trace has no number.
  double rmse = 0.0;
  double bias = 0.0;   ///< Mean difference.
  Extreme error;       ///< Signed difference with the largest magnitude.
  double lag_s = 0.0;  ///< Delay of b relative to a with the highest correlation.
  /// The best lag is the largest one searched; the true lag may be larger.
  bool lag_at_limit = false;
  double correlation = 0.0;  ///< Correlation at `lag_s`, -1..1.
  /// RMS of the difference without bias at `lag_s`, relative to the RMS without lag. A decaying
  /// signal correlates with an earlier, larger part of itself, although the difference grows.
  double lag_rms_ratio = 1.0;
  Extreme max_a, max_b;          ///< Over the rows of each trace, within the time range of both.
  double max_error_percent = 0;  ///< Relative error of the maximum: (max_a - max_b) / |max_b|.
  struct Phase {
    WindowStatistics a, b;
  };
  std::vector<Phase> phases;  ///< One per phase of `CompareOptions::phases`.
};

/// Maximum over all compared channels that match a pattern, as in Mirletz et al. 2015.
struct SystemMaximum {
  std::string pattern, unit;
  std::string channel_a, channel_b;  ///< Channels that contain the maximum.
  Extreme a, b;
  double error_percent = 0.0;  ///< Relative error of the maximum: (a - b) / |b|.
};

/// Time axis of a trace.
struct TraceSpan {
  std::size_t rows = 0;
  double first_s = 0.0, last_s = 0.0;
  double step_s = 0.0;  ///< Median time between successive rows.
  /// Gaps: times between two rows that exceed five times the neighboring ones.
  std::vector<std::pair<double, double>> gaps_s = {};
};

/// Compared angle that jumps by a full turn, but has no period in the mapping.
struct WrappedAngle {
  std::string channel;
  bool in_b = false;    ///< In b (the reference) instead of a.
  double time_s = 0.0;  ///< Time of the first jump.
};

struct Comparison {
  TraceSpan a, b;
  /// Common time span of both traces and the options. Empty if from > to.
  double from_s = 0.0, to_s = 0.0;
  std::size_t rows = 0;    ///< Rows on the common clock; 0: nothing to compare.
  bool resampled = false;  ///< The clocks differ, so the finer trace was interpolated.
  std::vector<TimeWindow> phases;
  std::vector<ChannelComparison> channels;  ///< In the order of trace a.
  std::vector<SystemMaximum> system;
  std::vector<std::string> only_a, only_b;  ///< Selected channels that exist in one trace only.
  /// Compared channels `.../orientation_*` without sign alignment, because a trace lacks a
  /// component of the quaternion.
  std::vector<std::string> unknown_signs;
  std::vector<WrappedAngle> wrapped_angles;
  /// Channels that are not compared, for example "name: N against lbf".
  std::vector<std::string> unit_conflicts;
};

/// Compares the channels that exist in both traces.
Comparison Compare(const Trace& a, const Trace& b, const CompareOptions& options);

/// Returns a short summary for a terminal, one text per line without line ends. Contents: the
/// verdict, the largest values, channels that were not compared, one line per phase, and one line
/// per group of channels (with names that differ only in the middle).
std::vector<std::string> ComparisonLines(const Comparison& comparison, const std::string& name_a,
                                         const std::string& name_b);

/// Returns a verdict on a simulation (a) compared with a measurement (b), at most five lines.
/// Contents: the compared channels; the errors of the worst group of channels; a common bias and a
/// common lag with their likely causes, if there are any. Empty without compared channels.
std::vector<std::string> MeasuredVerdict(const Comparison& comparison, const std::string& name_a,
                                         const std::string& name_b);

/// Returns a self-contained HTML page: the verdict, and for each group of channels its errors, bars
/// of bias and RMSE, a scatter plot of measured against simulated values, and curves. `measured`:
/// `b` is a measurement and `a` a simulation; otherwise both are runs, and the page begins with the
/// lines of `ComparisonLines` in place of the verdict.
std::string ComparisonPage(const Comparison& comparison, const Trace& a, const Trace& b,
                           const std::string& name_a, const std::string& name_b, bool measured);

/// Formats the comparison as text tables for a terminal. `name_a`, `name_b`: names of the traces.
std::string ComparisonTable(const Comparison& comparison, const std::string& name_a,
                            const std::string& name_b);

/// Formats the comparison as a JSON object with keys in a fixed order and NaN as null.
std::string ComparisonJson(const Comparison& comparison, const std::string& name_a,
                           const std::string& name_b);

/// Largest allowed differences. An absent limit is not checked.
struct CompareLimits {
  /// Magnitude [%], for every system maximum.
  std::optional<double> max_error_percent = std::nullopt;
  std::optional<double> max_rmse = std::nullopt;  ///< For every compared channel, in its unit.
};

/// Returns one sentence per exceeded limit; none if the comparison passes. Undefined values (NaN,
/// or no system maximum) count as exceeded.
std::vector<std::string> ExceededLimits(const Comparison& comparison, const CompareLimits& limits);

}  // namespace taut
