/// Names of the set bits of a number, for messages.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace taut::base {

/// Returns the names of the set bits, such as "over_tension, hot"; empty: none. `names`: in the
/// order of the bits, least significant bit first.
inline std::string BitNames(unsigned bits, std::span<const char* const> names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if ((bits >> i & 1u) != 0) out += (out.empty() ? "" : ", ") + std::string(names[i]);
  }
  return out;
}

}  // namespace taut::base
