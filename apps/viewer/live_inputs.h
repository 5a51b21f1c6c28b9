/// Inputs of a live run from an experiment or a model file.
#pragma once

#include <optional>
#include <string>

#include "taut/spec.h"

namespace taut::viewer {

struct LiveInputs {
  ExperimentSpec experiment;
  bool model =
      false;  ///< A model alone: without weight and ground, paused until the user drags it.
};

/// Starts of a model (message start of web/protocol/messages.json).
enum class ModelStart { kDescribed, kDropped, kSettled };

/// Returns the start of a name in that message; kDescribed for other names.
ModelStart StartOfName(const std::string& name);

/// Returns the experiment of a model with another start: with weight, above a plane if the model
/// has no ground. `alone`: from LoadLiveInputs.
ExperimentSpec StartModel(const ExperimentSpec& alone, ModelStart start);

/// Reads an experiment or a model. Returns nothing, with errors in `out`, if it cannot run.
/// `settled`: the run begins at the settled pose.
std::optional<LiveInputs> LoadLiveInputs(const std::string& path, const Overrides& overrides,
                                         bool settled, Diagnostics& out);

}  // namespace taut::viewer
