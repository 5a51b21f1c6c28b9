/// Masses and inertias of simple solids, and vector arithmetic for scenes.
#pragma once

#include <cmath>

#include "taut/model_def.h"

namespace taut::scenes {

inline Vec3 Sum(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 Scaled(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vec3 Between(const Vec3& from, const Vec3& to) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}
inline double LengthOf(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

/// Returns a rotation by `angle_rad` about a unit `axis`.
inline Quat Turn(const Vec3& axis, double angle_rad) {
  const double c = std::cos(angle_rad / 2), s = std::sin(angle_rad / 2);
  return {c, s * axis.x, s * axis.y, s * axis.z};
}

inline Vec3 Turned(const Quat& q, const Vec3& a) {
  const Vec3 t{2 * (q.y * a.z - q.z * a.y), 2 * (q.z * a.x - q.x * a.z),
               2 * (q.x * a.y - q.y * a.x)};
  return {a.x + q.w * t.x + q.y * t.z - q.z * t.y, a.y + q.w * t.y + q.z * t.x - q.x * t.z,
          a.z + q.w * t.z + q.x * t.y - q.y * t.x};
}

inline Inertia SphereInertia(double mass_kg, double radius_m) {
  const double j = 0.4 * mass_kg * radius_m * radius_m;
  return {.xx = j, .yy = j, .zz = j};
}

inline Inertia BoxInertia(double mass_kg, const Vec3& half_m) {
  const double x = half_m.x * half_m.x, y = half_m.y * half_m.y, z = half_m.z * half_m.z;
  return {.xx = mass_kg / 3 * (y + z), .yy = mass_kg / 3 * (x + z), .zz = mass_kg / 3 * (x + y)};
}

/// Returns an inertia with principal moments j.xx, j.yy, j.zz about axes rotated by q.
inline Inertia TurnedInertia(const Inertia& j, const Quat& q) {
  const Vec3 a = Turned(q, Vec3{1, 0, 0}), b = Turned(q, Vec3{0, 1, 0}),
             c = Turned(q, Vec3{0, 0, 1});
  const auto entry = [&](double Vec3::*p, double Vec3::*r) {
    return j.xx * (a.*p) * (a.*r) + j.yy * (b.*p) * (b.*r) + j.zz * (c.*p) * (c.*r);
  };
  return {entry(&Vec3::x, &Vec3::x), entry(&Vec3::y, &Vec3::y), entry(&Vec3::z, &Vec3::z),
          entry(&Vec3::x, &Vec3::y), entry(&Vec3::x, &Vec3::z), entry(&Vec3::y, &Vec3::z)};
}

/// Adds up parts of a rigid body: mass, center and inertia about W's origin, then about the center.
class Parts {
 public:
  void AddPoint(double mass_kg, const Vec3& p) {
    mass_kg_ += mass_kg;
    moment_ = Sum(moment_, Scaled(mass_kg, p));
    inertia_.xx += mass_kg * (p.y * p.y + p.z * p.z);
    inertia_.yy += mass_kg * (p.x * p.x + p.z * p.z);
    inertia_.zz += mass_kg * (p.x * p.x + p.y * p.y);
    inertia_.xy -= mass_kg * p.x * p.y;
    inertia_.xz -= mass_kg * p.x * p.z;
    inertia_.yz -= mass_kg * p.y * p.z;
  }
  void AddSphere(double mass_kg, const Vec3& p, double radius_m) {
    AddPoint(mass_kg, p);
    const Inertia own = SphereInertia(mass_kg, radius_m);
    inertia_.xx += own.xx;
    inertia_.yy += own.yy;
    inertia_.zz += own.zz;
  }
  /// Adds a solid cylinder.
  void AddCylinder(double mass_kg, const Vec3& from, const Vec3& to, double radius_m) {
    // Two points on the axis at 1/sqrt(3) of the half length have a thin rod's moments.
    const Vec3 mid = Scaled(0.5, Sum(from, to)), half = Scaled(0.5, Between(from, to));
    AddPoint(mass_kg / 2, Sum(mid, Scaled(1 / std::sqrt(3.0), half)));
    AddPoint(mass_kg / 2, Sum(mid, Scaled(-1 / std::sqrt(3.0), half)));
    const Vec3 d = Between(from, to);
    const Vec3 u = Scaled(1 / LengthOf(d), d);
    // twice that about the cylinder's axis
    const double across = mass_kg * radius_m * radius_m / 4;
    inertia_.xx += across * (1 + u.x * u.x);
    inertia_.yy += across * (1 + u.y * u.y);
    inertia_.zz += across * (1 + u.z * u.z);
    inertia_.xy += across * u.x * u.y;
    inertia_.xz += across * u.x * u.z;
    inertia_.yz += across * u.y * u.z;
  }

  /// Returns a body with the mass, center of mass and inertia of the sum.
  BodyDef Body(const std::string& name) const {
    BodyDef body;
    body.name = name;
    body.mass_kg = mass_kg_;
    const Vec3 c = Scaled(1 / mass_kg_, moment_);
    body.com_m = c;
    body.inertia_kg_m2 = {inertia_.xx - mass_kg_ * (c.y * c.y + c.z * c.z),
                          inertia_.yy - mass_kg_ * (c.x * c.x + c.z * c.z),
                          inertia_.zz - mass_kg_ * (c.x * c.x + c.y * c.y),
                          inertia_.xy + mass_kg_ * c.x * c.y,
                          inertia_.xz + mass_kg_ * c.x * c.z,
                          inertia_.yz + mass_kg_ * c.y * c.z};
    return body;
  }

 private:
  double mass_kg_ = 0;
  Vec3 moment_;      ///< Sum of mass times position [kg m].
  Inertia inertia_;  ///< Inertia about W's origin.
};

}  // namespace taut::scenes
