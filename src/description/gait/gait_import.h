/// What the importers of NTRT's gaits share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/yaml/reader.h"
#include "taut/gait.h"

namespace taut::description {

inline constexpr double kMetre = 0.01;  // the spines are in centimetres

/// What `FindCouplings` calls the groups of so many roles by index, in the order in which NTRT's
/// scaleEdgeActions fills its table.
std::vector<std::string> IndexGroups(int roles);

/// A controller with feedback; `path` is where the text came from, networks are beside it.
std::optional<GaitSpec> ImportFeedback(const Value& root, const std::string& path,
                                       Diagnostics& out);

}  // namespace taut::description
