/// Arguments that several subcommands take.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::cli {

/// `--set name=value`. Nothing, after a message on stderr, if one is not `name=value`.
std::optional<Overrides> ParseOverrides(const std::vector<std::string>& set);

/// A check of numbers. CLI11's own lets NaN pass and prints 1e-9 as 0.000000.
std::function<std::string(const std::string&)> NumberWithin(double least, double most);

/// A check of names.
std::string CheckName(const std::string& text);

}  // namespace taut::cli
