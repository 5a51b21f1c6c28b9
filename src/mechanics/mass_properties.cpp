#include "mechanics/mass_properties.h"

#include "taut/statics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/principal_axes.h"
#include "math/vec.h"

namespace taut {
namespace {

/// Returns the inertia with the moment `along` about the unit vector u and `across` about normal
/// axes.
Inertia AxiallySymmetric(const Vec3& u, double along, double across) {
  const double d = along - across;
  return {across + d * u.x * u.x, across + d * u.y * u.y, across + d * u.z * u.z,
          d * u.x * u.y,          d * u.x * u.z,          d * u.y * u.z};
}

Inertia operator+(const Inertia& a, const Inertia& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}

/// Returns the inertia of a point mass at r.
Inertia PointInertia(double mass, const Vec3& r) {
  return {mass * (r.y * r.y + r.z * r.z),
          mass * (r.x * r.x + r.z * r.z),
          mass * (r.x * r.x + r.y * r.y),
          -mass * r.x * r.y,
          -mass * r.x * r.z,
          -mass * r.y * r.z};
}

Vec3 Abs(const Vec3& a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }

/// Returns the smallest rotation that maps z to the unit vector u.
Quat FromZ(const Vec3& u) {
  const double w = std::sqrt(0.5 * (1.0 + std::max(-1.0, u.z)));
  if (w < 1e-9) return {0.0, 1.0, 0.0, 0.0};  // u points down: any half turn
  const double s = 0.5 / w;
  return {w, -u.y * s, u.x * s, 0.0};
}

}  // namespace

MassProperties SolidCylinder(const Vec3& from_m, const Vec3& to_m, double radius_m,
                             double mass_kg) {
  const Vec3 axis = to_m - from_m;
  const double length = std::sqrt(Dot(axis, axis));
  const double along = 0.5 * mass_kg * radius_m * radius_m;
  const double across = mass_kg / 12.0 * (3.0 * radius_m * radius_m + length * length);
  return {mass_kg, 0.5 * (from_m + to_m), AxiallySymmetric((1.0 / length) * axis, along, across)};
}

MassProperties SolidCapsule(const Vec3& from_m, const Vec3& to_m, double radius_m, double mass_kg) {
  const Vec3 axis = to_m - from_m;
  const double l = std::sqrt(Dot(axis, axis)), r = radius_m;
  const double ends = mass_kg * 4.0 * r / (3.0 * l + 4.0 * r), middle = mass_kg - ends;
  const double along = 0.5 * middle * r * r + 0.4 * ends * r * r;
  // The center of mass of a half ball is at 3/8 r from its flat side.
  const double across =
      middle / 12.0 * (3.0 * r * r + l * l) + ends * (0.4 * r * r + 0.25 * l * l + 0.375 * l * r);
  return {mass_kg, 0.5 * (from_m + to_m), AxiallySymmetric((1.0 / l) * axis, along, across)};
}

MassProperties SolidSphere(const Vec3& center_m, double radius_m, double mass_kg) {
  const double moment = 0.4 * mass_kg * radius_m * radius_m;
  return {mass_kg, center_m, {moment, moment, moment, 0.0, 0.0, 0.0}};
}

MassProperties SolidBox(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m,
                        double mass_kg) {
  const Vec3 h = half_extents_m;
  const double third = mass_kg / 3.0;
  const Vec3 moments{third * (h.y * h.y + h.z * h.z), third * (h.x * h.x + h.z * h.z),
                     third * (h.x * h.x + h.y * h.y)};
  const Inertia inertia = AxiallySymmetric(Rotate(q_WBox, {1, 0, 0}), moments.x, 0.0) +
                          AxiallySymmetric(Rotate(q_WBox, {0, 1, 0}), moments.y, 0.0) +
                          AxiallySymmetric(Rotate(q_WBox, {0, 0, 1}), moments.z, 0.0);
  return {mass_kg, center_m, inertia};
}

MassProperties SolidMesh(const std::vector<Vec3>& corners_m, const math::Triangles& triangles,
                         double density_kg_per_m3) {
  // relative to a corner, to avoid cancellation far from the origin
  const Vec3 from = corners_m[static_cast<std::size_t>(triangles.front()[0])];
  double volume_m3 = 0.0;
  Vec3 first;  // first moments of the volume: integrals of x, y, z
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
  for (const std::array<int, 3>& t : triangles) {
    const auto corner = [&](std::size_t k) {
      return corners_m[static_cast<std::size_t>(t[k])] - from;
    };
    const Vec3 a = corner(0), b = corner(1), c = corner(2), sum = a + b + c;
    const double volume = Dot(a, Cross(b, c)) / 6.0;
    volume_m3 += volume;
    first = first + (0.25 * volume) * sum;
    const auto second = [&](double Vec3::*u, double Vec3::*v) {
      return volume / 20.0 * (a.*u * a.*v + b.*u * b.*v + c.*u * c.*v + sum.*u * sum.*v);
    };
    xx += second(&Vec3::x, &Vec3::x), yy += second(&Vec3::y, &Vec3::y);
    zz += second(&Vec3::z, &Vec3::z), xy += second(&Vec3::x, &Vec3::y);
    xz += second(&Vec3::x, &Vec3::z), yz += second(&Vec3::y, &Vec3::z);
  }
  const Vec3 com = (1.0 / volume_m3) * first;
  const double d = density_kg_per_m3, mass_kg = d * volume_m3;
  const Inertia about_corner{d * (yy + zz), d * (xx + zz), d * (xx + yy),
                             -d * xy,       -d * xz,       -d * yz};
  return {mass_kg, from + com, about_corner + PointInertia(-mass_kg, com)};
}

Inertia Turned(const Quat& q, const Inertia& i) {
  // rotates the columns of I, then the rows of the result
  const Vec3 x = Rotate(q, {i.xx, i.xy, i.xz}), y = Rotate(q, {i.xy, i.yy, i.yz}),
             z = Rotate(q, {i.xz, i.yz, i.zz});
  const Vec3 a = Rotate(q, {x.x, y.x, z.x}), b = Rotate(q, {x.y, y.y, z.y}),
             c = Rotate(q, {x.z, y.z, z.z});
  return {a.x, b.y, c.z, 0.5 * (a.y + b.x), 0.5 * (a.z + c.x), 0.5 * (b.z + c.y)};
}

MassProperties Combine(const std::vector<MassProperties>& parts) {
  MassProperties whole;
  for (const MassProperties& part : parts) {
    whole.mass_kg += part.mass_kg;
    whole.com_m = whole.com_m + part.mass_kg * part.com_m;
  }
  if (whole.mass_kg == 0.0) return {};
  whole.com_m = (1.0 / whole.mass_kg) * whole.com_m;
  for (const MassProperties& part : parts) {
    whole.inertia_kg_m2 = whole.inertia_kg_m2 + part.inertia_kg_m2 +
                          PointInertia(part.mass_kg, part.com_m - whole.com_m);
  }
  return whole;
}

void Bounds::Add(const Vec3& center_m, const Vec3& half_extents_m) {
  *this = Union(*this, {center_m - half_extents_m, center_m + half_extents_m});
}

Bounds Union(const Bounds& a, const Bounds& b) {
  return {
      {std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
      {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

Bounds SphereBounds(const Vec3& center_m, double radius_m) {
  Bounds bounds;
  bounds.Add(center_m, {radius_m, radius_m, radius_m});
  return bounds;
}

Bounds BoxBounds(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m) {
  const Vec3 h = half_extents_m;
  Bounds bounds;
  bounds.Add(center_m, h.x * Abs(Rotate(q_WBox, {1, 0, 0})) + h.y * Abs(Rotate(q_WBox, {0, 1, 0})) +
                           h.z * Abs(Rotate(q_WBox, {0, 0, 1})));
  return bounds;
}

Bounds BulletCylinderBounds(const Vec3& from_m, const Vec3& to_m, double radius_m) {
  const Vec3 axis = to_m - from_m;
  const double length = std::sqrt(Dot(axis, axis));
  return BoxBounds(0.5 * (from_m + to_m), FromZ((1.0 / length) * axis),
                   {radius_m, radius_m, 0.5 * length});
}

Inertia BoundingBoxInertia(const Bounds& bounds, double mass_kg) {
  const Vec3 half = 0.5 * (bounds.high - bounds.low);
  return SolidBox({}, {}, half, mass_kg).inertia_kg_m2;
}

Vec3 PrincipalMoments(const Inertia& inertia_kg_m2) {
  double axes[9], moments[3];
  PrincipalAxes(inertia_kg_m2, axes, moments);
  std::sort(moments, moments + 3);
  return {moments[0], moments[1], moments[2]};
}

}  // namespace taut
