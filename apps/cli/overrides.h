/// `--set name=value` on the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::cli {

/// Nothing, after a message on stderr, if one is not `name=value`.
std::optional<Overrides> ParseOverrides(const std::vector<std::string>& set);

}  // namespace taut::cli
