#include "plant/start.h"

#include <cmath>

#include "base/fixed.h"
#include "base/union_find.h"
#include "math/elementary.h"
#include "math/random.h"
#include "math/vec.h"
#include "plant/streams.h"
#include "taut/start.h"

namespace taut::plant {
namespace {

bool FindStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out,
               const std::function<bool()>& go_on, std::optional<SettledStart>* settled) {
  if (experiment.start == StartKind::kAsDescribed) return true;
  const std::string hint = "a mechanism or a slope may have no equilibrium; try as_described";
  const auto settle = [&](Batch& which) {
    Unsettled before;
    if (settled) before = NoteUnsettled(which, experiment.step_s);
    if (!Settle(which, kTheWorld, experiment.step_s, go_on)) return false;
    if (settled) *settled = SettledStart{PoseOf(which), ChangeOf(before, which)};
    return true;
  };
  if (experiment.start == StartKind::kSettled) {
    if (settle(batch)) return true;
    out.Error({}, "the robot does not settle to an equilibrium on its ground", hint);
    return false;
  }
  ModelDef floating = experiment.robot.def;
  floating.gravity_m_per_s2 = {};
  floating.planes.clear();
  floating.terrain_boxes.clear();
  floating.height_fields.clear();
  floating.terrain_meshes.clear();
  const auto model = Model::Compile(floating, out);
  if (!model) return false;
  Batch alone(model, {});
  ApplyScales(experiment.scales, alone, kTheWorld);
  if (!settle(alone)) {
    out.Error({}, "the robot does not settle to an equilibrium of its cables", hint);
    return false;
  }
  for (std::size_t b = 0; b < floating.bodies.size(); ++b) {
    batch.SetBodyState(kTheWorld, static_cast<int>(b), alone.Body(kTheWorld, static_cast<int>(b)));
  }
  return true;
}

/// Per body: the first of those that joints tie to it, which a start moves together; kWorld if it
/// is tied to what does not move.
std::vector<int> JointedTo(const ModelDef& def) {
  const int world = static_cast<int>(def.bodies.size());
  base::UnionFind sets(def.bodies.size() + 1);
  const auto index = [&](int body) { return base::IsFixed(def, body) ? world : body; };
  for (const JointDef& joint : def.joints) sets.Join(index(joint.body_a), index(joint.body_b));
  std::vector<int> first;
  for (int b = 0; b < world; ++b) {
    first.push_back(sets.Root(b) == sets.Root(world) ? kWorld : sets.Root(b));
  }
  return first;
}

/// How the whole robot is turned. Of poses each is as likely: normal numbers have no direction of
/// their own in any number of dimensions, and turns lie evenly on the sphere of unit quaternions.
Quat TurnOf(const StartNoise& noise, std::uint64_t seed) {
  Quat turn;
  if (noise.any_pose) {
    math::Random random(seed, kStartPose, 0);
    const double w = random.Normal(), x = random.Normal(), y = random.Normal();
    const double z = random.Normal();
    const double size = std::sqrt(w * w + x * x + y * y + z * z);
    if (size > 0) turn = {w / size, x / size, y / size, z / size};
  }
  if (noise.heading_rad > 0) {
    math::Random random(seed, kStartHeading, 0);
    const double half_rad = 0.5 * random.Uniform(-noise.heading_rad, noise.heading_rad);
    const Quat heading{math::Cos(half_rad), 0, 0, math::Sin(half_rad)};
    turn = noise.any_pose ? heading * turn : heading;
  }
  return turn;
}

/// Bodies a little off, upwards rather than into the ground; then the whole robot turned.
void Disturb(const ExperimentSpec& experiment, Batch& batch) {
  const StartNoise& noise = experiment.start_noise;
  const ModelDef& def = experiment.robot.def;
  const std::vector<int> together = JointedTo(def);
  Vec3 center;
  double mass = 0;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    if (def.bodies[b].fixed) continue;
    const int body = static_cast<int>(b);
    BodyState state = batch.Body(kTheWorld, body);
    if (noise.position_m > 0 && together[b] != kWorld) {
      math::Random random(experiment.seed, kStartPosition, static_cast<std::uint64_t>(together[b]));
      const double x = random.Uniform(-noise.position_m, noise.position_m);
      const double y = random.Uniform(-noise.position_m, noise.position_m);
      state.position_m = state.position_m + Vec3{x, y, random.Uniform(0.0, noise.position_m)};
      batch.SetBodyState(kTheWorld, body, state);
    }
    const double m = batch.GetParameter(kTheWorld, Parameter::kBodyMass, body);
    center = center + m * state.position_m;
    mass += m;
  }
  if (!(noise.heading_rad > 0 || noise.any_pose) || !(mass > 0)) return;
  center = (1 / mass) * center;
  const Quat turn = TurnOf(noise, experiment.seed);
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    if (def.bodies[b].fixed) continue;
    BodyState state = batch.Body(kTheWorld, static_cast<int>(b));
    state.position_m = center + Rotate(turn, state.position_m - center);
    state.orientation = turn * state.orientation;
    state.velocity_m_per_s = Rotate(turn, state.velocity_m_per_s);
    state.angular_velocity_rad_per_s = Rotate(turn, state.angular_velocity_rad_per_s);
    batch.SetBodyState(kTheWorld, static_cast<int>(b), state);
  }
}

}  // namespace

void ApplyScales(const std::vector<ScaleSpec>& scales, Batch& batch, int world) {
  const ModelDef& def = batch.model().def();
  const auto apply = [&](Parameter parameter, const std::vector<int>& chosen, std::size_t count,
                         double factor) {
    const auto scale = [&](int index) {
      batch.SetParameter(world, parameter, index,
                         factor * batch.GetParameter(world, parameter, index));
    };
    for (const int index : chosen) scale(index);
    for (std::size_t i = 0; chosen.empty() && i < count; ++i) scale(static_cast<int>(i));
  };
  for (const ScaleSpec& s : scales) {
    if (s.factor == 1.0) continue;
    switch (s.quantity) {
      case ScaleSpec::Quantity::kFriction:
        apply(Parameter::kFrictionScale, {}, 1, s.factor);
        break;
      case ScaleSpec::Quantity::kMass:
        apply(Parameter::kBodyMass, s.index, def.bodies.size(), s.factor);
        break;
      case ScaleSpec::Quantity::kStiffness:
        apply(Parameter::kCableStiffness, s.index, def.cables.size(), s.factor);
        break;
      case ScaleSpec::Quantity::kDamping:
        apply(Parameter::kCableDamping, s.index, def.cables.size(), s.factor);
        break;
    }
  }
}

bool PrepareStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out,
                  const std::function<bool()>& go_on, std::optional<SettledStart>* settled) {
  ApplyScales(experiment.scales, batch, kTheWorld);
  const RobotSpec& robot = experiment.robot;
  const bool terrain = experiment.start != StartKind::kSettledFloating;
  if (!CheckOverlaps(robot, batch, terrain, false, out)) return false;
  if (!FindStart(experiment, batch, out, go_on, settled)) return false;
  const StartNoise& noise = experiment.start_noise;
  const bool noisy = noise.position_m > 0 || noise.heading_rad > 0 || noise.any_pose;
  if (noisy) Disturb(experiment, batch);
  if (!noisy && experiment.start == StartKind::kAsDescribed) return true;
  return CheckOverlaps(robot, batch, true, false, out);
}

}  // namespace taut::plant

namespace taut {

std::optional<SettledStart> FindSettledStart(const ExperimentSpec& experiment, Diagnostics& out,
                                             const std::function<bool()>& go_on) {
  const auto model = Model::Compile(experiment.robot.def, out);
  if (!model) return std::nullopt;
  Batch batch(model, {});
  std::optional<SettledStart> settled;
  if (!plant::PrepareStart(experiment, batch, out, go_on, &settled)) return std::nullopt;
  if (settled) WarnOfStart(settled->change, out);
  return settled;
}

}  // namespace taut
