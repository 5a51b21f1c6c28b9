#include "analysis/joint_coordinates.h"

#include <cmath>

#include "analysis/jet.h"
#include "math/vec.h"

namespace taut::analysis {
namespace {

/// One of the two bodies of a joint. `first`: index of the first of its six motions.
struct Side {
  Anchor anchor;
  const Placement* at;
  int first;

  bool moves() const { return anchor.body >= 0; }
  JetVec Turn() const {
    if (!moves()) return JetVec::Of({});
    return {Jet::Motion(first + 3), Jet::Motion(first + 4), Jet::Motion(first + 5)};
  }
  /// Rotates a direction by exp(theta), to second order. `described`: the direction in the
  /// described pose, in W.
  JetVec Direction(const Vec3& described) const {
    JetVec now = JetVec::Of(ArmOf({anchor.body, described}, *at));
    if (!moves()) return now;
    const JetVec swept = Cross(Turn(), now);
    return now + swept + 0.5 * Cross(Turn(), swept);
  }
  JetVec Point() const {
    if (!moves()) return JetVec::Of(anchor.at_m);
    const JetVec way{Jet::Motion(first), Jet::Motion(first + 1), Jet::Motion(first + 2)};
    return JetVec::Of(at->center_m[static_cast<std::size_t>(anchor.body)]) + way +
           Direction(anchor.at_m);
  }
  Quat turn() const { return moves() ? at->turn[static_cast<std::size_t>(anchor.body)] : Quat{}; }
};

struct Sides {
  Side a, b;
  Sides(const PlacedJoint& joint, const Placement& at) : a{joint.a, &at, 0}, b{joint.b, &at, 6} {}
  JetVec Apart() const { return b.Point() - a.Point(); }
  Jet Distance() const {
    const JetVec apart = Apart();
    return Sqrt(Dot(apart, apart));
  }

  /// Converts a jet to a coordinate that depends on the moving bodies only.
  Coordinate Local(const Jet& jet) const {
    Coordinate c;
    c.value = jet.value;
    std::vector<int> firsts;
    for (const Side* side : {&a, &b}) {
      if (!side->moves()) continue;
      c.bodies.push_back(side->anchor.body);
      firsts.push_back(side->first);
    }
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(firsts.size());
    c.gradient.resize(size);
    c.hessian.resize(size, size);
    for (std::size_t i = 0; i < firsts.size(); ++i) {
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(i);
      c.gradient.segment<6>(row) = jet.gradient.segment<6>(firsts[i]);
      for (std::size_t j = 0; j < firsts.size(); ++j) {
        c.hessian.block<6, 6>(row, 6 * static_cast<Eigen::Index>(j)) =
            jet.hessian.block<6, 6>(firsts[i], firsts[j]);
      }
    }
    return c;
  }
};

/// exp(theta) as a quaternion, to second order: (1 - |theta|^2 / 8, theta / 2).
struct JetQuat {
  Jet w;
  JetVec v;
};
JetQuat SmallTurn(const Side& side, double sign) {
  const JetVec turn = side.Turn();
  return {Jet::Of(1) - 0.125 * Dot(turn, turn), (0.5 * sign) * turn};
}
JetQuat operator*(const JetQuat& p, const JetQuat& q) {
  return {p.w * q.w - Dot(p.v, q.v), p.w * q.v + q.w * p.v + Cross(p.v, q.v)};
}

/// Returns the square of the relative rotation angle of a ball joint, (2 asin(s))^2, as a function
/// of s^2. s is the vector part of the relative quaternion. A series near s = 0 keeps the function
/// smooth.
Jet SquaredTurn(const PlacedJoint& joint, const Sides& sides) {
  const Quat now = sides.b.turn() * joint.def.turned * Conjugate(sides.a.turn());
  const JetQuat turn = SmallTurn(sides.b, 1) *
                       JetQuat{Jet::Of(now.w), JetVec::Of({now.x, now.y, now.z})} *
                       SmallTurn(sides.a, -1);
  const Jet s2 = Dot(turn.v, turn.v);
  const double x = std::fmin(s2.value, 1.0);
  if (x < 1e-4) {  // the series has a relative truncation error below x^4
    return Apply(s2, 4 * x * (1 + x * (1.0 / 3 + x * (8.0 / 45 + x * 4.0 / 35))),
                 4 * (1 + x * (2.0 / 3 + x * (8.0 / 15 + x * 16.0 / 35))),
                 4 * (2.0 / 3 + x * (16.0 / 15 + x * 48.0 / 35)));
  }
  const double angle = std::asin(std::sqrt(x)), sc = std::sqrt(std::fmax(x - x * x, 1e-30));
  return Apply(s2, 4 * angle * angle, 4 * angle / sc,
               2 * (1 / (sc * sc) - angle * (1 - 2 * x) / (sc * sc * sc)));
}

Jet Held(const PlacedJoint& joint, HeldRow row, const Sides& sides) {
  const JointAxes axes = AxesOf(joint.def);
  const auto in_a = [&](const Vec3& axis) { return sides.a.Direction(axis); };
  const auto in_b = [&](const Vec3& axis) {
    return sides.b.Direction(Rotate(joint.def.turned, axis));
  };
  switch (row) {
    case HeldRow::kAlong:
      return Dot(in_a(axes.n), sides.Apart());
    case HeldRow::kAcross1:
      return Dot(in_a(axes.s), sides.Apart());
    case HeldRow::kAcross2:
      return Dot(in_a(axes.t), sides.Apart());
    case HeldRow::kSwing1:
      return Dot(in_a(axes.s), in_b(axes.n));
    case HeldRow::kSwing2:
      return Dot(in_a(axes.t), in_b(axes.n));
    case HeldRow::kTwist:
      return Dot(in_a(axes.t), in_b(axes.s));
    case HeldRow::kDistance:
      break;
  }
  const Vec3 described = joint.def.to_m - joint.def.from_m;
  return sides.Distance() - Jet::Of(std::sqrt(Dot(described, described)));
}

/// Returns the angle of a hinge relative to the described pose, between -pi and pi [rad].
Jet HingeAngle(const PlacedJoint& joint, const Sides& sides) {
  const JointAxes axes = AxesOf(joint.def);
  const Quat& turned = joint.def.turned;
  const double start =
      2 * std::atan2(Dot(axes.n, {turned.x, turned.y, turned.z}) * (turned.w < 0 ? -1 : 1),
                     std::fabs(turned.w));
  const JetVec now = sides.b.Direction(Rotate(turned, axes.s));
  const Vec3 from = std::cos(start) * axes.s + std::sin(start) * axes.t;
  return Jet::Of(start) +
         Atan2(Dot(sides.a.Direction(Cross(axes.n, from)), now), Dot(sides.a.Direction(from), now));
}

}  // namespace

Coordinate HeldAt(const PlacedJoint& joint, HeldRow row, const Placement& at) {
  const Sides sides(joint, at);
  return sides.Local(Held(joint, row, sides));
}

Coordinate DistanceAt(const PlacedJoint& joint, const Placement& at) {
  const Sides sides(joint, at);
  return sides.Local(sides.Distance());
}

Coordinate SpringEnergyAt(const PlacedJoint& joint, const Placement& at) {
  const Sides sides(joint, at);
  const double half = 0.5 * joint.def.stiffness;
  if (joint.def.kind == JointKind::kBall) {
    return sides.Local(half * SquaredTurn(joint, sides));
  }
  const Jet stretch = [&] {
    if (joint.def.kind == JointKind::kHinge) return HingeAngle(joint, sides);
    if (joint.def.kind == JointKind::kDistance) return sides.Distance();
    return Held(joint, HeldRow::kAlong, sides);
  }() - Jet::Of(joint.def.rest);
  return sides.Local(half * (stretch * stretch));
}

Wrench LoadOf(const PlacedJoint& joint, const Coordinate& c, double force, const Placement& at) {
  for (std::size_t i = 0; i < c.bodies.size(); ++i) {
    const bool is_b = c.bodies[i] == joint.b.body;
    const Eigen::Index from = 6 * static_cast<Eigen::Index>(i);
    const double sign = is_b ? force : -force;
    const Vec3 pull = sign * To(c.gradient.segment<3>(from));
    const Vec3 about_center = sign * To(c.gradient.segment<3>(from + 3));
    const Vec3 center = at.center_m[static_cast<std::size_t>(c.bodies[i])];
    if (is_b || joint.b.body < 0) {
      return {pull, about_center - Cross(PlaceOf(joint.b, at) - center, pull)};
    }
  }
  return {};
}

}  // namespace taut::analysis
