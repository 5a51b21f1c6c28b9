/// What is in a resolved experiment: one list of fields a struct, for writing and for reading.
#pragma once

#include <concepts>
#include <type_traits>

#include "description/experiment_parts.h"
#include "description/gait_parts.h"
#include "description/laws.h"
#include "taut/spec.h"

namespace taut::description {

inline const Choices<ActuatorDef::Kind> kActuatorKinds{{"none", ActuatorDef::Kind::kNone},
                                                       {"ideal", ActuatorDef::Kind::kIdeal},
                                                       {"limited", ActuatorDef::Kind::kLimited}};
inline const Choices<TensionConversion> kConversions{{"stiffness", TensionConversion::kStiffness},
                                                     {"pid", TensionConversion::kPid}};
inline const Choices<StartKind> kStarts{{"as_described", StartKind::kAsDescribed},
                                        {"settled", StartKind::kSettled},
                                        {"settled_floating", StartKind::kSettledFloating}};
inline const Choices<ScaleSpec::Quantity> kScaledQuantities{
    {"friction", ScaleSpec::Quantity::kFriction},
    {"mass", ScaleSpec::Quantity::kMass},
    {"stiffness", ScaleSpec::Quantity::kStiffness},
    {"damping", ScaleSpec::Quantity::kDamping}};

// One list of fields a struct, for writing and for reading: `io` is called with each key and
// field, and with the choices of an enumeration.
template <class T, class U>
concept Like = std::same_as<std::remove_const_t<T>, U>;

template <class Io>
void Fields(Io& io, Like<Material> auto& m) {
  io("static_friction", m.static_friction);
  io("kinetic_friction", m.kinetic_friction);
  io("restitution", m.restitution);
}
template <class Io>
void Fields(Io& io, Like<BodyDef> auto& b) {
  io("name", b.name);
  io("mass_kg", b.mass_kg);
  io("com_m", b.com_m);
  io("inertia_kg_m2", b.inertia_kg_m2);
  io("velocity_m_per_s", b.velocity_m_per_s);
  io("angular_velocity_rad_per_s", b.angular_velocity_rad_per_s);
  io("fixed", b.fixed);
}
template <class Io>
void Fields(Io& io, Like<SphereDef> auto& s) {
  io("name", s.name);
  io("body", s.body);
  io("center_m", s.center_m);
  io("radius_m", s.radius_m);
  io("material", s.material);
  io("collides", s.collides);
}
template <class Io>
void Fields(Io& io, Like<CapsuleDef> auto& c) {
  io("name", c.name);
  io("body", c.body);
  io("from_m", c.from_m);
  io("to_m", c.to_m);
  io("radius_m", c.radius_m);
  io("material", c.material);
  io("collides", c.collides);
}
template <class Io>
void Fields(Io& io, Like<BoxDef> auto& b) {
  io("name", b.name);
  io("body", b.body);
  io("center_m", b.center_m);
  io("orientation", b.orientation);
  io("half_extents_m", b.half_extents_m);
  io("material", b.material);
  io("collides", b.collides);
}
template <class Io>
void Fields(Io& io, Like<NodeDef> auto& n) {
  io("name", n.name);
  io("body", n.body);
  io("position_m", n.position_m);
}
template <class Io>
void Fields(Io& io, Like<AttachmentDef> auto& a) {
  io("body", a.body);
  io("position_m", a.position_m);
}
template <class Io>
void Fields(Io& io, Like<ActuatorDef> auto& a) {
  io("kind", a.kind, kActuatorKinds);
  io.Limit("max_speed_m_per_s", a.max_speed_m_per_s);
  io.Limit("max_acceleration_m_per_s2", a.max_acceleration_m_per_s2);
  io.Limit("max_force_n", a.max_force_n);
  io("min_rest_length_m", a.min_rest_length_m);
  io("min_length_m", a.min_length_m);
}
template <class Io>
void Fields(Io& io, Like<CableDef> auto& c) {
  io("name", c.name);
  io("attachments", c.attachments);
  io("stiffness_n_per_m", c.stiffness_n_per_m);
  io("damping_n_s_per_m", c.damping_n_s_per_m);
  io("rest_length_m", c.rest_length_m);
  io("damping_law", c.damping_law, kDampingLaws);
  io("actuator", c.actuator);
}
template <class Io>
void Fields(Io& io, Like<PlaneDef> auto& p) {
  io("name", p.name);
  io("normal", p.normal);
  io("point_m", p.point_m);
  io("material", p.material);
}
template <class Io>
void Fields(Io& io, Like<TerrainBoxDef> auto& b) {
  io("name", b.name);
  io("center_m", b.center_m);
  io("orientation", b.orientation);
  io("half_extents_m", b.half_extents_m);
  io("material", b.material);
}
template <class Io>
void Fields(Io& io, Like<RobotSpec> auto& r) {
  io("name", r.def.name);
  io("gravity_m_per_s2", r.def.gravity_m_per_s2);
  io("friction_combine", r.def.friction_combine, kCombineRules);
  io("restitution_combine", r.def.restitution_combine, kCombineRules);
  io("friction_law", r.def.friction_law, kFrictionLaws);
  io("bodies", r.def.bodies);
  io("spheres", r.def.spheres);
  io("capsules", r.def.capsules);
  io("boxes", r.def.boxes);
  io("nodes", r.def.nodes);
  io("node_tags", r.node_tags);
  io("cables", r.def.cables);
  io("cable_tags", r.cable_tags);
  io("planes", r.def.planes);
  io("terrain_boxes", r.def.terrain_boxes);
}
template <class Io>
void Fields(Io& io, Like<ImpedanceGains> auto& g) {
  io("cable", g.cable);
  io("tension_offset_n", g.tension_offset_n);
  io("length_offset_m", g.length_offset_m);
  io("position_gain_n_per_m", g.position_gain_n_per_m);
  io("velocity_gain_n_s_per_m", g.velocity_gain_n_s_per_m);
  io("velocity_offset_m_per_s", g.velocity_offset_m_per_s);
}
template <class Io>
void Fields(Io& io, Like<PidGains> auto& p) {
  io("proportional_m_per_s_n", p.proportional_m_per_s_n);
  io("integral_m_per_s2_n", p.integral_m_per_s2_n);
  io("derivative_m_per_n", p.derivative_m_per_n);
}
template <class Io>
void Fields(Io& io, Like<ImpedanceSpec> auto& i) {
  io("conversion", i.conversion, kConversions);
  io("pid", i.pid);
  io("differenced_rate", i.differenced_rate);
  io("start_from_rest_length", i.start_from_rest_length);
  io("cables", i.cables);
}
template <class Io>
void Fields(Io& io, Like<PositionProgram> auto& p) {
  io("cable", p.cable);
  io("rest_length_m", p.rest_length_m);
}
template <class Io>
void Fields(Io& io, Like<SineWave> auto& w) {
  io("name", w.name);
  io("cables", w.cables);
  io("amplitude_m_per_s", w.amplitude_m_per_s);
  io("phase_rad", w.phase_rad);
  io("offset_m_per_s", w.offset_m_per_s);
  io("phase_per_segment_rad", w.phase_per_segment_rad);
  io("frequency_hz", w.frequency_hz);
}
template <class Io>
void Fields(Io& io, Like<SineGait> auto& s) {
  io("frequency_hz", s.frequency_hz);
  io("waves", s.waves);
}
template <class Io>
void Fields(Io& io, Like<CouplingGroup> auto& g) {
  io("name", g.name);
  io("weight_per_m", g.weight_per_m);
  io("phase_rad", g.phase_rad);
}
template <class Io>
void Fields(Io& io, Like<CpgFeedback> auto& f) {
  io("gain_rad_per_n_s", f.gain_rad_per_n_s);
  io("reference_n", f.reference_n);
}
template <class Io>
void Fields(Io& io, Like<CpgGait> auto& c) {
  io("frequency_hz", c.frequency_hz);
  io("amplitude_m_per_s", c.amplitude_m_per_s);
  io("convergence_per_s", c.convergence_per_s);
  io("integrator_step_s", c.integrator_step_s);
  io("symmetry", c.symmetry, kSymmetries);
  io("order", c.order);
  io("inverted", c.inverted);
  io("feedback", c.feedback);
  io("groups", c.groups);
}
template <class Io>
void Fields(Io& io, Like<TableGait> auto& t) {
  io("cables", t.cables);
  io("time_s", t.time_s);
  io("rows", t.rows);
  io("linear", t.linear);
  io("repeat_from_s", t.repeat_from_s);
}
template <class Io>
void Fields(Io& io, Like<GaitSpec> auto& g) {
  io("name", g.name);
  io("description", g.description);
  io("sine", g.sine);
  io("cpg", g.cpg);
  io("table", g.table);
}
template <class Io>
void Fields(Io& io, Like<VelocityInputSpec> auto& v) {
  io("period_s", v.clock.period_s);
  io("phase_s", v.clock.phase_s);
  io("gait", v.gait);
}
template <class Io>
void Fields(Io& io, Like<ControllerSpec> auto& c) {
  io("name", c.name);
  io("period_s", c.clock.period_s);
  io("phase_s", c.clock.phase_s);
  io("impedance", c.impedance);
  io("position", c.position);
  io("velocity_input", c.velocity_input);
}
template <class Io>
void Fields(Io& io, Like<PushSpec> auto& p) {
  io("name", p.name);
  io("node", p.node);
  io("direction", p.direction);
  io("scale", p.scale);
  io("force_n", p.force_n);
}
template <class Io>
void Fields(Io& io, Like<DragSpec> auto& d) {
  io("name", d.name);
  io("node", d.node);
  io("velocity_m_per_s", d.velocity_m_per_s);
  io("stiffness_n_per_m", d.stiffness_n_per_m);
  io("damping_n_s_per_m", d.damping_n_s_per_m);
  io("from_s", d.from_s);
  io("to_s", d.to_s);
}
template <class Io>
void Fields(Io& io, Like<PhaseSpec> auto& p) {
  io("name", p.name);
  io("from_s", p.from_s);
  io("to_s", p.to_s);
}
template <class Io>
void Fields(Io& io, Like<RecordSpec> auto& r) {
  io("rate_hz", r.rate_hz);
  io("channels", r.channels);
}
template <class Io>
void Fields(Io& io, Like<ReferenceSpec::Value> auto& v) {
  io("cable", v.cable);
  io("force_n", v.force_n);
}
template <class Io>
void Fields(Io& io, Like<ReferenceSpec> auto& r) {
  io("source", r.source);
  io("quantity", r.quantity, kReferenceQuantities);
  io("statistic", r.statistic, kReferenceStatistics);
  io("phase", r.phase);
  io("values", r.values);
}
template <class Io>
void Fields(Io& io, Like<ScaleSpec> auto& s) {
  io("quantity", s.quantity, kScaledQuantities);
  io("index", s.index);
  io("factor", s.factor);
}
template <class Io>
void Fields(Io& io, Like<StartNoise> auto& n) {
  io("position_m", n.position_m);
  io("heading_rad", n.heading_rad);
}
template <class Io>
void Fields(Io& io, Like<LoadCellSpec> auto& c) {
  io("noise_n", c.noise_n);
  io("bias_n", c.bias_n);
  io("min_n", c.min_n);
  io.Limit("max_n", c.max_n);
  io("quantum_n", c.quantum_n);
  io("delay_s", c.delay_s);
}
template <class Io>
void Fields(Io& io, Like<EncoderSpec> auto& e) {
  io("quantum_m", e.quantum_m);
  io("delay_s", e.delay_s);
}
template <class Io>
void Fields(Io& io, Like<SensorSpec> auto& s) {
  io("period_s", s.period_s);
  io("load_cell", s.load_cell);
  io("encoder", s.encoder);
  io("length_from_tension", s.length_from_tension);
}
template <class Io>
void Fields(Io& io, Like<ExperimentSpec> auto& e) {
  io("name", e.name);
  io("description", e.description);
  io("step_s", e.step_s);
  io("duration_s", e.duration_s);
  io("start", e.start, kStarts);
  io("seed", e.seed);
  io("record", e.record);
  io("compare_with", e.compare_with);
  io("phases", e.phases);
  io.Later("references", e.references);
  io("pushes", e.pushes);
  io("drags", e.drags);
  io.Later("scale", e.scales);
  io.Later("start_noise", e.start_noise);
  io.Later("sensors", e.sensors);
  io("controllers", e.controllers);
  io("robot", e.robot);
}

}  // namespace taut::description
