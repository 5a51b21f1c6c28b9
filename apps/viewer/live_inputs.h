/// From a file to what a live run shows.
#pragma once

#include <optional>
#include <string>

#include "taut/spec.h"

namespace taut::viewer {

struct LiveInputs {
  ExperimentSpec experiment;
  bool model = false;  ///< A model by itself, without weight and ground; it waits to be dragged.
};

/// Reads an experiment or a model. Nothing and diagnostics if it cannot be run. `settled`: it
/// begins at rest, where the robot settles.
std::optional<LiveInputs> LoadLiveInputs(const std::string& path, const Overrides& overrides,
                                         bool settled, Diagnostics& out);

}  // namespace taut::viewer
