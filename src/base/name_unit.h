/// Units as names of keys and channels end with them.
#pragma once

#include <string>
#include <string_view>

namespace taut::base {

/// "N s" over "m" of damping_n_s_per_m. Nothing over "m" of weight_per_m, where what is counted or
/// a unit that is not known stands before "per". Both are empty if a name ends with no unit.
struct NameUnit {
  std::string over, under;

  /// "N s/m"; "1/m" where nothing is over it.
  std::string Text() const;
};

/// The first word of a name says what is measured. A unit is all the words at the end that are of
/// one: kg_per_m ends with m and is no m.
NameUnit UnitAtEnd(std::string_view name);

}  // namespace taut::base
