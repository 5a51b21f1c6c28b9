/// Arguments that several subcommands take.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::cli {

/// `--set name=value`. Nothing, after a message on stderr, if one is not `name=value`.
std::optional<Overrides> ParseOverrides(const std::vector<std::string>& set);

/// A check of numbers. CLI11's own lets NaN pass and prints 1e-9 as 0.000000.
std::function<std::string(const std::string&)> NumberWithin(double least, double most);

/// The same of whole numbers.
std::function<std::string(const std::string&)> WholeNumberWithin(std::uint64_t least,
                                                                 std::uint64_t most);

/// A check of words.
std::function<std::string(const std::string&)> OneOf(std::vector<std::string> words);

/// "index|none|segments": how help texts write a choice.
std::string Alternatives(const std::vector<std::string>& words);

/// A flag whose value is one of some words. `words` must outlive the parser.
template <class T>
CLI::Option* AddChoice(CLI::App& command, const std::string& flag, T& value,
                       const std::map<std::string, T>& words, const std::string& help) {
  std::vector<std::string> names;
  for (const auto& [name, meaning] : words) names.push_back(name);
  const auto choose = [&value, &words](const std::string& word) { value = words.at(word); };
  return command.add_option_function<std::string>(flag, choose, help)
      ->option_text(Alternatives(names))
      ->check(OneOf(names));
}

/// A check of names.
std::string CheckName(const std::string& text);

}  // namespace taut::cli
