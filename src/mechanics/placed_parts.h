/// Geometry attached to bodies, and its transformation to another pose of the robot.
#pragma once

#include "math/vec.h"
#include "taut/model_def.h"

namespace taut {

/// Moves shapes, nodes, cable ends and joints; bodies themselves and terrain stay. A `Motion` has
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
  const auto turn_surface = [&](int body, Material& material) {
    if (material.directions) turn(body, material.directions->axis);
  };
  for (SphereDef& sphere : def.spheres) {
    move(sphere.body, sphere.center_m);
    turn_surface(sphere.body, sphere.material);
  }
  for (CapsuleDef& rod : def.capsules) {
    move(rod.body, rod.from_m), move(rod.body, rod.to_m);
    turn_surface(rod.body, rod.material);
  }
  for (BoxDef& box : def.boxes) {
    move(box.body, box.center_m);
    turn_surface(box.body, box.material);
    if (motion.Moves(box.body)) box.orientation = motion.Turned(box.body) * box.orientation;
  }
  for (HullDef& hull : def.hulls) {
    for (Vec3& corner : hull.corners_m) move(hull.body, corner);
    turn_surface(hull.body, hull.material);
  }
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
