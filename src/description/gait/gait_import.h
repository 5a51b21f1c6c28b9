/// Functions shared by the importers of NTRT gaits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/yaml/reader.h"
#include "taut/gait.h"

namespace taut::description {

inline constexpr double kMetre = 0.01;  // NTRT's spines are in centimeters

/// Returns the names of the coupling groups for `roles` roles, as in `FindCouplings`, in the order
/// of NTRT's scaleEdgeActions.
std::vector<std::string> IndexGroups(int roles);

/// Imports a controller with feedback. `path`: the JSON file. Its neural networks must be in the
/// same folder.
std::optional<GaitSpec> ImportFeedback(const Value& root, const std::string& path,
                                       Diagnostics& out);

}  // namespace taut::description
