/// Complaints that other layers have about an experiment file, beside the file's own.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "taut/spec.h"

namespace taut::description {

/// `LoadExperiment`. If it fails, `look` gets what could be read, once the model and the
/// controllers are good: names of bodies, cables and controllers are known, numbers may be missing
/// (NaN).
std::optional<ExperimentSpec> LoadOrLook(const std::string& path, const Overrides& overrides,
                                         Diagnostics& out,
                                         const std::function<void(const ExperimentSpec&)>& look);

}  // namespace taut::description
