#include "plant/find_start.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <type_traits>

#include "base/fixed.h"
#include "base/union_find.h"
#include "math/elementary.h"
#include "math/random.h"
#include "math/shape_corners.h"
#include "math/vec.h"
#include "plant/goal.h"
#include "plant/random_streams.h"
#include "sim/batch/ground_height.h"
#include "taut/shape_kinds.h"
#include "taut/start.h"
#include "taut/time_limits.h"

namespace taut::plant {
namespace {

bool FindStart(const ExperimentSpec& experiment, WorldBatch& batch, Diagnostics& out,
               const std::function<bool()>& go_on, std::optional<SettledStart>* settled) {
  if (experiment.start == StartKind::kAsDescribed) return true;
  const std::string hint = fmt::format(
      "a mechanism or a slope may have no equilibrium, and steps of {:g} s may be too "
      "long: try a shorter step_s, or start: as_described",
      experiment.step_s);
  const auto settle = [&](WorldBatch& which) {
    Unsettled before;
    if (settled) before = NoteUnsettled(which, experiment.step_s);
    if (!Settle(which, kTheWorld, experiment.step_s, go_on)) return false;
    if (settled) *settled = SettledStart{PoseOf(which), ChangeOf(before, which)};
    return true;
  };
  if (experiment.start == StartKind::kSettled) {
    if (settle(batch)) return true;
    out.Error("start.not_settled", {}, "the robot does not settle to an equilibrium on its ground",
              hint);
    return false;
  }
  ModelDef floating = experiment.robot.def;
  floating.gravity_m_per_s2 = {};
  floating.planes.clear();
  floating.terrain_boxes.clear();
  floating.height_fields.clear();
  floating.terrain_meshes.clear();
  const auto model = Model::CompileForExperiment(floating, out);
  if (!model) return false;
  WorldBatch alone(model, {});
  ApplyScales(experiment.scales, alone, kTheWorld);
  if (!settle(alone)) {
    out.Error("start.not_settled", {}, "the robot does not settle to an equilibrium of its cables",
              hint);
    return false;
  }
  for (std::size_t b = 0; b < floating.bodies.size(); ++b) {
    batch.SetBodyState(kTheWorld, static_cast<int>(b), alone.Body(kTheWorld, static_cast<int>(b)));
  }
  return true;
}

/// Returns, for each body, the first body of its group of jointed bodies, which start noise moves
/// together. Returns kWorld if joints connect the group to a fixed body or the world.
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

/// Returns the random rotation of the whole robot. With `any_pose`, it is uniform over all
/// rotations: a vector of four normal random numbers has no preferred direction, so normalized it
/// is a uniform unit quaternion.
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

/// Returns points of the robot, as described, that determine its clearance above the ground. Along
/// rods, their spacing is at most the radius (with a limit of 100 parts).
std::vector<Vec3> PointsOf(const ModelDef& def) {
  constexpr double kMostOfARod = 100;
  std::vector<Vec3> points;
  for (const NodeDef& node : def.nodes) {
    if (node.body != kWorld) points.push_back(node.position_m);
  }
  EachShape(def, [&](const auto& shape) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(shape)>, CapsuleDef>) {
      const Vec3 along = shape.to_m - shape.from_m;
      const double radii = std::sqrt(Dot(along, along)) / shape.radius_m;
      const int parts = static_cast<int>(std::fmin(std::ceil(radii), kMostOfARod));
      for (int i = 0; i <= parts; ++i) {
        points.push_back(shape.from_m + (parts > 0 ? 1.0 * i / parts : 0.0) * along);
      }
    } else {
      math::EachCorner(shape, [&](const Vec3& corner) { points.push_back(corner); });
    }
  });
  return points;
}

/// Returns the horizontal displacement by start noise, plus a vertical displacement so that no
/// point comes closer to the ground. Returns nothing and reports an error if a point would leave
/// the terrain.
std::optional<Vec3> PlacedBy(const ExperimentSpec& experiment, const Model& model,
                             Diagnostics& out) {
  Vec3 by = PlaceOf(experiment.start_noise, experiment.seed);
  double up_m = -std::numeric_limits<double>::infinity();
  for (const Vec3& p : PointsOf(experiment.robot.def)) {
    const double was_m = sim::GroundHeight(model, p.x, p.y);
    const double is_m = sim::GroundHeight(model, p.x + by.x, p.y + by.y);
    if (std::isinf(is_m) && is_m != was_m) {
      out.Error("start.outside_terrain", {}, "start_noise.place_m moves the robot off its terrain",
                "use a smaller value or a larger terrain");
      return std::nullopt;
    }
    if (!std::isinf(is_m)) up_m = std::fmax(up_m, is_m - (std::isinf(was_m) ? p.z : was_m));
  }
  if (!std::isinf(up_m)) by.z = up_m;
  return by;
}

/// Moves all bodies that are not fixed.
void MoveBy(const Vec3& by, const ModelDef& def, WorldBatch& batch) {
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    if (def.bodies[b].fixed) continue;
    BodyState state = batch.Body(kTheWorld, static_cast<int>(b));
    state.position_m = state.position_m + by;
    batch.SetBodyState(kTheWorld, static_cast<int>(b), state);
  }
}

/// Displaces bodies at random, with vertical displacements upward only. Then rotates the whole
/// robot.
void Disturb(const ExperimentSpec& experiment, WorldBatch& batch) {
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

void ApplyScales(const std::vector<ScaleSpec>& scales, WorldBatch& batch, int world) {
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

bool CheckTimes(const ExperimentSpec& experiment, Diagnostics& out) {
  const double step_s = experiment.step_s, duration_s = experiment.duration_s;
  const bool good_step = step_s >= kShortestStep_s && step_s <= kLongestStep_s;
  const bool good_duration = duration_s >= 0 && duration_s <= kLongestTime_s;
  if (!good_step) {
    out.Error("experiment.step_out_of_range", {},
              fmt::format("step_s must be within {:g}..{:g} s, got {}", kShortestStep_s,
                          kLongestStep_s, step_s));
  }
  if (!good_duration) {
    out.Error(
        "experiment.duration_out_of_range", {},
        fmt::format("duration_s must be within 0..{:g} s, got {}", kLongestTime_s, duration_s));
  }
  return good_step && good_duration;
}

bool PrepareStart(const ExperimentSpec& experiment, WorldBatch& batch, Diagnostics& out,
                  const std::function<bool()>& go_on, std::optional<SettledStart>* settled) {
  if (!CheckTimes(experiment, out)) return false;
  ApplyScales(experiment.scales, batch, kTheWorld);
  const RobotSpec& robot = experiment.robot;
  const StartNoise& noise = experiment.start_noise;
  const bool terrain = experiment.start != StartKind::kSettledFloating;
  std::optional<Vec3> placed;
  if (noise.place_m > 0) {
    placed = PlacedBy(experiment, batch.model(), out);
    if (!placed) return false;
    if (terrain) MoveBy(*placed, robot.def, batch);
  }
  if (!CheckOverlaps(robot, batch, terrain, false, out)) return false;
  if (!FindStart(experiment, batch, out, go_on, settled)) return false;
  if (placed && !terrain) MoveBy(*placed, robot.def, batch);
  const bool noisy = placed || noise.position_m > 0 || noise.heading_rad > 0 || noise.any_pose;
  if (noisy) Disturb(experiment, batch);
  if (!noisy && experiment.start == StartKind::kAsDescribed) return true;
  return CheckOverlaps(robot, batch, true, false, out);
}

}  // namespace taut::plant

namespace taut {

std::optional<SettledStart> FindSettledStart(const ExperimentSpec& experiment, Diagnostics& out,
                                             const std::function<bool()>& go_on) {
  const auto model = Model::CompileForExperiment(experiment.robot.def, out);
  if (!model) return std::nullopt;
  WorldBatch batch(model, {});
  std::optional<SettledStart> settled;
  if (!plant::PrepareStart(experiment, batch, out, go_on, &settled)) return std::nullopt;
  if (settled) WarnOfStart(settled->change, out);
  return settled;
}

}  // namespace taut
