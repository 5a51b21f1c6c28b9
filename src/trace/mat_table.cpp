// Tables of MATLAB files: variables as columns, with the clock of a mapping.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/pattern.h"
#include "trace/channel_names.h"
#include "trace/mat_variables.h"
#include "trace/readers.h"

namespace taut::trace {
namespace {

/// Returns the names of all vectors, to suggest one for a misspelled clock.
std::vector<std::string> VectorNames(const std::vector<MatVariable>& variables) {
  std::vector<std::string> names;
  for (const MatVariable& v : variables) {
    if (v.IsVector() && v.size() > 1) names.push_back(v.name);
  }
  return names;
}

/// Returns the layout's clock [s]; nothing and an error if it is missing or does not increase.
std::optional<std::vector<double>> ClockTimes(const std::string& path, const TableLayout& layout,
                                              const std::vector<double>& clock, Diagnostics& out) {
  std::vector<double> times;
  const double zero = layout.zero.value_or(clock.front());
  for (const double read : clock) {
    const double time_s = (read - zero) * layout.unit_s + layout.offset_s;
    const bool increases = times.empty() || time_s > times.back();
    if (!std::isfinite(time_s) || !increases) {
      out.Error(
          "mat.bad_clock", {path},
          fmt::format("value {} of the clock \"{}\" is {}", times.size() + 1, layout.time_column,
                      std::isfinite(time_s) ? "not larger than the previous one" : "not a number"),
          "times must increase");
      return std::nullopt;
    }
    times.push_back(time_s);
  }
  return times;
}

}  // namespace

std::optional<Trace> ReadMatTable(const std::string& path, const TableLayout& layout,
                                  Diagnostics& out) {
  const auto variables = ReadMatVariables(path, out);
  if (!variables) return std::nullopt;
  Trace trace;
  std::size_t rows = 0;
  if (!layout.row_s) {
    const auto clock = std::find_if(
        variables->begin(), variables->end(),
        [&](const MatVariable& v) { return v.name == layout.time_column && v.IsVector(); });
    if (clock == variables->end()) {
      out.Error("mat.no_clock", {path},
                fmt::format("the file has no vector \"{}\"", layout.time_column),
                DidYouMean(layout.time_column, VectorNames(*variables)));
      return std::nullopt;
    }
    rows = clock->size();
    auto times = ClockTimes(path, layout, clock->values, out);
    if (!times) return std::nullopt;
    trace.time_s = std::move(*times);
  }
  MatColumns columns = ColumnsOf(*variables, rows);
  for (std::size_t i = 0; i < columns.names.size(); ++i) {
    const std::string& name = columns.names[i];
    const bool ignored =
        std::any_of(layout.ignore.begin(), layout.ignore.end(),
                    [&](const std::string& pattern) { return base::Fits(pattern, name); });
    if (ignored || (!layout.row_s && name == layout.time_column)) continue;
    trace.channels.push_back({name, TableUnit(name)});
    trace.values.push_back(std::move(columns.values[i]));
  }
  if (layout.row_s) {
    const std::size_t count = trace.values.empty() ? 0 : trace.values.front().size();
    for (std::size_t i = 0; i < count; ++i) {
      trace.time_s.push_back(*layout.row_s * static_cast<double>(i) + layout.offset_s);
    }
  }
  if (trace.time_s.empty() || trace.channels.empty()) {
    out.Error("mat.no_columns", {path}, "the file has no numeric vectors of the clock's length",
              "save the log as vectors: objects such as timetable cannot be read");
    return std::nullopt;
  }
  return trace;
}

}  // namespace taut::trace
