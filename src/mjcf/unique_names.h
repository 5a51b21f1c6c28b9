/// Names of one kind, each once.
#pragma once

#include <set>
#include <string>

namespace taut::mjcf {

class UniqueNames {
 public:
  /// `name`, or where that is taken or empty, the first of name_2, name_3 ... that is not.
  std::string Take(const std::string& name) {
    const std::string base = name.empty() ? "unnamed" : name;
    std::string taken = base;
    for (int i = 2; !taken_.insert(taken).second; ++i) taken = base + "_" + std::to_string(i);
    return taken;
  }

 private:
  std::set<std::string> taken_;
};

}  // namespace taut::mjcf
