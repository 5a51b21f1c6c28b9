#include "analysis/structure.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "math/cable_law.h"
#include "math/shape_corners.h"
#include "math/vec.h"
#include "taut/shape_kinds.h"

namespace taut::analysis {

Structure::Structure(const ModelDef& def, const LoadCaseSpec& load_case, bool contact) : def_(def) {
  AddBodies();
  AddCables(load_case);
  AddJoints(load_case);
  AddLoads(load_case);
  if (contact) AddTouches();
  Measure();
  left_out = WhatIsLeftOut(def);
}

Anchor Structure::AnchorAt(int body, const Vec3& place_m) const {
  const int moving = Moving(body);
  if (moving < 0) return {-1, place_m};
  return {moving, place_m - start.center_m[static_cast<std::size_t>(moving)]};
}

void Structure::AddBodies() {
  for (const BodyDef& body : def_.bodies) {
    moving_.push_back(body.fixed ? -1 : static_cast<int>(bodies.size()));
    if (body.fixed) continue;
    bodies.push_back(static_cast<int>(moving_.size()) - 1);
    start.center_m.push_back(body.com_m);
    start.turn.emplace_back();
  }
  arms_.assign(bodies.size(), Eigen::Matrix3d::Zero());
  resisted_ = arms_;
  reach_m.assign(bodies.size(), 0.0);
}

void Structure::Acts(const Anchor& anchor) {
  if (anchor.body < 0) {
    held_by_world = true;
    return;
  }
  const std::size_t b = static_cast<std::size_t>(anchor.body);
  arms_[b] -= CrossMatrix(anchor.at_m) * CrossMatrix(anchor.at_m);
  reach_m[b] = std::max(reach_m[b], std::sqrt(Dot(anchor.at_m, anchor.at_m)));
}

void Structure::ResistsTurns(const Anchor& anchor, const Vec3& direction) {
  if (anchor.body < 0) return;
  Eigen::Matrix3d& sum = resisted_[static_cast<std::size_t>(anchor.body)];
  if (Dot(direction, direction) == 0) sum += Eigen::Matrix3d::Identity();
  sum -= CrossMatrix(direction) * CrossMatrix(direction);
}

void Structure::AddCables(const LoadCaseSpec& load_case) {
  for (const CableDef& cable : def_.cables) {
    std::vector<Anchor> anchors;
    for (const AttachmentDef& at : cable.attachments) {
      anchors.push_back(AnchorAt(at.body, at.position_m));
      Acts(anchors.back());
      if (at.wheel) ResistsTurns(anchors.back(), at.wheel->axis);
    }
    cables.push_back(
        {CableCoordinate(cable, anchors), cable.stiffness_n_per_m, cable.rest_length_m});
    stiffness_n_per_m = std::max(stiffness_n_per_m, cable.stiffness_n_per_m);
  }
  for (const LoadCaseSpec::Lengthening& longer : load_case.cables) {
    TAUT_ASSERT(longer.index >= 0 && longer.index < static_cast<int>(cables.size()));
    cables[static_cast<std::size_t>(longer.index)].rest_m += longer.by_m;
  }
}

void Structure::AddJoints(const LoadCaseSpec& load_case) {
  for (const JointDef& joint : def_.joints) {
    const HeldMotions held = ConstrainedMotions(joint.kind);
    PlacedJoint placed{joint, AnchorAt(joint.body_a, joint.from_m),
                       AnchorAt(joint.body_b, joint.to_m)};
    const std::size_t number = joints.size();
    for (const HeldRow row : HeldRowsOf(joint)) rows.push_back({number, row});
    // Body a receives the joint's force, which is along the axes of a, at the position of point b.
    Acts(joint.kind == JointKind::kDistance ? placed.a : AnchorAt(joint.body_a, joint.to_m));
    Acts(placed.b);
    const bool all = held.twist || (joint.stiffness > 0 && IsAngle(joint.kind));
    for (const Anchor& side : {placed.a, placed.b}) {
      if (held.swing) ResistsTurns(side, joint.axis);
      if (all) ResistsTurns(side, {});
    }
    if (!IsAngle(joint.kind)) stiffness_n_per_m = std::max(stiffness_n_per_m, joint.stiffness);
    joints.push_back(placed);
  }
  for (const LoadCaseSpec::Lengthening& longer : load_case.bars) {
    TAUT_ASSERT(longer.index >= 0 && longer.index < static_cast<int>(joints.size()));
    joints[static_cast<std::size_t>(longer.index)].def.rest += longer.by_m;
  }
  for (const LoadCaseSpec::Settlement& settled : load_case.settlements) {
    TAUT_ASSERT(settled.joint >= 0 && settled.joint < static_cast<int>(joints.size()));
    PlacedJoint& joint = joints[static_cast<std::size_t>(settled.joint)];
    Anchor& in_world = joint.a.body < 0 ? joint.a : joint.b;
    in_world.at_m = in_world.at_m + settled.by_m;
  }
}

void Structure::AddLoads(const LoadCaseSpec& load_case) {
  for (const int body : bodies) {
    const BodyDef& b = def_.bodies[static_cast<std::size_t>(body)];
    weight_n.push_back(load_case.GravityFactor() * b.mass_kg * def_.gravity_m_per_s2);
  }
  for (const LoadCaseSpec::NodeForce& force : load_case.forces) {
    TAUT_ASSERT(force.node >= 0 && force.node < static_cast<int>(def_.nodes.size()));
    const NodeDef& node = def_.nodes[static_cast<std::size_t>(force.node)];
    const Anchor at = AnchorAt(node.body, node.position_m);
    if (at.body < 0) continue;
    loads.push_back({at, force.force_n});
    Acts(at);
  }
}

void Structure::AddTouches() {
  const auto add = [&](int body, const Vec3& place, double radius) {
    const Anchor at = AnchorAt(body, place);
    if (at.body < 0 || def_.planes.empty()) return;
    Acts(at);
    for (std::size_t p = 0; p < def_.planes.size(); ++p) {
      const PlaneDef& plane = def_.planes[p];
      touches.push_back({at, static_cast<int>(p), plane.normal,
                         Dot(plane.normal, plane.point_m) + radius, radius});
    }
  };
  EachShape(def_, [&](const auto& shape) {
    if (!shape.collides) return;
    math::EachCorner(shape,
                     [&](const Vec3& corner) { add(shape.body, corner, math::RadiusOf(shape)); });
  });
}

void Structure::Measure() {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  const auto take = [&](const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  };
  for (const Vec3& center : start.center_m) take(center);
  for (const CableDef& cable : def_.cables) {
    for (const AttachmentDef& at : cable.attachments) take(at.position_m);
  }
  for (const JointDef& joint : def_.joints) take(joint.from_m), take(joint.to_m);
  for (const Touch& touch : touches) take(PlaceOf(touch.point, start));
  const Vec3 across = high - low;
  size_m = bodies.empty() ? 0 : std::sqrt(Dot(across, across));
  if (!(size_m > 0)) size_m = 1;

  double force_n = 0;
  for (const Vec3& weight : weight_n) force_n += std::sqrt(Dot(weight, weight));
  for (const Load& load : loads) force_n += std::sqrt(Dot(load.force_n, load.force_n));
  for (const PlacedJoint& joint : joints) {
    if (IsAngle(joint.def.kind)) force_n += joint.def.stiffness / size_m;
  }
  stiffness_n_per_m = std::max(stiffness_n_per_m, force_n / size_m);
  if (stiffness_n_per_m == 0) stiffness_n_per_m = 1;
}

Coordinate Structure::RowAt(std::size_t row, const Placement& at) const {
  return HeldAt(joints[rows[row].joint], rows[row].row, at);
}

Coordinate Structure::GapAt(std::size_t touch, const Placement& at) const {
  const Touch& t = touches[touch];
  return PointAlong(t.point, t.normal, t.offset_m, at);
}

double Structure::Tension(const Cable& cable, double length_m) const {
  return std::fmax(0.0, math::CableLaw{cable.stiffness}.Force(length_m - cable.rest_m));
}

double Structure::Energy(const Placement& at, Eigen::VectorXd& gradient,
                         Eigen::MatrixXd* hessian) const {
  gradient = Eigen::VectorXd::Zero(motions());
  if (hessian != nullptr) *hessian = Eigen::MatrixXd::Zero(motions(), motions());
  double energy = 0;
  for (const Cable& cable : cables) {
    const Coordinate length = cable.path.At(at, hessian != nullptr);
    const double tension = Tension(cable, length.value);
    if (tension == 0) continue;
    const math::CableLaw law{cable.stiffness};
    const double stretch = length.value - cable.rest_m;
    energy += law.Energy(stretch);
    Add(length, tension, law.Slope(stretch), gradient, hessian);
  }
  for (const PlacedJoint& joint : joints) {
    if (joint.def.stiffness == 0) continue;
    const Coordinate spring = SpringEnergyAt(joint, at);
    energy += spring.value;
    Add(spring, 1, 0, gradient, hessian);
  }
  for (const Load& load : loads) {
    const Coordinate work = PointAlong(load.point, load.force_n, 0, at);
    energy -= work.value;
    Add(work, -1, 0, gradient, hessian);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    energy -= Dot(weight_n[b], at.center_m[b]);
    gradient.segment<3>(6 * static_cast<Eigen::Index>(b)) -= Of(weight_n[b]);
  }
  return energy;
}

void Structure::AddReactions(const Placement& at, const Reactions& holding,
                             Eigen::VectorXd& gradient, Eigen::MatrixXd* hessian) const {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    Add(RowAt(r, at), holding.rows[static_cast<Eigen::Index>(r)], 0, gradient, hessian);
  }
  for (std::size_t t = 0; t < touches.size(); ++t) {
    const double push = holding.touches[static_cast<Eigen::Index>(t)];
    if (push != 0) Add(GapAt(t, at), -push, 0, gradient, hessian);
  }
}

}  // namespace taut::analysis
