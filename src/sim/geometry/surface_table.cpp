// Heights of a field: at a point, and the maximum over a rectangle.
#include "sim/geometry/surface.h"

#include "sim/geometry/touch_list.h"

namespace taut::sim {

namespace {

/// Tolerance at the border of a field within which a point counts as inside its rectangle [m].
constexpr double kNoDistanceM = 1e-10;

}  // namespace

double HeightAt(const SurfaceTable& s, double x, double y) noexcept {
  const int i = CellAt((x - s.low.x) * s.inv_cell, s.columns - 1);
  const int j = CellAt((y - s.low.y) * s.inv_cell, s.rows - 1);
  const double u = Clamp((x - (s.low.x + i * s.cell_m)) * s.inv_cell, 0.0, 1.0);
  const double v = Clamp((y - (s.low.y + j * s.cell_m)) * s.inv_cell, 0.0, 1.0);
  const int at = j * s.columns + i;
  const double* const z = s.height_m + at;
  const double z00 = z[0], z10 = z[1], z01 = z[s.columns], z11 = z[s.columns + 1];
  if ((s.marks[at] & kRising) != 0) {
    return u >= v ? z00 + u * (z10 - z00) + v * (z11 - z10)
                  : z00 + v * (z01 - z00) + u * (z11 - z01);
  }
  return u + v <= 1.0 ? z00 + u * (z10 - z00) + v * (z01 - z00)
                      : z11 + (1.0 - u) * (z01 - z11) + (1.0 - v) * (z10 - z11);
}

double DepthBelow(const SurfaceTable& s, const Vec3& p) noexcept {
  const double beside_m = Larger(s.seams.same_m, kNoDistanceM);
  const bool within = p.x >= s.low.x - beside_m && p.x <= s.high.x + beside_m &&
                      p.y >= s.low.y - beside_m && p.y <= s.high.y + beside_m;
  return within ? HeightAt(s, p.x, p.y) - p.z : 0.0;
}

double TopOver(const SurfaceTable& s, const Vec3& low, const Vec3& high) noexcept {
  int i0 = CellAt((low.x - s.low.x) * s.inv_cell, s.columns - 1);
  int i1 = CellAt((high.x - s.low.x) * s.inv_cell, s.columns - 1);
  int j0 = CellAt((low.y - s.low.y) * s.inv_cell, s.rows - 1);
  int j1 = CellAt((high.y - s.low.y) * s.inv_cell, s.rows - 1);
  int level = 0, width = s.columns - 1;
  while (level + 1 < s.levels && (i1 - i0 > 2 || j1 - j0 > 2)) {
    ++level;
    i0 /= 2, i1 /= 2, j0 /= 2, j1 /= 2;
    width = (width + 1) / 2;
  }
  double top = s.low.z;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) top = Larger(top, s.tops[level][j * width + i]);
  }
  return top;
}

}  // namespace taut::sim
