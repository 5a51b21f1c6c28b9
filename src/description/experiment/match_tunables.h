/// From patterns in a file to what of a model and a gait may be changed by name.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "description/yaml/reader.h"
#include "taut/study.h"

namespace taut::description {

/// Which tunables patterns stand for. Empty after a complaint.
std::vector<std::size_t> MatchTunables(const Value& value, const std::string& what,
                                       const std::vector<Tunable>& tunables, const Scope& scope);

}  // namespace taut::description
