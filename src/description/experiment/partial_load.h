/// Loading of experiments with a callback, so that other layers can add errors about the file.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "taut/spec.h"

namespace taut::description {

/// Loads like `LoadExperiment`. On failure calls `look` with the readable part, if the model and
/// the controllers are valid: names of bodies, cables and controllers are known, numbers may be
/// missing (NaN).
std::optional<ExperimentSpec> LoadPartial(const std::string& path, const Overrides& overrides,
                                          Diagnostics& out,
                                          const std::function<void(const ExperimentSpec&)>& look);

}  // namespace taut::description
