/// What `ResolvedYaml` writes, read again.
#pragma once

#include <optional>
#include <string>

#include "taut/spec.h"

namespace taut::description {

/// The experiment of a file of kind `resolved_experiment`, without its input hash. It has no
/// parameters, so every override is an error. Nothing if there was any error.
std::optional<ExperimentSpec> ReadResolved(const std::string& path, const Overrides& overrides,
                                           Diagnostics& out);

}  // namespace taut::description
