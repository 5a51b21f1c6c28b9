/// Triangle meshes of a robot for rendering and 3D printing, as STL and glTF (docs/export.md,
/// section 2).
///
/// SI units, world frame W. Threads: all functions are pure and thread safe.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "taut/model_def.h"

namespace taut {

/// Closed triangle surface: each edge has two triangles. Corners are counterclockwise seen from
/// outside.
struct ShapeMesh {
  enum class Kind { kRod, kSphere, kBox, kHull, kCable, kSlackCable };
  Kind kind = Kind::kRod;
  std::string name;  ///< Name of the shape or cable.
  int body = kWorld;
  std::vector<Vec3> corners_m;  ///< Corners, in W.
  std::vector<Vec3> normals;    ///< One per corner on round surfaces; empty: flat faces.
  std::vector<std::array<int, 3>> triangles;
};

struct ShapeOptions {
  /// Radius of all drawn cables, because models need not define cable radii; 0: no cables.
  double cable_radius_m = 0.002;
};

/// Returns the meshes of all rods (with round ends, as in contacts), spheres, boxes and hulls.
/// Meshes of cables follow: straight cylinders between adjacent points. Faceted round surfaces have
/// exactly the volume of the true shape. Terrain is omitted.
std::vector<ShapeMesh> ShapesOf(const ModelDef& def, const ShapeOptions& options = {});

/// Returns a binary STL file: triangles with coordinates times `scale`, in single precision,
/// without names. Overlapping parts are not merged.
std::string StlOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale = 1.0);

/// Returns a binary glTF 2.0 file (.glb). The file has a named node per body with a named child per
/// shape, one node for all cables, and one material per kind. In glTF, y points up; the root node
/// rotates z to y and applies the scale.
std::string GlbOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale = 1.0);

}  // namespace taut
