/// Patterns of channel names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut::base {

/// Returns true if `pattern` matches `name`. `*` matches any number of characters, including
/// slashes; every other character matches itself.
bool Fits(std::string_view pattern, std::string_view name);

/// Returns true if any of the patterns matches; an empty list matches everything.
bool FitsAny(const std::vector<std::string>& patterns, std::string_view name);

/// Returns the part of `name` that the only `*` of `pattern` matches. Returns "" if the pattern has
/// no `*` and equals the name, and nothing if it does not match.
std::optional<std::string_view> Wildcard(std::string_view pattern, std::string_view name);

}  // namespace taut::base
