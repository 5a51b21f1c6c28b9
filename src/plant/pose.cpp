// Poses of a simulated robot, and conversion of a model to another described pose.
#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "math/vec.h"
#include "mechanics/mass_properties.h"
#include "mechanics/placed_parts.h"
#include "plant/find_start.h"
#include "taut/start.h"

namespace taut {
namespace {

/// Scales `q` to unit length, to remove the integration error of many steps.
Quat Normalized(const Quat& q) {
  const double scale = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

/// Motion of each body from its described pose to its current pose.
class ToPose {
 public:
  ToPose(const ModelDef& from, const Pose& to) : from_(from.bodies), to_(to.bodies) {
    for (const BodyDef& body : from_) moves_.push_back(!body.fixed);
    for (const MotionDef& motion : from.motions) moves_[Index(motion.body)] = true;
    for (const BodyState& state : to_) turns_.push_back(Normalized(state.orientation));
  }
  bool Moves(int body) const { return body != kWorld && moves_[Index(body)]; }
  Vec3 Moved(int body, const Vec3& point_m) const {
    const std::size_t b = Index(body);
    return to_[b].position_m + Rotate(turns_[b], point_m - from_[b].com_m);
  }
  const Quat& Turned(int body) const { return turns_[Index(body)]; }

 private:
  static std::size_t Index(int body) { return static_cast<std::size_t>(body); }
  const std::vector<BodyDef>& from_;
  const std::vector<BodyState>& to_;
  std::vector<Quat> turns_;
  std::vector<bool> moves_;  ///< Whether each body moves: free or kinematic.
};

}  // namespace

RobotSpec RobotAt(const RobotSpec& robot, const Pose& pose) {
  RobotSpec moved = robot;
  ModelDef& def = moved.def;
  TAUT_ASSERT(pose.bodies.size() == def.bodies.size());
  TAUT_ASSERT(pose.rest_lengths_m.size() == def.cables.size());
  const ToPose motion(robot.def, pose);
  MoveParts(motion, def);
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    def.cables[c].rest_length_m = pose.rest_lengths_m[c];
  }
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    BodyDef& body = def.bodies[b];
    body.velocity_m_per_s = body.angular_velocity_rad_per_s = {};
    if (!motion.Moves(static_cast<int>(b))) continue;
    body.com_m = pose.bodies[b].position_m;
    body.inertia_kg_m2 = Turned(motion.Turned(static_cast<int>(b)), body.inertia_kg_m2);
  }
  if (!moved.solids) return moved;
  for (SolidsSpec::PointMass& mass : moved.solids->point_masses) {
    const int body = def.nodes[static_cast<std::size_t>(mass.node)].body;
    if (!mass.inertia_kg_m2 || !motion.Moves(body)) continue;
    mass.inertia_kg_m2 = Turned(motion.Turned(body), *mass.inertia_kg_m2);
  }
  return moved;
}

namespace plant {

Pose PoseOf(const WorldBatch& batch) {
  const ModelDef& def = batch.model().def();
  Pose pose;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    pose.bodies.push_back(batch.Body(kTheWorld, static_cast<int>(b)));
  }
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    // Without an actuator, a cable ignores commands. A motor may stop short of its target because
    // of friction. For both, use the actual rest length. For other actuators, use the target,
    // limited to the least rest length.
    const ActuatorDef& actuator = def.cables[c].actuator;
    const int cable = static_cast<int>(c);
    pose.rest_lengths_m.push_back(
        actuator.kind == ActuatorDef::Kind::kNone || actuator.kind == ActuatorDef::Kind::kDcMotor
            ? batch.Cable(kTheWorld, cable).rest_length_m
            : std::max(batch.RestLengthTarget(kTheWorld, cable), actuator.min_rest_length_m));
  }
  return pose;
}

}  // namespace plant
}  // namespace taut
