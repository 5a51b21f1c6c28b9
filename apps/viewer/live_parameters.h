/// What sliders may change in a live run.
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
  /// A parameter of the files: a change starts the experiment anew. Else `kind` and `index`.
  bool restarts = false;
  Parameter kind = Parameter::kFrictionScale;
  int index = 0;
};

using NamedValues = std::map<std::string, double>;

/// The parameters of experiment and model.
NamedValues ParametersOfFiles(const ExperimentSpec& experiment);

/// Friction, gravity, masses, stiffnesses and dampings; then the parameters of the files, whose
/// range is from nothing to four times the value that they had when they were `given`.
std::vector<LiveParameter> Parameters(const LiveRun& run, const ExperimentSpec& experiment,
                                      const NamedValues& given);
std::optional<LiveParameter> FindParameter(const LiveRun& run, const ExperimentSpec& experiment,
                                           const NamedValues& given, const std::string& name);

/// Parameter[] and Control[] of web/protocol/messages.json.
Json ParametersJson(const LiveRun& run, const ExperimentSpec& experiment, const NamedValues& given);
Json ControlsJson(const LiveRun& run);

}  // namespace taut::viewer
