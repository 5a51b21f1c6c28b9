/// Units as names of keys have them.
#pragma once

#include <string>
#include <string_view>

namespace taut::description {

/// "N s/m" of damping_n_s_per_m, "1/m" of weight_per_m; empty for what has no unit.
std::string UnitOf(std::string_view key);

}  // namespace taut::description
