/// Texts of numbers and lists for messages.
#pragma once

#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut::fit {

/// Returns a number with four significant digits, and its unit if there is one.
std::string Brief(double x, const std::string& unit = {});
/// Returns a change with sign and unit.
std::string Change(double x, const std::string& unit);
/// Returns "a", "a and b", or "a, b and c".
std::string List(const std::vector<std::string>& names);

}  // namespace taut::fit
