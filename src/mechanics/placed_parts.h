/// Geometry attached to bodies, and its transformation to another pose of the robot.
#pragma once

#include "math/vec.h"
#include "taut/model_def.h"
#include "taut/shape_kinds.h"

namespace taut {

/// Moves shapes, nodes, cable ends and joints. Bodies themselves and terrain remain. A `Motion` has
///   bool Moves(int body)                       whether the body moves,
///   Vec3 Moved(int body, const Vec3& point_m)  new position of one of its points,
///   Quat Turned(int body)                      its rotation, in W.
/// `body` may be the world.
template <class Motion>
void MoveParts(const Motion& motion, ModelDef& def) {
  const auto move = [&](int body, Vec3& point_m) {
    if (motion.Moves(body)) point_m = motion.Moved(body, point_m);
  };
  const auto turn = [&](int body, Vec3& direction) {
    if (motion.Moves(body)) direction = Rotate(motion.Turned(body), direction);
  };
  EachShape(def, [&](auto& shape) {
    EachPoint(shape, [&](Vec3& point_m) { move(shape.body, point_m); });
    if (shape.material.directions) turn(shape.body, shape.material.directions->axis);
    if constexpr (requires { shape.orientation; }) {
      if (motion.Moves(shape.body)) {
        shape.orientation = motion.Turned(shape.body) * shape.orientation;
      }
    }
  });
  for (NodeDef& node : def.nodes) move(node.body, node.position_m);
  for (CableDef& cable : def.cables) {
    for (AttachmentDef& at : cable.attachments) {
      move(at.body, at.position_m);
      if (at.wheel) turn(at.body, at.wheel->axis);
    }
  }
  for (JointDef& joint : def.joints) {
    move(joint.body_a, joint.from_m), move(joint.body_b, joint.to_m);
    turn(joint.body_a, joint.axis);
    if (motion.Moves(joint.body_b)) joint.turned = motion.Turned(joint.body_b) * joint.turned;
    if (motion.Moves(joint.body_a)) {
      joint.turned = joint.turned * Conjugate(motion.Turned(joint.body_a));
    }
  }
}

}  // namespace taut
