/// Construction of the tables of a terrain surface from a height field or a mesh.
#pragma once

#include <memory>
#include <vector>

#include "sim/geometry/surface.h"
#include "taut/model_def.h"

namespace taut::sim {

class Surface {
 public:
  explicit Surface(const HeightFieldDef& field);
  explicit Surface(const TerrainMeshDef& mesh);

  /// Moving the surface does not change this address.
  const SurfaceTable& table() const { return *table_; }

  /// Sets the adjacent pieces, which must outlive the surface.
  void Join(const SeamList& seams);

 private:
  // Sharp edges and corners (surface_sharp.cpp).
  void MarkField();
  void FindSharp();

  std::unique_ptr<SurfaceTable> table_ = std::make_unique<SurfaceTable>();
  std::unique_ptr<SurfaceTable> alone_;
  std::vector<double> height_m_;
  std::vector<unsigned char> marks_;
  std::vector<std::vector<double>> tops_;
  std::vector<Vec3> corners_;
  std::vector<int> triangles_, first_in_bucket_, in_bucket_;
  std::vector<int> first_edge_, first_corner_, beside_;
  std::vector<MeshEdge> edges_;
  std::vector<MeshCorner> sharp_corners_;
};

}  // namespace taut::sim
