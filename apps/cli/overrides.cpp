#include "overrides.h"

#include <fmt/format.h>

#include <cstdio>

namespace taut::cli {

std::optional<Overrides> ParseOverrides(const std::vector<std::string>& set) {
  Overrides overrides;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      fmt::print(stderr, "error: --set {}: expected name=value, such as --set push_n=15\n", text);
      return std::nullopt;
    }
    overrides.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return overrides;
}

}  // namespace taut::cli
