/// Mass, centre and inertia of solids and of what is welded from them.
#pragma once

#include <vector>

#include "math/triangles.h"
#include "taut/types.h"

namespace taut {

/// All in W, the inertia about the centre of mass in axes parallel to W.
struct MassProperties {
  double mass_kg = 0.0;
  Vec3 com_m;
  Inertia inertia_kg_m2;
};

// Homogeneous solids.
/// A straight cylinder with flat ends, its axis from..to (which differ).
MassProperties SolidCylinder(const Vec3& from_m, const Vec3& to_m, double radius_m, double mass_kg);
/// A cylinder whose ends are half spheres, its axis without those from..to.
MassProperties SolidCapsule(const Vec3& from_m, const Vec3& to_m, double radius_m, double mass_kg);
MassProperties SolidSphere(const Vec3& center_m, double radius_m, double mass_kg);
MassProperties SolidBox(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m,
                        double mass_kg);

/// What closed triangles enclose (math/triangles.h). After Tonon (2005), "Explicit exact formulas
/// for the 3-D tetrahedron inertia tensor": of tetrahedra from one point to every triangle.
MassProperties SolidMesh(const std::vector<Vec3>& corners_m, const math::Triangles& triangles,
                         double density_kg_per_m3);

/// Of what is turned by q: R I R^T.
Inertia Turned(const Quat& q, const Inertia& inertia);

/// The parts as one rigid body (parallel axes). No parts, or none with mass: all zero.
MassProperties Combine(const std::vector<MassProperties>& parts);

/// Axes-parallel bounds; starts empty.
struct Bounds {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void Add(const Vec3& center_m, const Vec3& half_extents_m);
};

Bounds SphereBounds(const Vec3& center_m, double radius_m);
Bounds BoxBounds(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m);
/// Of the square prism around a cylinder, turned from z to the axis the shortest way: what Bullet
/// takes for the bounds of a cylinder that NTRT made (whose "up" is our z).
Bounds BulletCylinderBounds(const Vec3& from_m, const Vec3& to_m, double radius_m);
Bounds Union(const Bounds& a, const Bounds& b);

/// Of a solid box that fills `bounds`: what Bullet 2.82 takes for the inertia of a compound.
Inertia BoundingBoxInertia(const Bounds& bounds, double mass_kg);

}  // namespace taut
