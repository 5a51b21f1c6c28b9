/// The keys of a joint.
#pragma once

#include "description/model/member_keys.h"
#include "description/model/model_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

/// A key whose unit follows what a joint's coordinate is.
constexpr Spellings Coordinate(const char* of_angle, const char* of_length) {
  return {{of_angle, of_length},
          {"a joint of the kind hinge or ball",
           "a joint of the kind prismatic, cylindrical, line or distance"}};
}
inline const char* WhoHas(JointKind kind) {
  return IsAngle(kind) ? "a joint whose coordinate is an angle"
                       : "a joint whose coordinate is a length";
}

template <class Io, Either<JointDef, JointText> Joint>
void Keys(Io& io, Joint& j) {
  io.Map(
      "", "builder.joint",
      "What of the motion of one body against another is held, and what acts on the rest. "
      "`joint` goes on a pair: between the bodies a and b of its two nodes. `support` goes on a "
      "node: the world is a. What is free is measured by one coordinate: the angle of a hinge; "
      "how far b's node has slid along the axis, of prismatic, cylindrical and line; the length "
      "of a distance; of a ball, how far its axis in b is turned from that in a. Friction, spring "
      "and damper of a ball act on all of its turns, about every axis alike.",
      R"({"kind": "hinge", "axis": [0, 1, 0], "least_rad": -0.5, "most_rad": 1.2})");
  io("name", j.name, kResolvedOnly);
  io("body_a", j.body_a, kResolvedOnly);
  io("body_b", j.body_b, kResolvedOnly);
  io("from_m", j.from_m, kResolvedOnly);
  io("to_m", j.to_m, kResolvedOnly);
  io("turned", j.turned,
     "How b is turned against a as described, about axes as that of `axis`, from the pose where "
     "the "
     "joint's angle is 0. If absent, angles are 0 as described. It is what a model has that taut "
     "writes of a robot in a pose that it has come to.");
  io("kind", j.kind, kJointKinds, kNeeded,
     "What it leaves free. `ball`: all turns. `hinge`: turns about the axis. `weld`: nothing. "
     "`prismatic`: sliding along the axis. `cylindrical`: both. `planar`: sliding across the axis "
     "and turns about it. `line`: all turns, and b's node slides along the axis. `plane`: all "
     "turns, and b's node slides across the axis. `distance`: all but the distance of the nodes.");
  io.SpeltBy("kind", {IsAngle(j.kind) ? 0 : 1, WhoHas(j.kind)});
  io("axis", j.axis, kDirection,
     "The axis as described: in the part's frame of the pair or node, in the world's if its nodes "
     "are in several parts.");
  io(Coordinate("least_rad", "least_m"), j.least,
     "Where its coordinate stops downwards. Angles are 0 in the pose that is described, and "
     "turns of a hinge count on; a slide is that from a's node to b's. Not of a ball.");
  io(Coordinate("most_rad", "most_m"), j.most, "Where its coordinate stops upwards.");
  io("restitution", j.restitution, Bound::kFraction,
     "Of the stops: how much of the speed comes back.");
  io(Coordinate("friction_n_m", "friction_n"), j.friction, Bound::kNonNegative,
     "Dry friction: up to this it sticks, and slides against it.");
  io(Coordinate("stiffness_n_m_per_rad", "stiffness_n_per_m"), j.stiffness, Bound::kNonNegative,
     "Of a spring. That of a ball turns b back to how it is described, the shorter way. A "
     "distance with a spring or a stop does not hold its length.");
  io(Coordinate("damping_n_m_s_per_rad", "damping_n_s_per_m"), j.damping, Bound::kNonNegative,
     "Of a damper.");
  io(Coordinate("rest_rad", "rest_m"), j.rest, "Where the spring is at rest. Not of a ball.");
  io("collides", j.collides, "Whether its bodies touch each other.");
  if constexpr (Io::kResolved) MemberKeys(io, j.member, MemberOf::kBar);
}

void Check(const MapReader& map, JointText& joint);

template <class Io>
void Keys(Io& io, Like<PinText> auto& p) {
  io.Map("", "builder.rod.pins",
         "What acts on the turns of a rod of class k in the ball joints at its nodes, about every "
         "axis alike.",
         R"({"friction_n_m": 0.01})");
  io("friction_n_m", p.friction, Bound::kNonNegative,
     "Dry friction: up to this they stick, and slide against it.");
  io("stiffness_n_m_per_rad", p.stiffness, Bound::kNonNegative,
     "Of a spring that turns the rod back to how it is described, the shorter way.");
  io("damping_n_m_s_per_rad", p.damping, Bound::kNonNegative, "Of a damper.");
}

}  // namespace taut::description
