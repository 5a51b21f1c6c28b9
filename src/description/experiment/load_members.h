/// Members to which load cases apply.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/reader.h"
#include "taut/spec.h"

namespace taut::description {

/// Cable, bar (joint) or rod (capsule) of a robot.
struct LoadMember {
  enum class Kind { kCable, kBar, kRod };
  Kind kind;
  int index;
  bool operator<(const LoadMember& other) const {
    return kind != other.kind ? kind < other.kind : index < other.index;
  }
};

/// Returns the members that a selector matches: cables and bars by their tags, rods by their names.
/// Reports a selector without a match. `what`: name of the key in messages.
std::vector<LoadMember> SelectMembers(const Value& selector, const std::string& what,
                                      bool with_rods, const RobotSpec& robot, const Scope& scope);

/// Reports a change of length that makes a rest length zero or negative.
void CheckRestLength(const std::string& load_case, const std::string& member, double rest_m,
                     double by_m, const SourceRef& at, const Scope& scope);

}  // namespace taut::description
