/// Reader of resolved experiments, the format that `ResolvedYaml` writes.
#pragma once

#include <optional>
#include <string>

#include "description/yaml/yaml_tree.h"
#include "taut/spec.h"

namespace taut::description {

/// Reads `root`, the content of a file of kind `resolved_experiment`. Does not set the input hash.
/// The format has no parameters, so every override is an error. Returns nothing after any error.
std::optional<ExperimentSpec> ReadResolved(const std::string& path, const Value& root,
                                           const Overrides& overrides, Diagnostics& out);

}  // namespace taut::description
