// Validation of joint definitions.
#include <algorithm>
#include <cmath>
#include <string>

#include "base/brief.h"
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

std::string Metres(double x) { return base::Brief(x, 3) + " m"; }

void CheckCoordinate(const JointDef& j, const std::string& name, Checker& check) {
  const bool acts = j.friction != 0 || j.stiffness != 0 || j.damping != 0;
  const bool stops = j.least || j.most;
  check.NonNegative(j.friction, name + ": friction");
  check.NonNegative(j.stiffness, name + ": stiffness");
  check.NonNegative(j.damping, name + ": damping");
  check.Require(std::isfinite(j.rest), name + ": the rest position of its spring must be finite");
  check.Require(j.restitution >= 0 && j.restitution <= 1,
                name + ": the restitution at its limits must be between 0 and 1");
  for (const auto& stop : {j.least, j.most}) {
    check.Require(!stop || std::isfinite(*stop), name + ": a limit must be finite");
  }
  check.Require(!j.least || !j.most || *j.least < *j.most,
                name + ": its lower limit must be below its upper limit");
  if (!HasCoordinate(j.kind)) {
    check.Require(!acts && !stops, name +
                                       ": a joint of this kind has no coordinate, so it cannot "
                                       "have limits, friction, spring or damper");
  }
  if (j.kind == K::kBall) {
    check.Require(j.rest == 0,
                  name + ": the spring of a ball joint must be at rest in the described pose");
    check.Require(!j.least && (!j.most || *j.most > 0),
                  name + ": a ball joint can only have an upper limit, which must be above 0");
  }
  if (j.kind == K::kDistance) {
    const Vec3 d = j.to_m - j.from_m;
    check.Require(Dot(d, d) > 0, name + ": its points are at the same position");
    check.Require((!j.least || *j.least >= 0) && (!j.most || *j.most > 0),
                  name + ": the limits of a distance must not be negative");
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
    check.Require(j.body_a != j.body_b, name + ": it connects a body to itself");
    check.Require(!fixed(j.body_a) || !fixed(j.body_b), name + ": both of its bodies are fixed");
    const double gap = JointError(j);
    check.Require(!(gap > JointDef::kClosed_m), name + ": its points are " + Metres(gap) +
                                                    " apart in a direction that the joint locks");
    check.Require(
        !(math::HeldTurn(j) > math::kClosedTurn_rad),
        name + ": its bodies are rotated relative to each other by a turn that it does not allow");
  }
  for (const auto& pair : def.apart) {
    check.Body(pair.body_a, def, "a pair of bodies that do not collide");
    check.Body(pair.body_b, def, "a pair of bodies that do not collide");
  }
}

}  // namespace taut::sim
