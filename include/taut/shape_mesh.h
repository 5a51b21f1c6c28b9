/// What a robot looks like, for slides and for printing: closed triangles, as STL and as glTF
/// (docs/export.md, section 2).
///
/// SI units, W frame. Threads: all functions are pure; any number may run at once.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "taut/model_def.h"

namespace taut {

/// Closed surfaces: each edge has two triangles, counter-clockwise seen from outside.
struct ShapeMesh {
  enum class Kind { kRod, kSphere, kBox, kHull, kCable, kSlackCable };
  Kind kind = Kind::kRod;
  std::string name;  ///< The shape's or the cable's.
  int body = kWorld;
  std::vector<Vec3> corners_m;  ///< In W.
  std::vector<Vec3> normals;    ///< Per corner, of what is round; empty: faces are flat.
  std::vector<std::array<int, 3>> triangles;
};

struct ShapeOptions {
  double cable_radius_m = 0.002;  ///< Of cables, which have none of their own; 0: no cables.
};

/// Rods (with round ends, as they touch), spheres, boxes and hulls of all bodies, then cables, as
/// straight cylinders from one place to the next. Round surfaces are faceted so that they enclose
/// exactly the volume of what they stand for. Terrain is left out.
std::vector<ShapeMesh> ShapesOf(const ModelDef& def, const ShapeOptions& options = {});

/// A binary STL file: a triangle after the other, coordinates times `scale` in single precision,
/// no names. What overlaps stays so.
std::string StlOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale = 1.0);

/// A binary glTF 2.0 file (.glb): a node a body, in it one a shape, with their names; a node with
/// all cables; a material a kind. Up is y there, as glTF has it: the node above all turns z to y
/// and has the scale.
std::string GlbOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale = 1.0);

}  // namespace taut
