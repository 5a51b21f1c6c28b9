/// Units as suffixes of the names of keys and channels.
#pragma once

#include <string>
#include <string_view>

namespace taut::base {

/// Unit at the end of a name, as numerator and denominator. damping_n_s_per_m: "N s" and "m".
/// weight_per_m: "" and "m", because "weight" is no unit. Both texts are empty if the name ends
/// without a unit.
struct NameUnit {
  std::string over, under;

  /// Returns a text such as "N s/m", or "1/m" without a numerator.
  std::string Text() const;
};

/// Returns the unit of a name. The first word names the quantity; the unit consists of all unit
/// words at the end. Therefore kg_per_m is a mass per length, although it ends with m.
NameUnit UnitAtEnd(std::string_view name);

}  // namespace taut::base
