/// Keys that only resolved experiments contain: the robot with all numbers evaluated.
#pragma once

#include "description/experiment/experiment_keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<BodyDef> auto& b) {
  io("name", b.name);
  io("mass_kg", b.mass_kg);
  io("com_m", b.com_m);
  io("inertia_kg_m2", b.inertia_kg_m2);
  io("velocity_m_per_s", b.velocity_m_per_s);
  io("angular_velocity_rad_per_s", b.angular_velocity_rad_per_s);
  io("fixed", b.fixed);
}
template <class Io>
void Keys(Io& io, Like<NodeDef> auto& n) {
  io("name", n.name);
  io("body", n.body);
  io("position_m", n.position_m);
}
template <class Io>
void Keys(Io& io, Like<WheelDef> auto& w) {
  io("axis", w.axis);
  io("radius_m", w.radius_m);
  io("counterclockwise", w.counterclockwise);
  io("turns", w.turns);
}
template <class Io>
void Keys(Io& io, Like<AttachmentDef> auto& a) {
  io("body", a.body);
  io("position_m", a.position_m);
  io("friction", a.friction, kLater);
  io("wheel", a.wheel, kLater);
}
template <class Io>
void Keys(Io& io, Like<ApartDef> auto& a) {
  io("body_a", a.body_a);
  io("body_b", a.body_b);
}
template <class Io>
void Keys(Io& io, Like<RobotSpec> auto& r) {
  io("name", r.def.name);
  io("gravity_m_per_s2", r.def.gravity_m_per_s2);
  ContactKeys(io, r.def);
  io("bodies", r.def.bodies);
  io("spheres", r.def.spheres);
  io("capsules", r.def.capsules);
  io("boxes", r.def.boxes);
  io("hulls", r.def.hulls, kLater);
  io("nodes", r.def.nodes);
  io("node_tags", r.node_tags);
  io("cables", r.def.cables);
  io("cable_tags", r.cable_tags);
  io("joints", r.def.joints, kLater);
  io("joint_tags", r.joint_tags, kLater);
  io("apart", r.def.apart, kLater);
  io("motions", r.def.motions, kLater);
  io("planes", r.def.planes);
  io("terrain_boxes", r.def.terrain_boxes);
  io("height_fields", r.def.height_fields, kLater);
  io("terrain_meshes", r.def.terrain_meshes, kLater);
}

}  // namespace taut::description
