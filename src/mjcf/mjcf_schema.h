/// Schema of supported MJCF: elements and attributes that are read, omitted or rejected.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mjcf/element.h"

namespace taut::mjcf {

struct Rule {
  const char* element;
  /// Names of attributes, separated by blanks.
  const char *read, *left_out;
  /// Names of child elements; `...`: any, unchecked.
  const char *children, *children_left_out, *children_refused;
};
const std::vector<Rule>& Rules();

bool IsActuator(const std::string& element);

/// Number of occurrences of each omitted item, by name: `geom.rgba`.
using LeftOut = std::map<std::string, int>;

/// Reports an error for each rejected or unknown element and attribute below `root`. Counts omitted
/// items. Warns if an omitted item affects a force or a position.
void CheckSchema(const Element& root, LeftOut& left_out, Diagnostics& out);

}  // namespace taut::mjcf
