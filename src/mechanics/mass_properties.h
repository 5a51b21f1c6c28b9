/// Mass, center of mass and inertia of solids and of rigid assemblies.
#pragma once

#include <vector>

#include "math/triangles.h"
#include "taut/types.h"

namespace taut {

/// Mass and center in W; inertia about the center of mass, in axes parallel to W.
struct MassProperties {
  double mass_kg = 0.0;
  Vec3 com_m;
  Inertia inertia_kg_m2;
};

// Homogeneous solids.
/// Returns the properties of a cylinder with flat ends. Its axis runs from `from_m` to a different
/// point `to_m`.
MassProperties SolidCylinder(const Vec3& from_m, const Vec3& to_m, double radius_m, double mass_kg);
/// Returns the properties of a cylinder with half balls at both ends. `from_m` and `to_m`: end
/// points of the cylinder's axis.
MassProperties SolidCapsule(const Vec3& from_m, const Vec3& to_m, double radius_m, double mass_kg);
MassProperties SolidSphere(const Vec3& center_m, double radius_m, double mass_kg);
MassProperties SolidBox(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m,
                        double mass_kg);

/// Returns the properties of the solid enclosed by closed triangles (math/triangles.h). It is a sum
/// over tetrahedra from one point to every triangle, with the formulas of Tonon (2005), "Explicit
/// exact formulas for the 3-D tetrahedron inertia tensor".
MassProperties SolidMesh(const std::vector<Vec3>& corners_m, const math::Triangles& triangles,
                         double density_kg_per_m3);

/// Returns the inertia rotated by q: R I R^T.
Inertia Turned(const Quat& q, const Inertia& inertia);

/// Returns the properties of all parts as one rigid body (parallel axes); zero without parts or
/// mass.
MassProperties Combine(const std::vector<MassProperties>& parts);

/// Axis-aligned bounding box; empty at first.
struct Bounds {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void Add(const Vec3& center_m, const Vec3& half_extents_m);
};

Bounds SphereBounds(const Vec3& center_m, double radius_m);
Bounds BoxBounds(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m);
/// Returns the bounds of the square prism around a cylinder, rotated from z to the axis by the
/// smallest angle. These are Bullet's bounds of NTRT's cylinders (whose "up" is z here).
Bounds BulletCylinderBounds(const Vec3& from_m, const Vec3& to_m, double radius_m);
Bounds Union(const Bounds& a, const Bounds& b);

/// Returns the inertia of a homogeneous box that fills `bounds`, as Bullet 2.82 uses for compounds.
Inertia BoundingBoxInertia(const Bounds& bounds, double mass_kg);

}  // namespace taut
