#include "description/experiment/load_members.h"

#include "description/experiment/experiment_parts.h"

namespace taut::description {

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
