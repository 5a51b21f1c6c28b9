// Modes, mechanisms and states of self-stress as runs for the viewer (`taut analyze --out`).
#include "analyze_shapes.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "output.h"
#include "standard_streams.h"
#include "taut/shape_run.h"

namespace taut::cli {

int WriteShapes(const std::string& folder, const ExperimentSpec& experiment,
                const AnalysisResult& result, int most_modes, bool json) {
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
    const std::string where = result.cases.size() == 1
                                  ? folder
                                  : (std::filesystem::path(folder) / one.loads.name).string();
    write(where, there, *one.modes, {});
  }
  if (!found.ok()) return Fail(found, kFailed);
  std::FILE* const to = json ? stderr : stdout;
  if (!json) fmt::print("\n");
  if (written.empty())
    fmt::print(to, "No shape to show: there is no mode, mechanism or self-stress\n");
  for (const std::string& path : written) fmt::print(to, "Shape: {}/trace.h5\n", path);
  return kOk;
}

}  // namespace taut::cli
