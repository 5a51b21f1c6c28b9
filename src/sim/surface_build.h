/// A surface with all that it is looked up by, from its description.
#pragma once

#include <memory>
#include <vector>

#include "sim/surface.h"
#include "taut/model_def.h"

namespace taut::sim {

class Surface {
 public:
  explicit Surface(const HeightFieldDef& field);
  explicit Surface(const TerrainMeshDef& mesh);

  /// Stays where it is, if the surface is moved, too.
  const SurfaceTable& table() const { return *table_; }

 private:
  std::unique_ptr<SurfaceTable> table_ = std::make_unique<SurfaceTable>();
  std::vector<double> height_m_;
  std::vector<unsigned char> rising_;
  std::vector<std::vector<double>> tops_;
  std::vector<Vec3> corners_;
  std::vector<int> triangles_, first_in_bucket_, in_bucket_;
};

}  // namespace taut::sim
