/// Keys of joints.
#pragma once

#include "description/model/member_keys.h"
#include "description/model/model_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

/// Returns the two spellings of a key, which have the unit of the joint's coordinate: angle or
/// length.
constexpr Spellings Coordinate(const char* of_angle, const char* of_length) {
  return {{of_angle, of_length},
          {"hinge and ball joints", "prismatic, cylindrical, line and distance joints"}};
}
inline const char* WhoHas(JointKind kind) {
  return IsAngle(kind) ? "a joint whose coordinate is an angle"
                       : "a joint whose coordinate is a length";
}

template <class Io, Either<JointDef, JointText> Joint>
void Keys(Io& io, Joint& j) {
  io.Map(
      "", "builder.joint",
      "Joint that constrains the motion of body b relative to body a or, for a `support`, to the "
      "world. Springs, dampers and friction act on the free "
      "motion. `joint` is for a pair: between the bodies a and b of its two nodes. `support` is "
      "for a node: body a is the world. One coordinate measures the free motion. `hinge`: its "
      "angle. "
      "`prismatic`, `cylindrical` and "
      "`line`: the displacement of b's node along the axis. `distance`: its "
      "length. `ball`: the angle between the axis in b and the axis in a. Friction, spring and "
      "damper of a ball joint are equal about all axes.",
      R"({"kind": "hinge", "axis": [0, 1, 0], "least_rad": -0.5, "most_rad": 1.2})");
  io("name", j.name, kResolvedOnly);
  io("body_a", j.body_a, kResolvedOnly);
  io("body_b", j.body_b, kResolvedOnly);
  io("from_m", j.from_m, kResolvedOnly);
  io("to_m", j.to_m, kResolvedOnly);
  io("turned", j.turned,
     "Rotation of b relative to a in the described pose, from the pose with joint angle 0, about "
     "axes in the frame of `axis`. Default: angles are 0 in the described pose. taut writes this "
     "key when it writes a model in another pose, such as with `taut run --final_pose`.");
  io("kind", j.kind, kJointKinds, kNeeded,
     "Free motion. `ball`: all rotations. `hinge`: rotation about the axis. `weld`: none. "
     "`prismatic`: translation along the axis. `cylindrical`: rotation about the axis and "
     "translation along it. `planar`: translation across the axis and rotation about it. `line`: "
     "all rotations, and b's node moves along the axis. `plane`: all rotations, and b's node moves "
     "across the axis. `distance`: all motions that keep the distance of the nodes.");
  io.SpeltBy("kind", {IsAngle(j.kind) ? 0 : 1, WhoHas(j.kind)});
  io("axis", j.axis, kDirection,
     "Axis in the described pose: in the part's frame of the pair or node, or in the world frame "
     "if the nodes are in several parts.");
  io(Coordinate("least_rad", "least_m"), j.least,
     "Lower joint limit of the coordinate. Angles are 0 in the described pose, and a hinge counts "
     "whole turns; displacements are measured from a's node to b's node. A ball has no lower "
     "limit.");
  io(Coordinate("most_rad", "most_m"), j.most, "Upper joint limit of the coordinate.");
  io("restitution", j.restitution, Bound::kFraction,
     "Coefficient of restitution at the joint limits.");
  io(Coordinate("friction_n_m", "friction_n"), j.friction, Bound::kNonNegative,
     "Dry friction: the joint sticks below this value and, while sliding, resists with this "
     "value.");
  io(Coordinate("stiffness_n_m_per_rad", "stiffness_n_per_m"), j.stiffness, Bound::kNonNegative,
     "Stiffness of a spring. The spring of a ball rotates b back to the described pose, along the "
     "shorter rotation. "
     "A `distance` joint with a spring or a limit does not fix the distance.");
  io(Coordinate("damping_n_m_s_per_rad", "damping_n_s_per_m"), j.damping, Bound::kNonNegative,
     "Damping coefficient.");
  io(Coordinate("rest_rad", "rest_m"), j.rest,
     "Coordinate at which the spring exerts no force. Not allowed for a ball joint.");
  io("collides", j.collides, "Whether the joint's bodies collide with each other.");
  if constexpr (Io::kResolved) MemberKeys(io, j.member, MemberOf::kBar);
}

void Check(const MapReader& map, JointText& joint);

template <class Io>
void Keys(Io& io, Like<PinText> auto& p) {
  io.Map("", "builder.rod.pins",
         "Friction, spring and damper in the ball joints at the nodes of a class-k rod, equal "
         "about all axes.",
         R"({"friction_n_m": 0.01})");
  io("friction_n_m", p.friction, Bound::kNonNegative,
     "Dry friction: a joint sticks below this torque, and a sliding joint resists with this "
     "torque.");
  io("stiffness_n_m_per_rad", p.stiffness, Bound::kNonNegative,
     "Stiffness of a spring that rotates the rod back to the described pose, along the shorter "
     "rotation.");
  io("damping_n_m_s_per_rad", p.damping, Bound::kNonNegative, "Damping coefficient.");
}

}  // namespace taut::description
