/// Selection of tunables (numbers of a model or gait that may be changed) by patterns of names.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "description/yaml/reader.h"
#include "taut/study.h"

namespace taut::description {

/// Returns the indices of the tunables whose names match. Returns an empty list after an error.
std::vector<std::size_t> MatchTunables(const Value& value, const std::string& what,
                                       const std::vector<Tunable>& tunables, const Scope& scope);

}  // namespace taut::description
