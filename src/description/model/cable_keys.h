/// The keys of a cable and of what winds it.
#pragma once

#include "description/model/member_keys.h"
#include "description/model/model_text.h"
#include "description/model/motor_keys.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io, Either<ActuatorDef, ActuatorText> Actuator>
void Keys(Io& io, Actuator& a) {
  io.Map("", "builder.cable.actuator",
         "What changes the rest length: ideal, with at least one limit, or a `dc_motor`. Without "
         "an actuator the rest length is fixed.");
  io("kind", a.kind, kActuatorKinds, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io("ideal", a.ideal, "Whether the rest length is what is commanded, at once, without limits.");
  }
  io("max_speed_m_per_s", a.max_speed_m_per_s, kLimit, Bound::kPositive,
     "Greatest speed of the rest length. No limit if absent.");
  io("max_acceleration_m_per_s2", a.max_acceleration_m_per_s2, kLimit, Bound::kPositive,
     "Greatest acceleration of the rest length. No limit if absent.");
  io("max_force_n", a.max_force_n, kLimit, Bound::kPositive,
     "The motor never winds past this tension. No limit if absent.");
  io("min_rest_length_m", a.min_rest_length_m, Bound::kNonNegative, "Least rest length.");
  io("min_length_m", a.min_length_m, Bound::kNonNegative,
     "The motor does not wind in while the cable is shorter than this.");
  io("dc_motor", a.dc_motor);
}
void Check(const MapReader& map, ActuatorText& actuator);

template <class Io, Either<CableDef, CableText> Cable>
void Keys(Io& io, Cable& c) {
  io.Map(
      "cable", "builder.cable",
      "A tension-only spring and damper along a pair: T = k (l - L) + b dl/dt while l > L, never "
      "negative. One of `prestress_n`, `rest_length_m` and `rest_length_ratio` gives the rest "
      "length L at the start.",
      R"({"stiffness_n_per_m": 229.16, "damping_n_s_per_m": 20, "prestress_n": 7})");
  io("name", c.name, kResolvedOnly);
  io("attachments", c.attachments, kResolvedOnly);
  io.OneOf({"prestress_n", "rest_length_m", "rest_length_ratio"});
  io("stiffness_n_per_m", c.stiffness_n_per_m, kInherited, Bound::kPositive,
     "k. If absent, E A / L, of `young_pa` and `area_m2` and the rest length at the start.");
  io("damping_n_s_per_m", c.damping_n_s_per_m, Bound::kNonNegative, "b.");
  io("rest_length_m", c.rest_length_m, Bound::kPositive, "Its rest length.");
  io("damping_law", c.damping_law, kDampingLaws, kInherited,
     "How the damper acts; what the model's `damping_law` says if absent. `exact`: b dl/dt, with "
     "a tension that is never negative. `clamped`: b dl/dt limited to the elastic force, as NTRT "
     "does.");
  io("touches", c.touches, kCableTouches, kLater,
     "What the cable lies against in place of passing through: edges of `terrain`, `rods` of "
     "bodies that move, but for those on which it ends, or `all`. Only from node to node.");
  io("radius_m", c.radius_m, kLater, Bound::kNonNegative, "Half its thickness, with `touches`.");
  io("touch_friction", c.touch_friction, LaterThan{0.0}, Bound::kNonNegative, "mu there.");
  MemberKeys(io, c.member, MemberOf::kCable);
  if constexpr (Io::kResolved) {
    io("actuator", c.actuator);
  } else {
    io.Rule(kStiffnessRule);
    DensityKey(io, c.density_kg_per_m3);
    io("prestress_n", c.prestress_n, Bound::kNonNegative, "Its tension as described, at rest.");
    io("rest_length_ratio", c.rest_length_ratio, Bound::kPositive,
       "Its rest length over its length as described.");
    io("ends", c.ends_on_surface, kCableEnds,
       "Where the cable ends. `node`: at its nodes. `surface`, as NTRT attaches cables: on the "
       "sphere "
       "at its end node, towards the next node; where there is none, on the rod that ends there "
       "(of "
       "several the shortest), at right angles to it.");
    io("actuator", c.actuator_text);
  }
}
void Check(const MapReader& map, CableText& cable);

}  // namespace taut::description
