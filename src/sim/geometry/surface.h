/// Terrain surfaces: static triangles of a height field or a mesh. The time to find the triangles
/// near a point does not grow with their number.
///
/// A step includes this header, so it does not use the standard library. surface_build.h fills in
/// the tables.
#pragma once

#include "math/vec.h"
#include "sim/geometry/seams.h"

namespace taut::sim {

inline constexpr int kMaxTopLevels = 32;

/// Marks of corner (i, j) of a field. The marks describe the cell between this corner and corner (i
/// + 1, j + 1), two sides of this cell, and the corner.
enum FieldMark : unsigned char {
  kRising = 1,  ///< The diagonal of the cell starts at (i, j).
  /// The edge to (i + 1, j) is sharp (convex), so the flank of a rod may touch it.
  kSharpAlongX = 2,
  kSharpAlongY = 4,  ///< The edge to (i, j + 1) is sharp.
  kSharpDiagonal = 8,
  kSharpCorner = 16,
};

/// Edge of a mesh, and the third corners of its triangles: `count` entries of SurfaceTable's array
/// of adjacent corners, starting at `first`.
struct MeshEdge {
  int from, to, first, count;
};
/// Corner of a mesh, and the other ends of its edges.
struct MeshCorner {
  int corner, first, count;
};

struct SurfaceTable {
  bool is_field = false;  ///< False: a mesh.
  bool solid = false;     ///< Whether there is an inside; for a field, the space below.
  Vec3 low, high;         ///< Bounds of all corners, in W [m].

  // For a field: corner (i, j) is at low + (i, j) cells; columns along x, rows along y.
  int columns = 0, rows = 0;
  double cell_m = 0, inv_cell = 0;
  const double* height_m = nullptr;      ///< In W, row by row.
  const unsigned char* marks = nullptr;  ///< `FieldMark`s per corner (i, j).
  int levels = 0;
  const double* tops[kMaxTopLevels] = {};  ///< Largest height of 2^level by 2^level cells [m].

  // For a mesh: triangles, counterclockwise seen from outside, and buckets of a uniform grid.
  const Vec3* corners = nullptr;
  const int* triangles = nullptr;  ///< Three corners per triangle.
  int buckets[3] = {};
  double bucket_m = 0, inv_bucket = 0;
  const int* first_in_bucket = nullptr;
  const int* in_bucket = nullptr;  ///< Triangles in ascending order.
  // Sharp edges and corners of the mesh, each assigned to one of its triangles. The edges and
  // corners of triangle k start at first_edge[k] and first_corner[k].
  const int *first_edge = nullptr, *first_corner = nullptr;
  const MeshEdge* edges = nullptr;
  const MeshCorner* sharp_corners = nullptr;
  const int* beside = nullptr;  ///< Adjacent corners.

  SeamList seams;                       ///< Adjacent pieces of terrain.
  const SurfaceTable* alone = nullptr;  ///< The same table without seams; null if there are none.
};

/// Returns the surface without adjacent pieces. Distances use it: covered parts then count as near,
/// so no contact is missed where they emerge.
inline const SurfaceTable& Alone(const SurfaceTable& s) noexcept {
  return s.alone == nullptr ? s : *s.alone;
}

/// A triangle of a surface.
struct SurfaceTriangle {
  Vec3 p[3];
  int corner[3];  ///< Equal numbers denote the same corner.
};

/// Returns the index of the cell at `x`, in cells from the first side; clamped to the grid.
inline int CellAt(double x, int count) noexcept {
  if (!(x > 0.0)) return 0;
  return x < count ? static_cast<int>(x) : count - 1;
}

/// Returns the height of a field at a point within it.
double HeightAt(const SurfaceTable& s, double x, double y) noexcept;
/// Returns the depth of a point below the surface of a field, within its rectangle; otherwise 0 or
/// less.
double DepthBelow(const SurfaceTable& s, const Vec3& p) noexcept;
/// Returns an upper bound of the heights of a field between `low` and `high`.
double TopOver(const SurfaceTable& s, const Vec3& low, const Vec3& high) noexcept;

namespace detail {

/// Calls `use(i, j)` for the cells of a field between `low` and `high`.
template <class Use>
void EachCell(const SurfaceTable& s, const Vec3& low, const Vec3& high, const Use& use) noexcept {
  const int i0 = CellAt((low.x - s.low.x) * s.inv_cell, s.columns - 1);
  const int i1 = CellAt((high.x - s.low.x) * s.inv_cell, s.columns - 1);
  const int j0 = CellAt((low.y - s.low.y) * s.inv_cell, s.rows - 1);
  const int j1 = CellAt((high.y - s.low.y) * s.inv_cell, s.rows - 1);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const double* const z = s.height_m + (j * s.columns + i);
      const double z00 = z[0], z10 = z[1], z01 = z[s.columns], z11 = z[s.columns + 1];
      const double top_a = z00 > z10 ? z00 : z10, top_b = z01 > z11 ? z01 : z11;
      const double low_a = z00 < z10 ? z00 : z10, low_b = z01 < z11 ? z01 : z11;
      if ((top_a > top_b ? top_a : top_b) < low.z) continue;
      if ((low_a < low_b ? low_a : low_b) > high.z) continue;
      use(i, j);
    }
  }
}

/// Returns one of the two triangles of a cell.
inline SurfaceTriangle TriangleOfField(const SurfaceTable& s, int i, int j, bool second) noexcept {
  const int at = j * s.columns + i;
  const double* const z = s.height_m + at;
  const double x0 = s.low.x + i * s.cell_m, x1 = s.low.x + (i + 1) * s.cell_m;
  const double y0 = s.low.y + j * s.cell_m, y1 = s.low.y + (j + 1) * s.cell_m;
  const Vec3 a{x0, y0, z[0]}, b{x1, y0, z[1]};
  const Vec3 c{x1, y1, z[s.columns + 1]}, d{x0, y1, z[s.columns]};
  const int na = at, nb = at + 1, nc = at + s.columns + 1, nd = at + s.columns;
  if ((s.marks[at] & kRising) != 0) {
    return second ? SurfaceTriangle{{a, c, d}, {na, nc, nd}}
                  : SurfaceTriangle{{a, b, c}, {na, nb, nc}};
  }
  return second ? SurfaceTriangle{{b, c, d}, {nb, nc, nd}}
                : SurfaceTriangle{{a, b, d}, {na, nb, nd}};
}

template <class Use>
void EachOfField(const SurfaceTable& s, const Vec3& low, const Vec3& high,
                 const Use& use) noexcept {
  EachCell(s, low, high, [&](int i, int j) noexcept {
    use(TriangleOfField(s, i, j, false));
    use(TriangleOfField(s, i, j, true));
  });
}

inline double Least(double a, double b, double c) noexcept {
  const double ab = a < b ? a : b;
  return ab < c ? ab : c;
}
inline double Most(double a, double b, double c) noexcept {
  const double ab = a > b ? a : b;
  return ab > c ? ab : c;
}

/// Calls `use` with triangle numbers.
template <class Use>
void EachOfMesh(const SurfaceTable& s, const Vec3& low, const Vec3& high, const Use& use) noexcept {
  const double from[3] = {low.x - s.low.x, low.y - s.low.y, low.z - s.low.z};
  const double to[3] = {high.x - s.low.x, high.y - s.low.y, high.z - s.low.z};
  int first[3], last[3];
  for (int k = 0; k < 3; ++k) {
    first[k] = CellAt(from[k] * s.inv_bucket, s.buckets[k]);
    last[k] = CellAt(to[k] * s.inv_bucket, s.buckets[k]);
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) {
        const int bucket = (z * s.buckets[1] + y) * s.buckets[0] + x;
        for (int k = s.first_in_bucket[bucket]; k < s.first_in_bucket[bucket + 1]; ++k) {
          const int* const v = s.triangles + 3 * s.in_bucket[k];
          const Vec3 &a = s.corners[v[0]], &b = s.corners[v[1]], &c = s.corners[v[2]];
          const Vec3 least{Least(a.x, b.x, c.x), Least(a.y, b.y, c.y), Least(a.z, b.z, c.z)};
          if (least.x > high.x || least.y > high.y || least.z > high.z) continue;
          if (Most(a.x, b.x, c.x) < low.x || Most(a.y, b.y, c.y) < low.y ||
              Most(a.z, b.z, c.z) < low.z) {
            continue;
          }
          // A triangle is in several buckets; only the first visited one counts.
          const int bx = CellAt((least.x - s.low.x) * s.inv_bucket, s.buckets[0]);
          const int by = CellAt((least.y - s.low.y) * s.inv_bucket, s.buckets[1]);
          const int bz = CellAt((least.z - s.low.z) * s.inv_bucket, s.buckets[2]);
          if (x != (bx > first[0] ? bx : first[0]) || y != (by > first[1] ? by : first[1]) ||
              z != (bz > first[2] ? bz : first[2])) {
            continue;
          }
          use(s.in_bucket[k]);
        }
      }
    }
  }
}

}  // namespace detail

/// Calls `use` with every triangle between `low` and `high`, and possibly some nearby ones.
template <class Use>
void EachTriangle(const SurfaceTable& s, const Vec3& low, const Vec3& high,
                  const Use& use) noexcept {
  if (low.x > s.high.x || low.y > s.high.y || low.z > s.high.z) return;
  if (high.x < s.low.x || high.y < s.low.y || high.z < s.low.z) return;
  if (s.is_field) {
    detail::EachOfField(s, low, high, use);
  } else {
    detail::EachOfMesh(s, low, high, [&](int triangle) noexcept {
      const int* const v = s.triangles + 3 * triangle;
      use(SurfaceTriangle{{s.corners[v[0]], s.corners[v[1]], s.corners[v[2]]}, {v[0], v[1], v[2]}});
    });
  }
}

}  // namespace taut::sim
