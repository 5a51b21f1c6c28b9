#include "description/experiment/load_members.h"

#include "description/experiment/experiment_parts.h"
#include "math/vec.h"

namespace taut::description {
namespace {

constexpr double kSameNode_m = 1e-9;

}  // namespace

NodePlaces::NodePlaces(const RobotSpec& robot) : robot_(robot) {
  for (std::size_t i = 0; i < robot.def.nodes.size(); ++i) {
    nodes_of_body_[robot.def.nodes[i].body].push_back(static_cast<int>(i));
  }
}

std::optional<int> NodePlaces::At(const LoadPoint& point) const {
  const auto nodes = nodes_of_body_.find(point.body);
  if (nodes == nodes_of_body_.end()) return std::nullopt;
  for (const int i : nodes->second) {
    const NodeDef& node = robot_.def.nodes[static_cast<std::size_t>(i)];
    if (Length(node.position_m - point.at_m) <= kSameNode_m) return i;
  }
  return std::nullopt;
}

std::vector<LoadMember> AllMembers(const RobotSpec& robot) {
  const ModelDef& def = robot.def;
  std::vector<LoadMember> all;
  for (std::size_t i = 0; i < def.cables.size(); ++i) {
    all.push_back({LoadMember::Kind::kCable, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < def.joints.size(); ++i) {
    if (IsBar(def.joints[i])) all.push_back({LoadMember::Kind::kBar, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < def.capsules.size(); ++i) {
    all.push_back({LoadMember::Kind::kRod, static_cast<int>(i)});
  }
  return all;
}

std::vector<LoadPoint> PointsOf(const LoadMember& member, const RobotSpec& robot) {
  const auto i = static_cast<std::size_t>(member.index);
  if (member.kind == LoadMember::Kind::kBar) {
    const JointDef& bar = robot.def.joints[i];
    return {{bar.body_a, bar.from_m}, {bar.body_b, bar.to_m}};
  }
  if (member.kind == LoadMember::Kind::kRod) {
    const CapsuleDef& rod = robot.def.capsules[i];
    return {{rod.body, rod.from_m}, {rod.body, rod.to_m}};
  }
  std::vector<LoadPoint> points;
  for (const AttachmentDef& one : robot.def.cables[i].attachments) {
    points.push_back({one.body, one.position_m});
  }
  return points;
}

const std::string& NameOf(const LoadMember& member, const RobotSpec& robot) {
  const auto i = static_cast<std::size_t>(member.index);
  if (member.kind == LoadMember::Kind::kBar) return robot.def.joints[i].name;
  return member.kind == LoadMember::Kind::kRod ? robot.def.capsules[i].name
                                               : robot.def.cables[i].name;
}

std::vector<int> SelectNodes(const Value& selector, const std::string& what, const RobotSpec& robot,
                             const Scope& scope) {
  const auto match = ReadMatch(selector, what, scope);
  std::vector<int> found;
  for (std::size_t i = 0; i < robot.node_tags.size() && !match.empty(); ++i) {
    if (Matches(match, robot.node_tags[i])) found.push_back(static_cast<int>(i));
  }
  if (found.empty() && !match.empty()) {
    std::vector<std::string> words;
    for (const auto& tags : robot.node_tags) words.insert(words.end(), tags.begin(), tags.end());
    scope.out.Error("load_case.matches_no_node", selector.at,
                    what + ": no node matches " + Written(selector),
                    UnknownWord(match, words, "node"));
  }
  return found;
}

std::vector<LoadMember> SelectMembers(const Value& selector, const std::string& what,
                                      bool with_rods, const RobotSpec& robot, const Scope& scope) {
  const auto match = ReadMatch(selector, what, scope);
  std::vector<LoadMember> found;
  if (match.empty()) return found;
  const ModelDef& def = robot.def;
  const auto for_each = [&](const auto& look) {
    for (std::size_t i = 0; i < def.cables.size(); ++i) {
      look(LoadMember::Kind::kCable, i, robot.cable_tags[i]);
    }
    for (std::size_t i = 0; i < def.joints.size(); ++i) {
      if (IsBar(def.joints[i])) look(LoadMember::Kind::kBar, i, robot.joint_tags[i]);
    }
    for (std::size_t i = 0; with_rods && i < def.capsules.size(); ++i) {
      look(LoadMember::Kind::kRod, i, Tags{def.capsules[i].name});
    }
  };
  for_each([&](LoadMember::Kind kind, std::size_t i, const Tags& tags) {
    if (Matches(match, tags)) found.push_back({kind, static_cast<int>(i)});
  });
  if (found.empty()) {
    std::vector<std::string> words;
    for_each([&](LoadMember::Kind, std::size_t, const Tags& tags) {
      words.insert(words.end(), tags.begin(), tags.end());
    });
    const std::string kinds = with_rods ? "cable, bar or rod" : "cable or bar";
    scope.out.Error("load_case.matches_no_member", selector.at,
                    what + ": no " + kinds + " matches " + Written(selector),
                    UnknownWord(match, words, kinds));
  }
  return found;
}

void CheckRestLength(const std::string& load_case, const std::string& member, double rest_m,
                     double by_m, const SourceRef& at, const Scope& scope) {
  if (!(rest_m + by_m <= 0)) return;  // NaN: an error was reported before
  scope.out.Error("load_case.no_rest_length", at,
                  "the load case \"" + load_case + "\" makes the rest length of \"" + member +
                      "\" zero or negative (it is " + Shown(rest_m) + " m without the load case)");
}

}  // namespace taut::description
