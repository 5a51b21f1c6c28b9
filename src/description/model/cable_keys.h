/// Keys of cables and their actuators.
#pragma once

#include "description/model/member_keys.h"
#include "description/model/model_text.h"
#include "description/model/motor_keys.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io, Either<ActuatorDef, ActuatorText> Actuator>
void Keys(Io& io, Actuator& a) {
  io.Map("", "builder.cable.actuator",
         "Actuator that changes the rest length: one with at least one limit, `ideal: true` "
         "(without limits), or a `dc_motor`. Without "
         "an actuator the rest length is fixed.");
  io("kind", a.kind, kActuatorKinds, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io("ideal", a.ideal, "Whether the rest length follows its command at once, without limits.");
  }
  io("max_speed_m_per_s", a.max_speed_m_per_s, kLimit, Bound::kPositive,
     "Largest speed of the rest length. Default: no limit.");
  io("max_acceleration_m_per_s2", a.max_acceleration_m_per_s2, kLimit, Bound::kPositive,
     "Largest acceleration of the rest length. Default: no limit.");
  io("max_force_n", a.max_force_n, kLimit, Bound::kPositive,
     "Tension beyond which the motor does not wind in. Default: no limit.");
  io("min_rest_length_m", a.min_rest_length_m, Bound::kNonNegative, "Smallest rest length.");
  io("min_length_m", a.min_length_m, Bound::kNonNegative,
     "Cable length below which the motor does not wind in.");
  io("dc_motor", a.dc_motor);
}
void Check(const MapReader& map, ActuatorText& actuator);

template <class Io, Either<CableDef, CableText> Cable>
void Keys(Io& io, Cable& c) {
  io.Map("cable", "builder.cable",
         "Cable, a tension-only spring and damper along a pair: T = k (l - L) + b dl/dt while l > "
         "L, never negative. One of `prestress_n`, `rest_length_m` and `rest_length_ratio` sets "
         "the initial rest length L.",
         R"({"stiffness_n_per_m": 229.16, "damping_n_s_per_m": 20, "prestress_n": 7})");
  io("name", c.name, kResolvedOnly);
  io("attachments", c.attachments, kResolvedOnly);
  io.OneOf({"prestress_n", "rest_length_m", "rest_length_ratio"});
  io("stiffness_n_per_m", c.stiffness_n_per_m, kInherited, Bound::kPositive,
     "Stiffness k. Default: E A / L, from `young_pa`, `area_m2` and the initial rest length.");
  io("damping_n_s_per_m", c.damping_n_s_per_m, Bound::kNonNegative, "Damping coefficient b.");
  io("rest_length_m", c.rest_length_m, Bound::kPositive, "Initial rest length L.");
  io("damping_law", c.damping_law, kDampingLaws, kInherited,
     "Damping law. Default: the model's `damping_law`. `exact`: b dl/dt, with a tension that is "
     "never negative. `clamped`: b dl/dt limited to the elastic force, as in NTRT.");
  io("touches", c.touches, kCableTouches, kLater,
     "Cable wrapping: obstacles around which the cable bends instead of passing through them. "
     "`terrain`: "
     "edges of the terrain. `rods`: rods of moving bodies, except those at the cable's ends. "
     "`all`: both. "
     "Only for cables with two nodes.");
  io("radius_m", c.radius_m, kLater, Bound::kNonNegative, "Radius of the cable, with `touches`.");
  io("touch_friction", c.touch_friction, LaterThan{0.0}, Bound::kNonNegative,
     "Coefficient mu of capstan friction, with `touches`.");
  MemberKeys(io, c.member, MemberOf::kCable);
  if constexpr (Io::kResolved) {
    io("actuator", c.actuator);
  } else {
    io.Rule(kStiffnessRule);
    DensityKey(io, c.density_kg_per_m3);
    io("prestress_n", c.prestress_n, Bound::kNonNegative, "Tension at rest in the described pose.");
    io("rest_length_ratio", c.rest_length_ratio, Bound::kPositive,
       "Rest length divided by the length in the described pose.");
    io("ends", c.ends_on_surface, kCableEnds,
       "Ends of the cable. `node`: at its nodes. `surface`, as NTRT attaches cables: on the "
       "surface of the sphere "
       "at the end node, toward the next node. Without a sphere: on the surface of the rod that "
       "ends there (of "
       "several rods, the shortest), at right angles to it.");
    io("actuator", c.actuator_text);
  }
}
void Check(const MapReader& map, CableText& cable);

}  // namespace taut::description
