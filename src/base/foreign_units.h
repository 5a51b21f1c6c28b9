/// Units of measured data and of model files, and their conversion to SI.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut::base {

/// One unit equals `factor` times the unit `si`.
struct ForeignUnit {
  std::string name, si;
  double factor;
};
/// Returns the unit with this name; nothing if unknown.
std::optional<ForeignUnit> FindUnit(std::string_view name);
const std::vector<ForeignUnit>& Units();
std::vector<std::string> UnitNames();

}  // namespace taut::base
