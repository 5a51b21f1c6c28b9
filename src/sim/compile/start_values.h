/// Initial values of the rows of a world (state_rows.h). `i`: index of the body, cable or contact.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "sim/data/group.h"
#include "sim/data/tables.h"
#include "sim/geometry/line_crossing.h"

namespace taut::sim::start_of {

using Number = double;
using V3 = Vec3;
using Q4 = Quat;
using Motor = MotorNumbers<double>;
using Orders = MotorOrders<double>;
using WrapPoint = WrapPointNumbers<double>;

/// Zero for rows of any type.
struct Nothing {
  operator double() const noexcept { return 0.0; }
  operator Vec3() const noexcept { return {}; }
};
inline Nothing Zero(const Tables&, int) noexcept { return {}; }
inline double One(const Tables&, int) noexcept { return 1.0; }
inline double NoKey(const Tables&, int) noexcept { return kNoKey; }
inline double SlipUnknown(const Tables&, int) noexcept { return kSlipUnknown; }
/// Placeholder: WorldBatch::Impl::JudgeStiffness sets this row once masses, stiffnesses and
/// dampings are set.
inline Nothing ByJudgeStiffness(const Tables&, int) noexcept { return {}; }

inline const BodyDef& BodyOf(const Tables& t, int i) noexcept {
  return t.def().bodies[static_cast<std::size_t>(i)];
}
inline const CableDef& CableOf(const Tables& t, int i) noexcept {
  return t.def().cables[static_cast<std::size_t>(i)];
}

inline Vec3 CentreOfMass(const Tables& t, int i) noexcept { return BodyOf(t, i).com_m; }
inline Quat PrincipalFrame(const Tables& t, int i) noexcept {
  const double* const q = &t.q_WP0[static_cast<std::size_t>(4 * i)];
  return {q[0], q[1], q[2], q[3]};
}
inline Vec3 Velocity(const Tables& t, int i) noexcept {
  return BodyOf(t, i).fixed ? Vec3{} : BodyOf(t, i).velocity_m_per_s;
}
inline Vec3 Spin(const Tables& t, int i) noexcept {
  return BodyOf(t, i).fixed ? Vec3{} : BodyOf(t, i).angular_velocity_rad_per_s;
}
inline Vec3 AngularMomentum(const Tables& t, int i) noexcept {
  const Inertia& j = BodyOf(t, i).inertia_kg_m2;
  const Vec3& w = BodyOf(t, i).angular_velocity_rad_per_s;
  if (BodyOf(t, i).fixed) return {};
  return {j.xx * w.x + j.xy * w.y + j.xz * w.z, j.xy * w.x + j.yy * w.y + j.yz * w.z,
          j.xz * w.x + j.yz * w.y + j.zz * w.z};
}

/// Mass properties for another mass than in the definition; the inertia is scaled with the mass.
/// All values are zero for a fixed body.
struct Masses {
  double mass = 0, inv_mass = 0;
  Vec3 inertia, inv_inertia;
};
inline Masses MassesOf(const Tables& t, int i, double mass_kg) noexcept {
  const BodyDef& def = BodyOf(t, i);
  if (def.fixed) return {};
  const double* const moments = &t.inertia[static_cast<std::size_t>(3 * i)];
  const double scale = mass_kg / def.mass_kg;
  const Vec3 inertia{moments[0] * scale, moments[1] * scale, moments[2] * scale};
  return {mass_kg, 1.0 / mass_kg, inertia, {1.0 / inertia.x, 1.0 / inertia.y, 1.0 / inertia.z}};
}
inline double Mass(const Tables& t, int i) noexcept {
  return MassesOf(t, i, BodyOf(t, i).mass_kg).mass;
}
inline double InverseMass(const Tables& t, int i) noexcept {
  return MassesOf(t, i, BodyOf(t, i).mass_kg).inv_mass;
}
inline Vec3 Moments(const Tables& t, int i) noexcept {
  return MassesOf(t, i, BodyOf(t, i).mass_kg).inertia;
}
inline Vec3 InverseMoments(const Tables& t, int i) noexcept {
  return MassesOf(t, i, BodyOf(t, i).mass_kg).inv_inertia;
}

inline double WheelAngle(const Tables& t, int i) noexcept {
  return t.wheels[static_cast<std::size_t>(i)].start_angle;
}
inline double SpanRest(const Tables& t, int i) noexcept {
  return t.span_rest_m[static_cast<std::size_t>(i)];
}
inline double SlipPlace(const Tables& t, int i) noexcept {
  return t.slips[static_cast<std::size_t>(i)].start_place;
}
inline double NotHeld(const Tables&, int) noexcept { return kNotHeld; }
inline double RestLength(const Tables& t, int i) noexcept { return CableOf(t, i).rest_length_m; }
inline double Stiffness(const Tables& t, int i) noexcept { return CableOf(t, i).stiffness_n_per_m; }
inline double Damping(const Tables& t, int i) noexcept { return CableOf(t, i).damping_n_s_per_m; }
/// Tension for the first solver start, and the reading before the first step.
inline double Tension(const Tables& t, int i) noexcept {
  return t.start_tension_n[static_cast<std::size_t>(i)];
}
inline double SpanTension(const Tables& t, int i) noexcept {
  int cable = 0;
  const auto behind = [&] {
    const CableTable& table = t.cables[static_cast<std::size_t>(cable)];
    return i >= table.first_span + table.span_count;
  };
  while (behind()) ++cable;
  return t.span_rest_m[static_cast<std::size_t>(i)] > 0 ? Tension(t, cable) : 0;
}
inline Motor MotorAtRest(const Tables& t, int i) noexcept {
  const MotorTable& table = t.motors[static_cast<std::size_t>(i)];
  Motor motor{};
  motor.winding = motor.housing = table.ambient_c;
  motor.supply = t.supplies[static_cast<std::size_t>(table.supply)].voltage_v;
  return motor;
}
/// Side on which the cable passes the rod in the described pose.
inline double TouchSide(const Tables& t, int i) noexcept {
  const TouchRodTable& rod = t.touch_rods[static_cast<std::size_t>(i)];
  const auto in_W = [&](const double* p_P) {
    return Rotate(PrincipalFrame(t, rod.body), {p_P[0], p_P[1], p_P[2]});
  };
  std::size_t cable = 0;
  while (i >= t.touches[cable].first_rod + t.touches[cable].rod_count) ++cable;
  const auto& ends = CableOf(t, t.touches[cable].cable).attachments;
  return SideOf(CrossingOf(ends[0].position_m, ends[1].position_m,
                           CentreOfMass(t, rod.body) + in_W(rod.center_P), in_W(rod.axis_P)),
                rod.half_m);
}
inline WrapPoint NoWrapPoint(const Tables&, int) noexcept { return kNoWrapPoint; }
inline Orders FollowTarget(const Tables&, int) noexcept { return {0.0, 0.0, 1.0}; }
inline Vec3 Gravity(const Tables& t, int) noexcept { return t.def().gravity_m_per_s2; }

}  // namespace taut::sim::start_of
