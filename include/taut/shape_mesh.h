/// Triangle meshes of a robot for rendering and 3D printing, as STL and glTF (docs/export.md,
/// section 2).
///
/// SI units, W frame. Threads: all functions are pure; any number may run at once.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "taut/model_def.h"

namespace taut {

/// Closed surface: each edge has two triangles; triangles are counterclockwise seen from outside.
struct ShapeMesh {
  enum class Kind { kRod, kSphere, kBox, kHull, kCable, kSlackCable };
  Kind kind = Kind::kRod;
  std::string name;  ///< Of the shape or cable.
  int body = kWorld;
  std::vector<Vec3> corners_m;  ///< In W.
  std::vector<Vec3> normals;    ///< Per corner, on round surfaces; empty: flat faces.
  std::vector<std::array<int, 3>> triangles;
};

struct ShapeOptions {
  double cable_radius_m = 0.002;  ///< Of cables, since models need not define one; 0: no cables.
};

/// Returns the meshes of rods (with round ends, as in contacts), spheres, boxes and hulls of all
/// bodies, then of cables as straight cylinders between adjacent points. Facets of round surfaces
/// enclose exactly the volume of the true shape. Terrain is omitted.
std::vector<ShapeMesh> ShapesOf(const ModelDef& def, const ShapeOptions& options = {});

/// Returns a binary STL file: triangles with coordinates times `scale` in single precision, without
/// names. Overlapping parts are not merged.
std::string StlOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale = 1.0);

/// Returns a binary glTF 2.0 file (.glb): one node per body with one child per shape, with their
/// names; one node for all cables; one material per kind. In glTF, y points up: the root node
/// rotates z to y and has the scale.
std::string GlbOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale = 1.0);

}  // namespace taut
