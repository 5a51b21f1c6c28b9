/// Loader of experiments with a callback that lets other layers add errors about the file.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "taut/spec.h"

namespace taut::description {

/// Loads like `LoadExperiment`. If loading fails, but model and controllers are valid, calls `look`
/// with the readable part. In this part, the names of bodies, cables and controllers are known;
/// numbers may be missing (NaN).
std::optional<ExperimentSpec> LoadPartial(const std::string& path, const Overrides& overrides,
                                          Diagnostics& out,
                                          const std::function<void(const ExperimentSpec&)>& look);

}  // namespace taut::description
