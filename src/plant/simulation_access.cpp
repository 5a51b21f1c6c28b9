// Readings and commands of a simulation, by name or index.
#include "plant/simulation_impl.h"
#include "plant/status_text.h"

namespace taut {
namespace {

/// Reads an element in a world. `function`: name of the caller, for messages.
template <class Impl, class State>
State Read(const Impl& impl, const char* function, const plant::Names& names,
           const ElementRef& element, int world, State (WorldBatch::*read)(int, int) const) {
  const int index = names.IndexOf(function, impl.def(), element);
  return (impl.GroupOf(function, world).batch.*read)(impl.LaneOf(world), index);
}

/// Rejects a vector that is not finite.
bool Accepts(plant::SimulationGroup& group, int lane, const char* kind, const std::string& name,
             const char* what, const Vec3& v) {
  const plant::FiniteCheck::Named numbers[] = {{what, v.x}, {what, v.y}, {what, v.z}};
  return group.loop.Accepts(lane, kind, name, numbers);
}

}  // namespace

// --- readings ------------------------------------------------------------------------------------

CableState Simulation::Cable(const ElementRef& cable, int world) const {
  return Read(*impl_, __func__, impl_->cables, cable, world, &WorldBatch::Cable);
}
BodyState Simulation::Body(const ElementRef& body, int world) const {
  return Read(*impl_, __func__, impl_->bodies, body, world, &WorldBatch::Body);
}
Vec3 Simulation::NodePosition(const ElementRef& node, int world) const {
  return Read(*impl_, __func__, impl_->nodes, node, world, &WorldBatch::NodePosition);
}
Vec3 Simulation::NodeVelocity(const ElementRef& node, int world) const {
  return Read(*impl_, __func__, impl_->nodes, node, world, &WorldBatch::NodeVelocity);
}
JointState Simulation::Joint(const ElementRef& joint, int world) const {
  return Read(*impl_, __func__, impl_->joints, joint, world, &WorldBatch::Joint);
}
MotionState Simulation::Motion(const ElementRef& motion, int world) const {
  return Read(*impl_, __func__, impl_->motions, motion, world, &WorldBatch::Motion);
}
MotorState Simulation::Motor(const ElementRef& cable, int world) const {
  return Read(*impl_, __func__, impl_->cables, cable, world, &WorldBatch::Motor);
}
Energy Simulation::TotalEnergy(int world) const {
  return impl_->GroupOf(__func__, world).batch.TotalEnergy(impl_->LaneOf(world));
}
std::vector<ContactState> Simulation::Contacts(int world) const {
  return impl_->GroupOf(__func__, world).batch.Contacts(impl_->LaneOf(world));
}
WorldStatus Simulation::Status(int world) const {
  return impl_->GroupOf(__func__, world).batch.Status(impl_->LaneOf(world));
}
std::string Simulation::StatusText(int world) const {
  const std::string text = plant::StatusText(impl_->def(), Status(world));
  const std::string& refused = impl_->GroupOf(__func__, world).loop.refused(impl_->LaneOf(world));
  return text + (text.empty() || refused.empty() ? "" : "; ") + refused;
}
std::uint64_t Simulation::Hash(int world) const {
  return impl_->GroupOf(__func__, world).batch.Hash(impl_->LaneOf(world));
}

// --- commands ------------------------------------------------------------------------------------

void Simulation::SetRestLength(const ElementRef& cable, double rest_length_m, int world) {
  const int c = impl_->cables.IndexOf(__func__, impl_->def(), cable);
  impl_->GroupOf(__func__, world).loop.SetRestLength(impl_->LaneOf(world), c, rest_length_m);
}
double Simulation::RestLengthCommand(const ElementRef& cable, int world) const {
  const int c = impl_->cables.IndexOf(__func__, impl_->def(), cable);
  const Commands& commands = impl_->GroupOf(__func__, world).loop.commands();
  return commands.rest_length_m[impl_->RowIndex(c, world)];
}
void Simulation::SetMode(const ElementRef& cable, CommandMode mode, int world) {
  const int c = impl_->cables.IndexOf(__func__, impl_->def(), cable);
  impl_->GroupOf(__func__, world).plant->commands().mode[impl_->RowIndex(c, world)] = mode;
}
std::optional<ImpedanceGains> Simulation::Gains(const ElementRef& cable, int world) const {
  const int c = impl_->cables.IndexOf(__func__, impl_->def(), cable);
  return impl_->GroupOf(__func__, world).loop.Gains(impl_->LaneOf(world), c);
}
bool Simulation::SetGains(const ImpedanceGains& gains, int world) {
  impl_->cables.IndexOf(__func__, impl_->def(), gains.cable);
  return impl_->GroupOf(__func__, world).loop.SetGains(impl_->LaneOf(world), gains);
}
void Simulation::SetNodeForce(const ElementRef& node, const Vec3& force_n, int world) {
  const int n = impl_->nodes.IndexOf(__func__, impl_->def(), node);
  plant::SimulationGroup& group = impl_->GroupOf(__func__, world);
  const std::string& name = impl_->def().nodes[static_cast<std::size_t>(n)].name;
  if (!Accepts(group, impl_->LaneOf(world), "node", name, "force_n", force_n)) return;
  std::vector<ExternalForce>& forces = impl_->SlotOf(world).forces;
  std::erase_if(forces, [n](const ExternalForce& one) { return one.node == n; });
  if (force_n.x != 0 || force_n.y != 0 || force_n.z != 0) forces.push_back({n, force_n});
  group.loop.SetHandForces(impl_->LaneOf(world), forces);
}
void Simulation::SetExternalForces(std::span<const ExternalForce> forces, int world) {
  plant::SimulationGroup& group = impl_->GroupOf(__func__, world);
  for (const ExternalForce& one : forces) {
    const int n = impl_->nodes.IndexOf(__func__, impl_->def(), one.node);
    const std::string& name = impl_->def().nodes[static_cast<std::size_t>(n)].name;
    if (!Accepts(group, impl_->LaneOf(world), "node", name, "force_n", one.force_n)) return;
  }
  impl_->SlotOf(world).forces.assign(forces.begin(), forces.end());
  group.loop.SetHandForces(impl_->LaneOf(world), impl_->SlotOf(world).forces);
}
std::vector<ExternalForce> Simulation::ExternalForces(int world) const {
  std::vector<ExternalForce> forces =
      impl_->GroupOf(__func__, world).loop.timeline(impl_->LaneOf(world)).EventForces();
  const std::vector<ExternalForce>& own = impl_->SlotOf(world).forces;
  forces.insert(forces.end(), own.begin(), own.end());
  return forces;
}

// --- state and parameters ------------------------------------------------------------------------

void Simulation::SetBodyState(const ElementRef& body, const BodyState& state, int world) {
  const int b = impl_->bodies.IndexOf(__func__, impl_->def(), body);
  plant::SimulationGroup& group = impl_->GroupOf(__func__, world);
  const int lane = impl_->LaneOf(world);
  const std::string& name = impl_->def().bodies[static_cast<std::size_t>(b)].name;
  const Quat& q = state.orientation;
  const plant::FiniteCheck::Named scalar{"orientation", q.w};
  if (!Accepts(group, lane, "body", name, "position_m", state.position_m) ||
      !group.loop.Accepts(lane, "body", name, {&scalar, 1}) ||
      !Accepts(group, lane, "body", name, "orientation", {q.x, q.y, q.z}) ||
      !Accepts(group, lane, "body", name, "velocity_m_per_s", state.velocity_m_per_s) ||
      !Accepts(group, lane, "body", name, "angular_velocity_rad_per_s",
               state.angular_velocity_rad_per_s)) {
    return;
  }
  group.batch.SetBodyState(lane, b, state);
}

double Simulation::GetParameter(Parameter parameter, const ElementRef& of, int world) const {
  const int index = impl_->ParameterIndex(__func__, parameter, of);
  return impl_->GroupOf(__func__, world).batch.GetParameter(impl_->LaneOf(world), parameter, index);
}
bool Simulation::SetParameter(Parameter parameter, const ElementRef& of, double value, int world) {
  const int index = impl_->ParameterIndex(__func__, parameter, of);
  return impl_->GroupOf(__func__, world)
      .batch.SetParameter(impl_->LaneOf(world), parameter, index, value);
}

}  // namespace taut
