#include <fmt/format.h>

#include <cmath>

#include "compare/orientation.h"
#include "compare/wrapped_angle.h"
#include "identify/residual_rows.h"
#include "taut/compare.h"
#include "taut/run_folder.h"

namespace taut::identify {
namespace {

/// Optional column of a set point file: time of each row on the experiment's clock.
constexpr const char* kOurClock = "experiment_s";

bool Rises(const std::vector<double>& times) {
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1])) return false;
  }
  return !times.empty() && std::isfinite(times.front()) && std::isfinite(times.back());
}

std::optional<Trace> Read(const FitExperiment& one, Diagnostics& out) {
  auto trace = ReadTraceOrLog(one.data_file, one.map_file, "fitted", out);
  if (trace) {
    compare::MakeOrientationsContinuous(*trace);
    compare::Unwrap(*trace);
  }
  return trace;
}

}  // namespace

std::optional<Measured> ReadMeasured(const FitExperiment& one, Diagnostics& out) {
  Measured measured;
  measured.ours_s = measured.setpoint_s = SetPoints(one.experiment);
  if (one.data_file.empty()) return measured;
  auto trace = Read(one, out);
  if (trace) measured.trace = std::move(*trace);
  if (trace && measured.trace.time_s.empty()) {
    out.Error("data.no_rows", {one.data_file}, "the data have no rows");
    trace.reset();
  }
  if (one.forward == FitForward::kLoadCases && trace &&
      measured.trace.time_s.size() != one.experiment.load_cases.size()) {
    out.Error("data.rows_differ_from_load_cases", one.data_at,
              fmt::format("experiments: {} has {} load cases, but its data have {} rows", one.name,
                          one.experiment.load_cases.size(), measured.trace.time_s.size()),
              "row i of the data must belong to load case i");
    trace.reset();
  }
  if (one.setpoints_file.empty()) return trace ? std::optional(measured) : std::nullopt;
  const auto times = ReadTraceOfRun(one.setpoints_file, out);
  const auto ours = times ? times->Find(kOurClock) : std::nullopt;
  if (ours) {
    measured.ours_s = times->values[*ours];
    if (!Rises(measured.ours_s)) {
      out.Error("data.clock_not_increasing", {one.setpoints_file},
                std::string(kOurClock) + " must increase from row to row");
      return std::nullopt;
    }
  } else if (times && times->time_s.size() != measured.setpoint_s.size()) {
    out.Error("data.rows_differ_from_setpoints", one.setpoints_at,
              fmt::format("experiments: {} has {} set points, but its `setpoints` file has {} rows",
                          one.name, measured.setpoint_s.size(), times->time_s.size()),
              std::string("a set point is where a program of rest lengths or a push reaches a new "
                          "value; a column ") +
                  kOurClock + " overrides this");
    return std::nullopt;
  }
  if (!trace || !times) return std::nullopt;
  measured.setpoint_s = times->time_s;
  return measured;
}

}  // namespace taut::identify
