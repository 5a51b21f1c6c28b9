#include "live_inputs.h"

#include <utility>

#include "taut/run.h"
#include "taut/start.h"

namespace taut::viewer {
namespace {

std::optional<ExperimentSpec> ModelAlone(const std::string& path, const Overrides& overrides,
                                         bool settled, Diagnostics& out) {
  auto robot = LoadRobot(path, overrides, out);
  if (!robot) return std::nullopt;
  ExperimentSpec experiment;
  experiment.robot = std::move(*robot);
  experiment.robot.parameters.clear();  // changing them requires reading the file again
  experiment.robot.def.gravity_m_per_s2 = {};
  experiment.name = experiment.robot.def.name;
  experiment.files = experiment.robot.files;
  if (settled) experiment.start = StartKind::kSettledFloating;
  return experiment;
}

}  // namespace

std::optional<LiveInputs> LoadLiveInputs(const std::string& path, const Overrides& overrides,
                                         bool settled, Diagnostics& out) {
  const auto kind = FileKind(path, out);
  if (!kind) return std::nullopt;
  const bool model = *kind == "model";
  std::optional<ExperimentSpec> experiment =
      model ? ModelAlone(path, overrides, settled, out) : LoadExperiment(path, overrides, out);
  if (!experiment || !CheckStart(experiment->robot, experiment->start, out) ||
      !CheckRecord(*experiment, out)) {
    return std::nullopt;
  }
  WarnOfStep(*experiment, out);
  if (settled && !model) experiment->start = StartKind::kSettled;
  return LiveInputs{std::move(*experiment), model};
}

}  // namespace taut::viewer
