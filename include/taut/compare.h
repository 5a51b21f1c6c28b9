/// How far two traces are apart: a simulation and a measurement, two simulators, two versions
/// (docs/compare.md).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut {

/// Gives a trace of another program the names, units and axes of taut (docs/formats/mapping.md).
struct Mapping {
  /// One channel: a name, or a pattern with one `*` that `to` repeats. The first rule that fits a
  /// channel is the one that is used.
  struct Rule {
    std::string from, to;
    std::string unit;     ///< Of the result; empty: as the name says.
    double scale = 1.0;   ///< result = scale * value + offset
    double offset = 0.0;  ///< In the unit of the result.
  };
  std::vector<Rule> rules;           ///< In order; vectors and quaternions are resolved to these.
  std::optional<TableLayout> table;  ///< Of a file that is no trace, only a table.
};

/// Reads a mapping file (JSON). Nothing and diagnostics if it has errors.
std::optional<Mapping> LoadMapping(const std::string& path, Diagnostics& out);

/// The trace with the mapping applied; channels that no rule fits keep their names. Nothing and a
/// diagnostic if two channels would get one name. `path` is named in diagnostics only.
std::optional<Trace> ApplyMapping(const Mapping& mapping, Trace trace, const std::string& path,
                                  Diagnostics& out);

/// Reads a file as the mapping says: as a table, if it says how one is laid out, else as a trace
/// (`ReadTraceOfRun`), and applies the mapping. `mapping_path` is named in diagnostics: of rules
/// that fit no column of a table.
std::optional<Trace> ReadMapped(const std::string& path, const Mapping& mapping,
                                const std::string& mapping_path, Diagnostics& out);

/// A named span of time, ends included.
struct TimeWindow {
  std::string name;
  double from_s = 0.0, to_s = 0.0;
};

struct CompareOptions {
  std::vector<std::string> channels;   ///< Name patterns with `*`; empty: all.
  std::optional<double> from_s, to_s;  ///< What lies outside does not count.
  std::vector<TimeWindow> phases;
  double max_lag_s = 0.5;  ///< How far to look for a delay; 0: not at all.
  /// Whose largest values are the system's. Patterns that fit no compared channel are ignored.
  std::vector<std::string> system = {"cable/*/tension_n", "cable/*/elastic_n"};
};

/// A value and the moment at which it was reached.
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

/// One channel of both traces; differences are a - b, and means are over time. A component of a
/// quaternion has the sign of a, made continuous: q and -q are the same orientation. b is the
/// reference. Undefined values (the lag of a constant, a percentage of zero) are NaN.
struct ChannelComparison {
  std::string name, unit;
  std::size_t rows = 0;    ///< Compared rows of the common clock; both have a number there.
  double missing_s = 0.0;  ///< Part of the common time in which one trace has no number.
  double rmse = 0.0;
  double bias = 0.0;             ///< Mean difference.
  Extreme error;                 ///< The difference of largest magnitude, signed.
  double lag_s = 0.0;            ///< By how much b comes after a, where they are most alike.
  bool lag_at_limit = false;     ///< The best lag is the longest looked at: it may be longer.
  double correlation = 0.0;      ///< At that lag, -1..1.
  Extreme max_a, max_b;          ///< From the rows of each trace, at times that both cover.
  double max_error_percent = 0;  ///< (max_a - max_b) / |max_b|.
  struct Phase {
    WindowStatistics a, b;
  };
  std::vector<Phase> phases;  ///< One for each of `CompareOptions::phases`.
};

/// The largest value of any compared channel that fits a pattern: the paper's measure.
struct SystemMaximum {
  std::string pattern, unit;
  std::string channel_a, channel_b;  ///< Where it occurred.
  Extreme a, b;
  double error_percent = 0.0;  ///< (a - b) / |b|.
};

/// The rows of a trace.
struct TraceSpan {
  std::size_t rows = 0;
  double first_s = 0.0, last_s = 0.0;
  double step_s = 0.0;  ///< Median distance of rows.
  /// Spans between two rows that are more than five times as long as the distances around them.
  std::vector<std::pair<double, double>> gaps_s = {};
};

struct Comparison {
  TraceSpan a, b;
  double from_s = 0.0, to_s = 0.0;  ///< Common to both and to the options. Empty: from > to.
  std::size_t rows = 0;             ///< Of the common clock; 0: nothing to compare.
  bool resampled = false;           ///< The clocks differ: the finer was interpolated.
  std::vector<TimeWindow> phases;
  std::vector<ChannelComparison> channels;  ///< In the order of a.
  std::vector<SystemMaximum> system;
  std::vector<std::string> only_a, only_b;  ///< Selected channels that the other lacks.
  /// Compared channels `.../orientation_*` whose signs cannot be aligned: one of the traces lacks a
  /// component of the quaternion.
  std::vector<std::string> unknown_signs;
  std::vector<std::string> unit_conflicts;  ///< "name: N against lbf": not compared.
};

Comparison Compare(const Trace& a, const Trace& b, const CompareOptions& options);

/// The comparison as a person reads it. `name_a`, `name_b`: what to call the traces.
std::string ComparisonTable(const Comparison& comparison, const std::string& name_a,
                            const std::string& name_b);

/// The comparison as one JSON object; keys always in the same order, NaN as null.
std::string ComparisonJson(const Comparison& comparison, const std::string& name_a,
                           const std::string& name_b);

/// What a comparison may show and still pass. Nothing: not looked at.
struct CompareLimits {
  std::optional<double> max_error_percent = std::nullopt;  ///< Magnitude, of every system maximum.
  std::optional<double> max_rmse = std::nullopt;  ///< Of every compared channel, in its unit.
};

/// One sentence for each limit that is exceeded; empty: passed. A value that cannot be told
/// (NaN, no system maximum at all) does not pass.
std::vector<std::string> ExceededLimits(const Comparison& comparison, const CompareLimits& limits);

}  // namespace taut
