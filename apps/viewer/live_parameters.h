/// Parameters of a live run that sliders change.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene.h"
#include "taut/live.h"

namespace taut::viewer {

struct LiveParameter {
  std::string name, unit;
  double value = 0, min = 0, max = 0;
  /// Whether this is a parameter of the files: its change restarts the experiment. Otherwise `kind`
  /// and `index` identify the parameter.
  bool restarts = false;
  Parameter kind = Parameter::kFrictionScale;
  int index = 0;
};

using NamedValues = std::map<std::string, double>;

/// Returns the parameters of experiment and model files.
NamedValues ParametersOfFiles(const ExperimentSpec& experiment);

/// Returns friction, gravity, masses, stiffnesses and dampings; then the parameters of the files,
/// with ranges from zero to four times their `given` values.
std::vector<LiveParameter> Parameters(const LiveRun& run, const ExperimentSpec& experiment,
                                      const NamedValues& given);
std::optional<LiveParameter> FindParameter(const LiveRun& run, const ExperimentSpec& experiment,
                                           const NamedValues& given, const std::string& name);

/// Returns Parameter[] and Control[] of web/protocol/messages.json.
Json ParametersJson(const LiveRun& run, const ExperimentSpec& experiment, const NamedValues& given);
Json ControlsJson(const LiveRun& run);

}  // namespace taut::viewer
