/// Numbers and lists as text for messages.
#pragma once

#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut::fit {

/// Returns four significant digits, with the unit if there is one.
std::string Brief(double x, const std::string& unit = {});
/// Returns a change with its sign and unit.
std::string Change(double x, const std::string& unit);
/// Returns "a", "a and b", or "a, b and c".
std::string List(const std::vector<std::string>& names);

}  // namespace taut::fit
