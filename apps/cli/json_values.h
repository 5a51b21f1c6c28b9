/// JSON of values that several commands print.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "taut/types.h"

namespace taut::cli {

inline nlohmann::ordered_json ToJson(const Vec3& v) {
  return nlohmann::ordered_json::array({v.x, v.y, v.z});
}

/// Returns the number as JSON, or null without a value.
inline nlohmann::ordered_json ToJson(const std::optional<double>& x) {
  return x ? nlohmann::ordered_json(*x) : nlohmann::ordered_json();
}

}  // namespace taut::cli
