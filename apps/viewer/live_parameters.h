/// What sliders may change in a live run.
#pragma once

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

/// Friction, gravity, masses, stiffnesses and dampings; then the parameters of experiment and
/// model, whose range is from nothing to four times their value.
std::vector<LiveParameter> Parameters(const LiveRun& run, const ExperimentSpec& experiment);
std::optional<LiveParameter> FindParameter(const LiveRun& run, const ExperimentSpec& experiment,
                                           const std::string& name);

/// Parameter[] and Control[] of web/protocol/messages.json.
Json ParametersJson(const LiveRun& run, const ExperimentSpec& experiment);
Json ControlsJson(const LiveRun& run);

}  // namespace taut::viewer
