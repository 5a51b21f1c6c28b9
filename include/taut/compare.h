/// Comparison of two traces (a simulation and a measurement, two simulators, two versions): errors,
/// lag, correlation, extremes (docs/compare.md).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut {

/// Mapping of a foreign trace to the names, units and axes of taut (docs/formats/mapping.md).
struct Mapping {
  /// Rule for one channel name, or for a pattern with one `*` that `to` repeats. The first rule
  /// that matches a channel applies.
  struct Rule {
    std::string from, to;
    std::string unit;     ///< Unit of the result; empty: the unit in the name.
    double scale = 1.0;   ///< result = scale * value + offset
    double offset = 0.0;  ///< In the unit of the result.
    double period = 0.0;  ///< Period of values that wrap, in the unit of the result; 0: none.
  };
  std::vector<Rule> rules;           ///< In order; vectors and quaternions are resolved to these.
  std::optional<TableLayout> table;  ///< Layout of a file that is a plain table, not a trace.
};

/// Reads a mapping file (JSON). Returns nothing and adds diagnostics on errors.
std::optional<Mapping> LoadMapping(const std::string& path, Diagnostics& out);

/// Returns the trace with the mapping applied; channels without a matching rule keep their names.
/// Returns nothing and adds an error if two channels would get the same name. `path` is used in
/// diagnostics only.
std::optional<Trace> ApplyMapping(const Mapping& mapping, Trace trace, const std::string& path,
                                  Diagnostics& out);

/// Reads a file, as a table if the mapping has a table layout, else as a trace (`ReadTraceOfRun`),
/// and applies the mapping. `mapping_path` is used in diagnostics about rules that match no column
/// of a table.
std::optional<Trace> ReadMapped(const std::string& path, const Mapping& mapping,
                                const std::string& mapping_path, Diagnostics& out);

/// Named time span, ends included.
struct TimeWindow {
  std::string name;
  double from_s = 0.0, to_s = 0.0;
};

struct CompareOptions {
  std::vector<std::string> channels;   ///< Name patterns with `*`; empty: all.
  std::optional<double> from_s, to_s;  ///< Rows outside are ignored.
  std::vector<TimeWindow> phases;
  double max_lag_s = 0.5;  ///< Largest lag that is searched; 0: no search.
  /// Patterns of the channels for `SystemMaximum`. Patterns that match no compared channel are
  /// ignored.
  std::vector<std::string> system = {"cable/*/tension_n", "cable/*/elastic_n"};
};

/// Extreme value and its time.
struct Extreme {
  double value = 0.0;
  double time_s = 0.0;
};

/// Statistics of a trace's rows within a window, at times that both traces cover. The weight of a
/// row is half the time between its neighbors. Without rows: NaN.
struct WindowStatistics {
  std::size_t rows = 0;
  double mean = 0.0, min = 0.0, max = 0.0;
};

/// Comparison of one channel of both traces; b is the reference, differences are a - b, and means
/// are over time. Quaternions get the sign of a, made continuous, since q and -q are the same
/// orientation. A channel with a period is made continuous, and its differences are modulo the
/// period. Undefined values (the lag of a constant, a percentage of zero) are NaN.
struct ChannelComparison {
  std::string name, unit;
  std::size_t rows = 0;    ///< Compared rows of the common clock, where both have a number.
  double missing_s = 0.0;  ///< Part of the common time in which one trace has no number.
  double rmse = 0.0;
  double bias = 0.0;          ///< Mean difference.
  Extreme error;              ///< The difference of largest magnitude, signed.
  double lag_s = 0.0;         ///< Delay of b relative to a at the highest correlation.
  bool lag_at_limit = false;  ///< The best lag is the longest searched; the true one may exceed it.
  double correlation = 0.0;   ///< At `lag_s`, -1..1.
  Extreme max_a, max_b;       ///< Over each trace's rows, at times that both cover.
  double max_error_percent = 0;  ///< (max_a - max_b) / |max_b|.
  struct Phase {
    WindowStatistics a, b;
  };
  std::vector<Phase> phases;  ///< One per phase of `CompareOptions::phases`.
};

/// Largest value over all compared channels that match a pattern: the paper's measure.
struct SystemMaximum {
  std::string pattern, unit;
  std::string channel_a, channel_b;  ///< Channels with the maximum.
  Extreme a, b;
  double error_percent = 0.0;  ///< (a - b) / |b|.
};

/// Time axis of a trace.
struct TraceSpan {
  std::size_t rows = 0;
  double first_s = 0.0, last_s = 0.0;
  double step_s = 0.0;  ///< Median distance between rows.
  /// Gaps: distances between two rows that are more than five times the distances around them.
  std::vector<std::pair<double, double>> gaps_s = {};
};

/// Angle of a compared channel that jumps by a turn, without a period in its mapping.
struct WrappedAngle {
  std::string channel;
  bool in_b = false;    ///< In the reference, not in a.
  double time_s = 0.0;  ///< Time of the first jump.
};

struct Comparison {
  TraceSpan a, b;
  double from_s = 0.0, to_s = 0.0;  ///< Time span common to both and the options. Empty: from > to.
  std::size_t rows = 0;             ///< Rows of the common clock; 0: nothing to compare.
  bool resampled = false;           ///< The clocks differ: the finer trace was interpolated.
  std::vector<TimeWindow> phases;
  std::vector<ChannelComparison> channels;  ///< In the order of trace a.
  std::vector<SystemMaximum> system;
  std::vector<std::string> only_a, only_b;  ///< Selected channels that the other trace lacks.
  /// Compared channels `.../orientation_*` whose signs cannot be aligned, because a trace lacks a
  /// component of the quaternion.
  std::vector<std::string> unknown_signs;
  std::vector<WrappedAngle> wrapped_angles;
  std::vector<std::string> unit_conflicts;  ///< "name: N against lbf": not compared.
};

/// Compares the channels that both traces contain.
Comparison Compare(const Trace& a, const Trace& b, const CompareOptions& options);

/// Returns the short summary of a comparison for a terminal, without line ends: the verdict, the
/// largest values, channels that were not compared, and one line per phase and per group of
/// channels whose names differ only in the middle.
std::vector<std::string> ComparisonLines(const Comparison& comparison, const std::string& name_a,
                                         const std::string& name_b);

/// Formats the comparison as tables for a terminal. `name_a`, `name_b`: names of the traces.
std::string ComparisonTable(const Comparison& comparison, const std::string& name_a,
                            const std::string& name_b);

/// Formats the comparison as one JSON object; keys always in the same order, NaN as null.
std::string ComparisonJson(const Comparison& comparison, const std::string& name_a,
                           const std::string& name_b);

/// Largest allowed differences. Absent limits are not checked.
struct CompareLimits {
  std::optional<double> max_error_percent = std::nullopt;  ///< Magnitude, at every system maximum.
  std::optional<double> max_rmse = std::nullopt;  ///< For every compared channel, in its unit.
};

/// Returns one sentence per exceeded limit; empty if the comparison passes. Undefined values (NaN,
/// no system maximum at all) count as exceeded.
std::vector<std::string> ExceededLimits(const Comparison& comparison, const CompareLimits& limits);

}  // namespace taut
