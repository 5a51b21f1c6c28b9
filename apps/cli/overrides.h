/// Arguments and validators common to several subcommands.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::cli {

/// Parses `--set name=value`. Returns nothing, after a message on stderr, if an argument has
/// another form.
std::optional<Overrides> ParseOverrides(const std::vector<std::string>& set);

/// Returns the words of a command, with `--set` for each of `set`.
std::vector<std::string> WithOverrides(std::vector<std::string> words,
                                       const std::vector<std::string>& set);

/// Returns a validator for numbers. The validator of CLI11 accepts NaN and prints 1e-9 as 0.000000.
std::function<std::string(const std::string&)> NumberWithin(double least, double most);

/// Returns a validator for integers, like `NumberWithin`.
std::function<std::string(const std::string&)> WholeNumberWithin(std::uint64_t least,
                                                                 std::uint64_t most);

/// Returns a validator for a choice of words.
std::function<std::string(const std::string&)> OneOf(std::vector<std::string> words);

/// Returns a choice in the form of help texts: "index|none|segments".
std::string Alternatives(const std::vector<std::string>& words);

/// Adds a flag whose value is one of the words. `words` must outlive the parser.
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

/// Validates a name; returns an error message, or an empty string.
std::string CheckName(const std::string& text);

}  // namespace taut::cli
