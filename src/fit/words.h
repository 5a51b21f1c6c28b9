/// Numbers and lists in sentences for a reader.
#pragma once

#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut::fit {

/// Four digits, with the unit, if there is one.
std::string Brief(double x, const std::string& unit = {});
/// With a sign, for a change.
std::string Change(double x, const std::string& unit);
/// "a", "a and b", "a, b and c".
std::string List(const std::vector<std::string>& names);

}  // namespace taut::fit
