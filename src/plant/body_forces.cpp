#include "plant/body_forces.h"

#include <algorithm>

#include "mechanics/strut.h"

namespace taut::plant {

std::vector<JointDef> JointsByArms(const ModelDef& def) {
  const auto arm = [&](int body, const Vec3& point_m) {
    return body == kWorld ? point_m : point_m - def.bodies[static_cast<std::size_t>(body)].com_m;
  };
  std::vector<JointDef> joints = def.joints;
  for (JointDef& joint : joints) {
    joint.from_m = arm(joint.body_a, joint.from_m);
    joint.to_m = arm(joint.body_b, joint.to_m);
  }
  return joints;
}

BodyForces::BodyForces(const ModelDef& def) : body_count_(def.bodies.size()) {
  for (const CableDef& cable : def.cables) {
    std::vector<BodyPoint>& points = cables_.emplace_back();
    const auto simple = [](const AttachmentDef& at) { return !at.wheel && at.friction == 0; };
    if (cable.touches != CableTouches::kNone ||
        !std::all_of(cable.attachments.begin(), cable.attachments.end(), simple)) {
      continue;
    }
    for (const AttachmentDef& at : cable.attachments) {
      const Vec3 origin =
          at.body == kWorld ? Vec3{} : def.bodies[static_cast<std::size_t>(at.body)].com_m;
      points.push_back({at.body, at.position_m - origin});
    }
  }
  for (const NodeDef& node : def.nodes) bodies_of_nodes_.push_back(node.body);
  joints_ = JointsByArms(def);
}

const std::vector<BodyForce>& BodyForces::Gather(const Observation& exact, const World& world,
                                                 int lane) {
  forces_.clear();
  states_.clear();
  for (std::size_t b = 0; b < body_count_; ++b) {
    states_.push_back(world.Body(lane, static_cast<int>(b)));
  }
  const auto add = [&](int body, const Vec3& point_m, const Vec3& force_n) {
    if (body != kWorld) forces_.push_back({body, point_m, force_n, {}});
  };
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    if (cables_[c].empty()) {
      for (const CablePoint& point : world.CablePath(lane, static_cast<int>(c))) {
        add(point.body, point.position_m, point.force_n);
      }
      continue;
    }
    const double tension_n = exact.Cable(static_cast<int>(c), lane).tension_n;
    if (tension_n == 0) continue;
    path_.clear();
    for (const BodyPoint& point : cables_[c]) {
      const Vec3 place = point.body == kWorld
                             ? point.arm_m
                             : PlaceOf(point, states_[static_cast<std::size_t>(point.body)]);
      path_.push_back({place, {}, {}, {}});
    }
    const int count = static_cast<int>(path_.size());
    MeasurePath(count, path_.data());
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      add(cables_[c][at].body, path_[at].p, tension_n * PullAt(count, path_.data(), i));
    }
  }
  for (std::size_t n = 0; n < bodies_of_nodes_.size(); ++n) {
    if (bodies_of_nodes_[n] == kWorld) continue;
    const Vec3 force_n = world.NodeForce(lane, static_cast<int>(n));
    if (Dot(force_n, force_n) == 0) continue;
    add(bodies_of_nodes_[n], world.NodePosition(lane, static_cast<int>(n)), force_n);
  }
  const auto place = [&](int body, const Vec3& arm_m) {
    return body == kWorld ? arm_m : PlaceOf({body, arm_m}, states_[static_cast<std::size_t>(body)]);
  };
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const JointDef& joint = joints_[j];
    const JointState now = world.Joint(lane, static_cast<int>(j));
    for (const BodyForce& force : mechanics::JointForces(joint, {now.force_n, now.torque_n_m},
                                                         place(joint.body_a, joint.from_m),
                                                         place(joint.body_b, joint.to_m))) {
      if (force.body != kWorld) forces_.push_back(force);
    }
  }
  for (const ContactState& contact : world.Contacts(lane)) {
    add(contact.body_a, contact.point_m, contact.force_n);
    add(contact.body_b, contact.point_m, -1.0 * contact.force_n);
  }
  return forces_;
}

}  // namespace taut::plant
