/// Units as suffixes of the names of keys and channels.
#pragma once

#include <string>
#include <string_view>

namespace taut::base {

/// For damping_n_s_per_m: "N s" over "m". For weight_per_m: nothing over "m", because a count or an
/// unknown unit precedes "per". Both are empty if a name ends without a unit.
struct NameUnit {
  std::string over, under;

  /// Returns text such as "N s/m"; "1/m" with nothing over it.
  std::string Text() const;
};

/// Returns the unit of a name. The first word names the quantity; the unit consists of all words at
/// the end that are units: kg_per_m ends with m but is not a length.
NameUnit UnitAtEnd(std::string_view name);

}  // namespace taut::base
