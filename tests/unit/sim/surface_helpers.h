/// Surfaces for tests, with lists of all their triangles
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "sim/geometry/surface_build.h"
#include "sim/geometry/surface_near.h"
#include "tests/scenes/rough_ground.h"
#include "unit/sim/shape_helpers.h"

namespace taut::sim {

inline constexpr double kInf = 1e300;

/// A surface and all of its triangles
struct Known {
  Surface surface;
  std::vector<SurfaceTriangle> triangles;

  template <class Def>
  explicit Known(const Def& def) : surface(def) {
    const Vec3 everywhere{1e6, 1e6, 1e6};
    EachTriangle(table(), Vec3{} - everywhere, everywhere,
                 [&](const SurfaceTriangle& t) noexcept { triangles.push_back(t); });
  }
  const SurfaceTable& table() const { return surface.table(); }

  /// Returns the place nearest to a point, by testing all triangles: faces, edges, corners.
  Vec3 NearestTo(const Vec3& p) const {
    Vec3 best;
    double least = kInf;
    const auto take = [&](const Vec3& q) {
      if (Length(p - q) < least) least = Length(p - q), best = q;
    };
    for (const SurfaceTriangle& t : triangles) {
      const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
      const Vec3 foot = p - (Dot(n, p - t.p[0]) / Dot(n, n)) * n;
      bool within = true;
      for (int k = 0; k < 3; ++k) {
        const Vec3 edge = t.p[(k + 1) % 3] - t.p[k];
        within = within && Dot(Cross(edge, foot - t.p[k]), n) >= 0;
        const double share = std::clamp(Dot(p - t.p[k], edge) / Dot(edge, edge), 0.0, 1.0);
        take(t.p[k] + share * edge);
      }
      if (within) take(foot);
    }
    return best;
  }
};

inline HeightFieldDef RoughField(unsigned seed, int columns = 9, int rows = 8) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> height(-0.05, 0.05);
  HeightFieldDef field =
      scenes::Field(columns, rows, 0.1, {}, [&](double, double) { return height(random); });
  field.split = static_cast<HeightFieldDef::Split>(seed % 3);
  field.origin_m = {0.3, -0.2, 0.1};
  return field;
}

/// A cube with corners at +-0.2, seen from outside
inline TerrainMeshDef CubeMesh() {
  TerrainMeshDef mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.corners_m.push_back({i & 1 ? 0.2 : -0.2, i & 2 ? 0.2 : -0.2, i & 4 ? 0.2 : -0.2});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

class Points3 {
 public:
  explicit Points3(unsigned seed) : random_(seed) {}
  Vec3 Within(double x, double low, double high) {
    return {Between(-x, x), Between(-x, x), Between(low, high)};
  }
  double Between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  std::mt19937 random_;
};

}  // namespace taut::sim
