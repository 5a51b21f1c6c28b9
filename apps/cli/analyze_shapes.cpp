// Modes, mechanisms and states of self-stress as runs for the viewer (`taut analyze --out`).
#include "analyze_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "output.h"
#include "standard_streams.h"
#include "taut/shape_run.h"

namespace taut::cli {

constexpr std::size_t kMostListed = 6;

int WriteShapes(const std::string& folder, const ExperimentSpec& experiment,
                const AnalysisResult& result, int most_modes, bool json, std::string& to_view) {
  Diagnostics found;
  std::vector<std::string> written;
  const auto write = [&](const std::string& where, const ExperimentSpec& of, const Modes& modes,
                         const ForceAnalysis& forces) {
    for (std::string& path : WriteShapeRuns(where, of, modes, forces, most_modes, {}, found)) {
      written.push_back(std::move(path));
    }
  };
  write(folder, experiment, {}, result.forces);
  for (const CaseResult& one : result.cases) {
    if (!one.modes) continue;
    ExperimentSpec there = experiment;  // modes are small motions about the equilibrium
    there.robot = RobotAt(experiment.robot, one.at.pose);
    MoveSupports(there.robot.def, one.loads);
    const std::string where = result.cases.size() == 1
                                  ? folder
                                  : (std::filesystem::path(folder) / one.loads.name).string();
    write(where, there, *one.modes, {});
  }
  if (!found.ok()) return Fail(found, kFailed);
  std::FILE* const to = json ? stderr : stdout;
  if (written.empty())
    fmt::print(to, "No shape to show: there is no mode, mechanism or self-stress\n");
  const std::size_t most = json || written.size() <= kMostListed ? written.size() : kMostListed - 1;
  for (std::size_t i = 0; i < most; ++i) fmt::print(to, "Shape: {}/trace.h5\n", written[i]);
  if (most < written.size()) {
    fmt::print(to, "... and {} more shapes in {}\n", written.size() - most, folder);
  }
  const auto mode = std::find_if(written.begin(), written.end(), [](const std::string& path) {
    return std::filesystem::path(path).filename().string().starts_with("mode_");
  });
  if (!written.empty()) to_view = (mode == written.end() ? written.front() : *mode) + "/trace.h5";
  return kOk;
}

}  // namespace taut::cli
