// Checks of joint definitions.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/fixed.h"
#include "math/joint_turn.h"
#include "math/vec.h"
#include "sim/compile/checker.h"

namespace taut {

std::set<std::pair<int, int>> KeptApart(const ModelDef& def) {
  std::set<std::pair<int, int>> apart;
  for (const ApartDef& pair : def.apart) apart.insert(std::minmax(pair.body_a, pair.body_b));
  for (const JointDef& j : def.joints) {
    if (!j.collides) apart.insert(std::minmax(j.body_a, j.body_b));
  }
  return apart;
}

}  // namespace taut

namespace taut::sim {
namespace {

using K = JointKind;

std::string Metres(double x) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g m", x);
  return text;
}

void CheckCoordinate(const JointDef& j, const std::string& name, Checker& check) {
  const bool acts = j.friction != 0 || j.stiffness != 0 || j.damping != 0;
  const bool stops = j.least || j.most;
  check.NonNegative(j.friction, name + ": friction");
  check.NonNegative(j.stiffness, name + ": stiffness");
  check.NonNegative(j.damping, name + ": damping");
  check.Require(std::isfinite(j.rest), name + ": where its spring is at rest must be finite");
  check.Require(j.restitution >= 0 && j.restitution <= 1,
                name + ": the stops' restitution must be between 0 and 1");
  for (const auto& stop : {j.least, j.most}) {
    check.Require(!stop || std::isfinite(*stop), name + ": a limit must be finite");
  }
  check.Require(!j.least || !j.most || *j.least < *j.most, name + ": its limits must rise");
  if (!HasCoordinate(j.kind)) {
    check.Require(!acts && !stops,
                  name +
                      ": nothing of it is free along or about its axis: no limits, friction, "
                      "spring or damper");
  }
  if (j.kind == K::kBall) {
    check.Require(j.rest == 0, name + ": a ball joint's spring is at rest as described");
    check.Require(!j.least && (!j.most || *j.most > 0),
                  name + ": a ball joint has one limit, above 0, of the angle to its axis");
  }
  if (j.kind == K::kDistance) {
    const Vec3 d = j.to_m - j.from_m;
    check.Require(Dot(d, d) > 0, name + ": its points are in the same place");
    check.Require((!j.least || *j.least >= 0) && (!j.most || *j.most > 0),
                  name + ": a distance is not negative");
  }
}

}  // namespace

void CheckJoints(const ModelDef& def, Checker& check) {
  const auto known = [&](int body) {
    return body >= kWorld && body < static_cast<int>(def.bodies.size());
  };
  const auto fixed = [&](int body) { return base::IsFixed(def, body); };
  for (const JointDef& j : def.joints) {
    const std::string name = "joint " + j.name;
    check.Body(j.body_a, def, name);
    check.Body(j.body_b, def, name);
    check.Finite(j.from_m, name + ": point");
    check.Finite(j.to_m, name + ": point");
    check.Require(std::fabs(Dot(j.axis, j.axis) - 1) < 1e-9,
                  name + ": the axis must be a unit vector");
    CheckCoordinate(j, name, check);
    check.Member(j.member, name);
    if (!known(j.body_a) || !known(j.body_b)) continue;
    check.Require(j.body_b != kWorld, name + ": its second body must not be the world");
    check.Require(j.body_a != j.body_b, name + ": both of its bodies are the same");
    check.Require(!fixed(j.body_a) || !fixed(j.body_b), name + ": neither of its bodies can move");
    const double gap = HeldGap(j);
    check.Require(!(gap > JointDef::kClosed_m),
                  name + ": its points are " + Metres(gap) + " apart where it holds them together");
    check.Require(!(math::HeldTurn(j) > math::kClosedTurn_rad),
                  name + ": its bodies are turned against each other where it holds them");
  }
  for (const auto& pair : def.apart) {
    check.Body(pair.body_a, def, "bodies that are kept apart");
    check.Body(pair.body_b, def, "bodies that are kept apart");
  }
}

}  // namespace taut::sim
