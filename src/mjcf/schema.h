/// What of MJCF is read, what is left out and what is refused: the one list of it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mjcf/element.h"

namespace taut::mjcf {

struct Rule {
  const char* element;
  /// Attributes, with blanks between them.
  const char *read, *left_out;
  /// Elements within it; `...`: any, which nobody looks at.
  const char *children, *children_left_out, *children_refused;
};
const std::vector<Rule>& Rules();

bool IsActuator(const std::string& element);

/// How often something was met that is left out: by its name, `geom.rgba`.
using LeftOut = std::map<std::string, int>;

/// Complains about all elements and attributes below `root` that are refused or that nobody knows,
/// counts those that are left out, and warns of those among them that change a force or a place.
void CheckSchema(const Element& root, LeftOut& left_out, Diagnostics& out);

}  // namespace taut::mjcf
