// Pose from a recording, for `taut analyze --pose`.
#include "analyze_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "taut/run_folder.h"
#include "taut/trace_pose.h"

namespace taut::cli {

std::optional<Pose> ReadPose(const PoseArguments& args, const RobotSpec& robot, Diagnostics& out) {
  const SourceRef at{args.file, 0, 0};
  if (args.file.ends_with(".yaml")) {
    out.Error("trace.not_a_recording", at, "a YAML file contains no recorded pose",
              "expected a trace (.h5, .csv or .csv.gz); to analyze a model file of a pose, give it "
              "as FILE, without --pose");
    return std::nullopt;
  }
  const std::optional<Trace> trace = ReadTraceOfRun(args.file, out);
  if (!trace) return std::nullopt;
  const std::vector<double>& time_s = trace->time_s;
  std::size_t row = time_s.empty() ? 0 : time_s.size() - 1;
  if (args.at_s && !time_s.empty()) {
    if (*args.at_s < time_s.front() || *args.at_s > time_s.back()) {
      out.Error("trace.time_outside", at, fmt::format("the trace has no row at {:g} s", *args.at_s),
                fmt::format("expected {:g} s to {:g} s", time_s.front(), time_s.back()));
      return std::nullopt;
    }
    const auto nearer = [&](double a, double b) {
      return std::fabs(a - *args.at_s) < std::fabs(b - *args.at_s);
    };
    row = static_cast<std::size_t>(std::min_element(time_s.begin(), time_s.end(), nearer) -
                                   time_s.begin());
  }
  return PoseOfTrace(robot, *trace, row, at, out);
}

}  // namespace taut::cli
