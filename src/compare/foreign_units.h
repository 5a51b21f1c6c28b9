/// Units that measurements come in.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut {

/// A unit is `factor` of the unit `si`.
struct ForeignUnit {
  std::string name, si;
  double factor;
};
/// Nothing: not known.
std::optional<ForeignUnit> FindUnit(std::string_view name);
std::vector<std::string> UnitNames();

}  // namespace taut
