#include "overrides.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

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

std::function<std::string(const std::string&)> NumberWithin(double least, double most) {
  return [least, most](const std::string& text) {
    double number = 0;
    if (CLI::detail::lexical_cast(text, number) && number >= least && number <= most) {
      return std::string();
    }
    return fmt::format("\"{}\" is not a number from {:g} to {:g}", text, least, most);
  };
}

std::string CheckName(const std::string& text) {
  if (IsName(text)) return {};
  return fmt::format("\"{}\" cannot be a name: letters, digits, _ and -", text);
}

}  // namespace taut::cli
