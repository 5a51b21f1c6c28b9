/// Schema of supported MJCF: elements and attributes that are read, left out or refused.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mjcf/element.h"

namespace taut::mjcf {

struct Rule {
  const char* element;
  /// Attributes, separated by blanks.
  const char *read, *left_out;
  /// Child elements; `...`: any, without a check.
  const char *children, *children_left_out, *children_refused;
};
const std::vector<Rule>& Rules();

bool IsActuator(const std::string& element);

/// Number of occurrences of each omitted item, by its name: `geom.rgba`.
using LeftOut = std::map<std::string, int>;

/// Reports errors for all refused or unknown elements and attributes below `root`, counts omitted
/// items, and warns if an omitted item changes a force or a place.
void CheckSchema(const Element& root, LeftOut& left_out, Diagnostics& out);

}  // namespace taut::mjcf
