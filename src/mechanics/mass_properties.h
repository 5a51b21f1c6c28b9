/// Mass, center of mass and inertia of solids and of rigid assemblies.
#pragma once

#include <vector>

#include "math/triangles.h"
#include "taut/types.h"

namespace taut {

/// All in W; the inertia is about the center of mass, with axes parallel to W.
struct MassProperties {
  double mass_kg = 0.0;
  Vec3 com_m;
  Inertia inertia_kg_m2;
};

// Homogeneous solids.
/// Returns the properties of a straight cylinder with flat ends; its axis is from..to (which
/// differ).
MassProperties SolidCylinder(const Vec3& from_m, const Vec3& to_m, double radius_m, double mass_kg);
/// Returns the properties of a cylinder with half spheres at its ends; from..to is the axis without
/// them.
MassProperties SolidCapsule(const Vec3& from_m, const Vec3& to_m, double radius_m, double mass_kg);
MassProperties SolidSphere(const Vec3& center_m, double radius_m, double mass_kg);
MassProperties SolidBox(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m,
                        double mass_kg);

/// Returns the properties of the solid that closed triangles enclose (math/triangles.h). After
/// Tonon (2005), "Explicit exact formulas for the 3-D tetrahedron inertia tensor": a sum over
/// tetrahedra from one point to every triangle.
MassProperties SolidMesh(const std::vector<Vec3>& corners_m, const math::Triangles& triangles,
                         double density_kg_per_m3);

/// Returns an inertia rotated by q: R I R^T.
Inertia Turned(const Quat& q, const Inertia& inertia);

/// Returns the parts as one rigid body (parallel axes). Without parts, or without mass: all zero.
MassProperties Combine(const std::vector<MassProperties>& parts);

/// Axis-aligned bounds; initially empty.
struct Bounds {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void Add(const Vec3& center_m, const Vec3& half_extents_m);
};

Bounds SphereBounds(const Vec3& center_m, double radius_m);
Bounds BoxBounds(const Vec3& center_m, const Quat& q_WBox, const Vec3& half_extents_m);
/// Returns the bounds of the square prism around a cylinder, rotated the shortest way from z to the
/// axis: Bullet's bounds of a cylinder made by NTRT (whose "up" is z here).
Bounds BulletCylinderBounds(const Vec3& from_m, const Vec3& to_m, double radius_m);
Bounds Union(const Bounds& a, const Bounds& b);

/// Returns the inertia of a solid box that fills `bounds`: Bullet 2.82's inertia of a compound.
Inertia BoundingBoxInertia(const Bounds& bounds, double mass_kg);

}  // namespace taut
