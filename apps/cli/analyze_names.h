/// Names and phrases in the output of `taut analyze`.
#pragma once

#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/safety.h"

namespace taut::cli {

inline std::string BodyName(const ModelDef& def, int body) {
  return body < 0 ? "world" : def.bodies[static_cast<std::size_t>(body)].name;
}

/// Returns the member's name, with the number of its part if it has several.
inline std::string StaticMemberName(const ModelDef& def, const StaticMember& member) {
  const auto at = static_cast<std::size_t>(member.index);
  const std::string part = " " + std::to_string(member.part + 1);
  switch (member.kind) {
    case StaticMember::Kind::kCable:
      return def.cables[at].name + (HasFriction(def.cables[at]) ? part : "");
    case StaticMember::Kind::kBar:
      return def.joints[at].name;
    case StaticMember::Kind::kHeld:
      return def.joints[at].name + part;
    case StaticMember::Kind::kContact:
      return BodyName(def, member.part) + " on " + def.planes[at].name;
  }
  return "";
}

/// Describes how an equilibrium was found; empty for a plain Newton solve.
inline const char* WayText(EquilibriumWay way) {
  switch (way) {
    case EquilibriumWay::kNewton:
      return "";
    case EquilibriumWay::kLoadSteps:
      return ", loads in steps";
    case EquilibriumWay::kRelaxation:
      return ", by relaxation";
  }
  return "";
}

/// Returns the body with the largest displacement of its center of mass; if none moves, the largest
/// rotation; -1: none.
inline int MovesMost(const Mode& mode) {
  for (const std::vector<Vec3>* const way : {&mode.translation_m, &mode.turn_rad}) {
    int most = -1;
    double largest = 1e-18;  // square of a displacement above round-off
    for (std::size_t b = 0; b < way->size(); ++b) {
      const Vec3& t = (*way)[b];
      const double size = t.x * t.x + t.y * t.y + t.z * t.z;
      if (size > largest) largest = size, most = static_cast<int>(b);
    }
    if (most >= 0) return most;
  }
  return -1;
}

}  // namespace taut::cli
