#include "overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <utility>

namespace taut::cli {

std::vector<std::string> WithOverrides(std::vector<std::string> words,
                                       const std::vector<std::string>& set) {
  for (const std::string& one : set) words.insert(words.end(), {"--set", one});
  return words;
}

std::optional<Overrides> ParseOverrides(const std::vector<std::string>& set) {
  Overrides overrides;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      fmt::print(stderr, "error: --set {}: expected name=value, such as --set push_n=15\n",
                 Printable(text));
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

std::function<std::string(const std::string&)> WholeNumberWithin(std::uint64_t least,
                                                                 std::uint64_t most) {
  return [least, most](const std::string& text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc() && end == text.data() + text.size() && number >= least &&
        number <= most) {
      return std::string();
    }
    return fmt::format("\"{}\" is not a whole number from {} to {}", text, least, most);
  };
}

std::function<std::string(const std::string&)> OneOf(std::vector<std::string> words) {
  return [words = std::move(words)](const std::string& text) {
    if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
    return fmt::format("\"{}\" is unknown ({})", text, DidYouMean(text, words));
  };
}

std::string Alternatives(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, "|"));
}

std::string CheckName(const std::string& text) {
  if (!IsName(text)) {
    return fmt::format("\"{}\" is not a valid name (expected letters, digits, _ or -)", text);
  }
  if (text.front() == '-') {
    return fmt::format("\"{}\" is not a valid name here (a command would read it as a flag)", text);
  }
  if (text == "null" || text == "Null" || text == "NULL") {
    return fmt::format("\"{}\" is not a valid name here (YAML reads it as a missing value)", text);
  }
  return {};
}

}  // namespace taut::cli
