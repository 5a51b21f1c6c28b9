// Joint readings of a world: coordinate, rate, gap, force.
#include <algorithm>
#include <cmath>

#include "math/angle.h"
#include "math/elementary.h"
#include "sim/batch/batch_impl.h"

namespace taut {
namespace {

Vec3 At(const double* p) { return {p[0], p[1], p[2]}; }

/// Joint point and velocities of one body of a joint, in W.
struct Side {
  Vec3 point_m, velocity_m_per_s, spin_rad_per_s, axes[3];
};

}  // namespace

JointState WorldBatch::Joint(int world, int joint) const noexcept {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  sim::CheckIndex(__func__, "joint", joint, d.view.joint_count);
  const sim::JointTable& j = d.view.joints[joint];
  const auto side = [&](int body, const double* own_P, const double* axes_P) {
    Side s{At(own_P), {}, {}, {At(axes_P), At(axes_P + 3), At(axes_P + 6)}};
    if (body == d.view.body_count) return s;
    const Quat q = d.quat(world, body);
    const BodyState state = Body(world, body);
    const Vec3 arm = Rotate(q, s.point_m);
    s.point_m = state.position_m + arm;
    s.spin_rad_per_s = state.angular_velocity_rad_per_s;
    s.velocity_m_per_s = state.velocity_m_per_s + Cross(s.spin_rad_per_s, arm);
    for (Vec3& axis : s.axes) axis = Rotate(q, axis);
    return s;
  };
  const Side a = side(j.a, j.own_a_P, j.axes_a_P), b = side(j.b, j.own_b_P, j.axes_b_P);
  const Vec3 gap = b.point_m - a.point_m, spin = b.spin_rad_per_s - a.spin_rad_per_s;
  // Velocity of b's point relative to a's point, in the rotating frame of a.
  const Vec3 apart = b.velocity_m_per_s - a.velocity_m_per_s - Cross(a.spin_rad_per_s, gap);
  JointState out;
  out.force_n = d.vec(world, d.layout.joint_force + 3 * joint);
  out.torque_n_m = d.vec(world, d.layout.joint_torque + 3 * joint);
  const auto value = [&](sim::JointMeasure measure) {
    using M = sim::JointMeasure;
    switch (measure) {
      case M::kAlongAxis:
        out.rate = Dot(a.axes[0], apart);
        return Dot(a.axes[0], gap);
      case M::kAcross1:
        return Dot(a.axes[1], gap);
      case M::kAcross2:
        return Dot(a.axes[2], gap);
      case M::kDistance: {
        const double length = std::sqrt(Dot(gap, gap));
        out.rate = Dot(gap, apart) / length;
        return length;
      }
      case M::kSwing1:
      case M::kSwing2:
      case M::kTwist: {
        const sim::MeasuredAxes axes = sim::AxesOf(measure);
        return j.reach_m * Dot(a.axes[axes.of_a], b.axes[axes.of_b]);
      }
      case M::kAngle: {
        const double angle = math::Atan2(Dot(a.axes[2], b.axes[1]), Dot(a.axes[1], b.axes[1]));
        const double last = d.at(world, d.layout.joint_angle + joint);
        out.rate = Dot(a.axes[0], spin);
        return angle + 2 * kPi * std::round((last - angle) / (2 * kPi));
      }
      case M::kTurn1:
      case M::kTurn2:
      case M::kTurn3:  // neither a coordinate nor constrained
      case M::kCone:
        break;
    }
    const Vec3 c = Cross(a.axes[0], b.axes[0]);
    const double sine = std::sqrt(Dot(c, c));
    out.rate = sine > 0 ? Dot(c, spin) / sine : 0;
    return math::Atan2(sine, Dot(a.axes[0], b.axes[0]));
  };
  for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
    const sim::JointRowTable& row = d.view.joint_rows[r];
    if (row.role != sim::JointRole::kHold) break;
    const double held = row.measure == sim::JointMeasure::kDistance ? j.rest : 0.0;
    out.gap_m = std::max(out.gap_m, std::fabs(value(row.measure) - held));
  }
  out.rate = 0;
  if (j.has_coordinate) out.coordinate = value(j.coordinate);
  Vec3 twice_sine;  // twice the sine of the rotation, along its axis
  double cosines = 0;
  for (int i = 0; i < 3; ++i) {
    twice_sine = twice_sine + Cross(a.axes[i], b.axes[i]);
    cosines += Dot(a.axes[i], b.axes[i]);
  }
  out.turned_rad = math::Atan2(std::sqrt(Dot(twice_sine, twice_sine)), cosines - 1);
  return out;
}

}  // namespace taut
