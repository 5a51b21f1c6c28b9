/// Unique names, made by numbering duplicates.
#pragma once

#include <map>
#include <string>

namespace taut::base {

class UniqueNames {
 public:
  /// Returns `name`, or if it is taken or empty, the first of name_2, name_3 ... that is free.
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
  /// Names and their number of uses, where the search for a free name begins.
  std::map<std::string, int> taken_;
};

}  // namespace taut::base
