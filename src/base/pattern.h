/// Patterns of channel names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut::base {

/// `*` stands for any characters, also none and slashes; everything else for itself.
bool Fits(std::string_view pattern, std::string_view name);

/// Any of the patterns; an empty list fits everything.
bool FitsAny(const std::vector<std::string>& patterns, std::string_view name);

/// What the one `*` of `pattern` stands for; "" if the pattern has none and is the name itself.
std::optional<std::string_view> Wildcard(std::string_view pattern, std::string_view name);

}  // namespace taut::base
