/// Unique names: appends numbers to duplicates.
#pragma once

#include <map>
#include <string>

namespace taut::base {

class UniqueNames {
 public:
  /// Returns `name` if it is free and not empty, otherwise the first free name of name_2, name_3
  /// ...
  std::string Take(const std::string& name) {
    std::string base = name.empty() ? "unnamed" : name;
    const auto [first, fresh] = taken_.try_emplace(base, 1);
    if (fresh) return base;
    std::string free;
    do {
      free = base + "_" + std::to_string(++first->second);
    } while (!taken_.try_emplace(free, 1).second);
    return free;
  }

 private:
  /// Number of uses per name; the search for a free name starts there.
  std::map<std::string, int> taken_;
};

}  // namespace taut::base
