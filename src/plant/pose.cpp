// Poses that a robot has come to, and the robot described in one.
#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "math/vec.h"
#include "plant/start.h"
#include "taut/start.h"

namespace taut {
namespace {

/// Of unit length, up to rounding; what is stepped often is a little off.
Quat Normalized(const Quat& q) {
  const double scale = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

/// R I R^T.
Inertia Turned(const Quat& q, const Inertia& i) {
  // The columns of I, turned; then the same once more with the rows of what came out.
  const Vec3 x = Rotate(q, {i.xx, i.xy, i.xz}), y = Rotate(q, {i.xy, i.yy, i.yz}),
             z = Rotate(q, {i.xz, i.yz, i.zz});
  const Vec3 a = Rotate(q, {x.x, y.x, z.x}), b = Rotate(q, {x.y, y.y, z.y}),
             c = Rotate(q, {x.z, y.z, z.z});
  return {a.x, b.y, c.z, 0.5 * (a.y + b.x), 0.5 * (a.z + c.x), 0.5 * (b.z + c.y)};
}

}  // namespace

RobotSpec RobotAt(const RobotSpec& robot, const Pose& pose) {
  RobotSpec moved = robot;
  ModelDef& def = moved.def;
  TAUT_ASSERT(pose.bodies.size() == def.bodies.size());
  TAUT_ASSERT(pose.rest_lengths_m.size() == def.cables.size());
  std::vector<Quat> turns;
  for (const BodyState& state : pose.bodies) turns.push_back(Normalized(state.orientation));
  const auto move = [&](int body, Vec3& point_m) {
    if (body == kWorld) return;
    const auto b = static_cast<std::size_t>(body);
    if (def.bodies[b].fixed) return;
    point_m = pose.bodies[b].position_m + Rotate(turns[b], point_m - robot.def.bodies[b].com_m);
  };
  const auto turn = [&](int body, Material& material) {
    if (body == kWorld || !material.directions) return;
    Vec3& axis = material.directions->axis;
    axis = Rotate(turns[static_cast<std::size_t>(body)], axis);
  };
  for (SphereDef& sphere : def.spheres) {
    move(sphere.body, sphere.center_m);
    turn(sphere.body, sphere.material);
  }
  for (CapsuleDef& rod : def.capsules) {
    move(rod.body, rod.from_m), move(rod.body, rod.to_m);
    turn(rod.body, rod.material);
  }
  for (BoxDef& box : def.boxes) {
    turn(box.body, box.material);
    move(box.body, box.center_m);
    if (def.bodies[static_cast<std::size_t>(box.body)].fixed) continue;
    box.orientation = turns[static_cast<std::size_t>(box.body)] * box.orientation;
  }
  for (NodeDef& node : def.nodes) move(node.body, node.position_m);
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    for (AttachmentDef& at : def.cables[c].attachments) move(at.body, at.position_m);
    def.cables[c].rest_length_m = pose.rest_lengths_m[c];
  }
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    BodyDef& body = def.bodies[b];
    body.velocity_m_per_s = body.angular_velocity_rad_per_s = {};
    if (body.fixed) continue;
    body.com_m = pose.bodies[b].position_m;
    body.inertia_kg_m2 = Turned(turns[b], body.inertia_kg_m2);
  }
  return moved;
}

namespace plant {

Pose PoseOf(const Batch& batch) {
  const ModelDef& def = batch.model().def();
  Pose pose;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    pose.bodies.push_back(batch.Body(kTheWorld, static_cast<int>(b)));
  }
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    // Without an actuator nothing obeys a command, and none goes below its least rest length. A
    // motor's servo may be short of its target, which friction holds.
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
