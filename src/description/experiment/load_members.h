/// Members to which load cases apply.
#pragma once

#include <map>
#include <optional>
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

/// Point of a body, in the frame of `NodeDef::position_m`.
struct LoadPoint {
  int body;
  Vec3 at_m;
};

/// Nodes of a robot by place.
class NodePlaces {
 public:
  explicit NodePlaces(const RobotSpec& robot);
  /// Returns the node of the body at a point.
  std::optional<int> At(const LoadPoint& point) const;

 private:
  const RobotSpec& robot_;
  std::map<int, std::vector<int>> nodes_of_body_;
};

/// Returns all cables, bars and rods.
std::vector<LoadMember> AllMembers(const RobotSpec& robot);

/// Returns the ends of a bar or rod, or the attachments of a cable.
std::vector<LoadPoint> PointsOf(const LoadMember& member, const RobotSpec& robot);
const std::string& NameOf(const LoadMember& member, const RobotSpec& robot);

/// Returns the nodes that a selector matches, by their names and tags. Reports a selector without a
/// match. `what`: name of the key in messages.
std::vector<int> SelectNodes(const Value& selector, const std::string& what, const RobotSpec& robot,
                             const Scope& scope);

/// Returns the members that a selector matches: cables and bars by their tags, rods by their names.
/// Reports a selector without a match. `what`: name of the key in messages.
std::vector<LoadMember> SelectMembers(const Value& selector, const std::string& what,
                                      bool with_rods, const RobotSpec& robot, const Scope& scope);

/// Reports a change of length that makes a rest length zero or negative.
void CheckRestLength(const std::string& load_case, const std::string& member, double rest_m,
                     double by_m, const SourceRef& at, const Scope& scope);

}  // namespace taut::description
