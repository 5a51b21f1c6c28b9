/// Sharp (convex) edges and corners of a surface, which the flank of a rod may touch.
///
/// The construction of a surface (surface_build.h) finds them once. A step tests only sharp edges
/// and corners, each with its neighbors.
///
/// A step includes this header, so it does not use the standard library.
#pragma once

#include "sim/geometry/line_stretch.h"
#include "sim/geometry/surface.h"

namespace taut::sim {

/// Edge with the third corners of its triangles: one at a border, otherwise two. A mesh that is not
/// solid may have more, of which kMaxSides count. At the border of a field, the second one is a
/// point straight below, where the terrain ends in a wall.
struct SurfaceEdge {
  static constexpr int kMaxSides = 4;
  Vec3 from, to;
  Vec3 apex[kMaxSides];
  int sides;
  bool border;  ///< Whether the edge is at the border of a field.
};

/// Part of a straight line, and the search distance around it.
struct LineReach {
  Vec3 from, along;
  double low, high;  ///< Positions on the line, 0 to 1.
  double limit_m;
  Vec3 At(double share) const noexcept { return from + share * along; }
};

/// Calls `use(stretch, low, high)` for a line, segment by segment. `low`, `high`: bounds of the
/// search region around the segment.
template <class Use>
void EachPiece(const SurfaceTable& s, const LineReach& line, const Use& use) noexcept {
  constexpr int kMaxPieces = 4096;
  const double share = line.high - line.low, length_m = share * Norm(line.along);
  const double piece_m = Larger(s.is_field ? s.cell_m : s.bucket_m, line.limit_m);
  const int pieces = CellAt(length_m / piece_m, kMaxPieces) + 1;
  const Vec3 reach{line.limit_m, line.limit_m, line.limit_m};
  for (int k = 0; k < pieces; ++k) {
    const LineStretch piece{line.low + share * (static_cast<double>(k) / pieces),
                            line.low + share * ((k + 1.0) / pieces)};
    const Vec3 a = line.At(piece.low), b = line.At(piece.high);
    const Vec3 least{Smaller(a.x, b.x), Smaller(a.y, b.y), Smaller(a.z, b.z)};
    const Vec3 most{Larger(a.x, b.x), Larger(a.y, b.y), Larger(a.z, b.z)};
    use(piece, least - reach, most + reach);
  }
}

namespace detail {

inline Vec3 CornerOf(const SurfaceTable& s, int i, int j) noexcept {
  return {s.low.x + i * s.cell_m, s.low.y + j * s.cell_m, s.height_m[j * s.columns + i]};
}
inline bool Rises(const SurfaceTable& s, int i, int j) noexcept {
  return (s.marks[j * s.columns + i] & kRising) != 0;
}

/// Returns the edge of a mark of corner (i, j).
inline SurfaceEdge EdgeOfField(const SurfaceTable& s, int i, int j, FieldMark mark) noexcept {
  const auto at = [&](int ci, int cj) noexcept { return CornerOf(s, ci, cj); };
  SurfaceEdge edge;
  edge.sides = 0;
  edge.border = false;
  if (mark == kSharpDiagonal) {
    const int k = Rises(s, i, j) ? 0 : 1;
    edge.from = at(i + k, j), edge.to = at(i + 1 - k, j + 1);
    edge.apex[0] = at(i + 1 - k, j), edge.apex[1] = at(i + k, j + 1);
    edge.sides = 2;
    return edge;
  }
  const bool x = mark == kSharpAlongX;
  edge.from = at(i, j);
  edge.to = x ? at(i + 1, j) : at(i, j + 1);
  // The third corner of a triangle is above the end of the edge at which the diagonal of the cell
  // ends.
  if (x ? j + 1 < s.rows : i + 1 < s.columns) {
    const bool rises = Rises(s, i, j);
    edge.apex[edge.sides++] = x ? at(rises ? i + 1 : i, j + 1) : at(i + 1, rises ? j + 1 : j);
  }
  if (x ? j > 0 : i > 0) {
    const bool rises = x ? Rises(s, i, j - 1) : Rises(s, i - 1, j);
    edge.apex[edge.sides++] = x ? at(rises ? i : i + 1, j - 1) : at(i - 1, rises ? j : j + 1);
  }
  if (edge.sides == 1) {
    edge.border = true;
    edge.apex[edge.sides++] = {edge.from.x, edge.from.y, edge.from.z - s.cell_m};
  }
  return edge;
}

/// Calls `use` with the other end of every edge at a corner of a field. At the border, one of these
/// edges leads down.
template <class Use>
void EachBesideOfField(const SurfaceTable& s, int i, int j, const Use& use) noexcept {
  const bool west = i > 0, east = i + 1 < s.columns, south = j > 0, north = j + 1 < s.rows;
  if (east) use(CornerOf(s, i + 1, j));
  if (west) use(CornerOf(s, i - 1, j));
  if (north) use(CornerOf(s, i, j + 1));
  if (south) use(CornerOf(s, i, j - 1));
  if (!(west && east && south && north)) {
    const Vec3 corner = CornerOf(s, i, j);
    use({corner.x, corner.y, corner.z - s.cell_m});
  }
  if (east && north && Rises(s, i, j)) use(CornerOf(s, i + 1, j + 1));
  if (west && south && Rises(s, i - 1, j - 1)) use(CornerOf(s, i - 1, j - 1));
  if (west && north && !Rises(s, i - 1, j)) use(CornerOf(s, i - 1, j + 1));
  if (east && south && !Rises(s, i, j - 1)) use(CornerOf(s, i + 1, j - 1));
}

/// Visits the sharp edges and the sharp corner of corner (i, j) of a field that reach above
/// `floor`.
template <class UseEdge, class UseCorner>
void EachSharpOfCell(const SurfaceTable& s, int i, int j, double floor, const UseEdge& use_edge,
                     const UseCorner& use_corner) noexcept {
  const int at = j * s.columns + i;
  const unsigned char marks = s.marks[at];
  if ((marks & ~kRising) == 0) return;
  const bool east = i + 1 < s.columns, north = j + 1 < s.rows;
  const double* const z = s.height_m + at;
  const double here = z[0], to_east = east ? z[1] : here, to_north = north ? z[s.columns] : here;
  const double x = s.low.x + i * s.cell_m, x_east = s.low.x + (i + 1) * s.cell_m;
  const double y = s.low.y + j * s.cell_m, y_north = s.low.y + (j + 1) * s.cell_m;
  const Vec3 corner{x, y, here}, at_east{x_east, y, to_east}, at_north{x, y_north, to_north};
  const auto look = [&](FieldMark mark, const Vec3& from, const Vec3& to) noexcept {
    if (Larger(from.z, to.z) < floor) return;
    use_edge(from, to, [&]() noexcept { return EdgeOfField(s, i, j, mark); });
  };
  if ((marks & kSharpAlongX) != 0) look(kSharpAlongX, corner, at_east);
  if ((marks & kSharpAlongY) != 0) look(kSharpAlongY, corner, at_north);
  if ((marks & kSharpDiagonal) != 0) {
    if ((marks & kRising) != 0) {
      look(kSharpDiagonal, corner, {x_east, y_north, z[s.columns + 1]});
    } else {
      look(kSharpDiagonal, at_east, at_north);
    }
  }
  if ((marks & kSharpCorner) != 0 && here >= floor) {
    use_corner(corner, [&](const auto& use) noexcept { EachBesideOfField(s, i, j, use); });
  }
}

/// Returns whether a line is traversed along x; otherwise along y.
inline bool GoesByX(const Vec3& along) noexcept { return Abs(along.x) >= Abs(along.y); }

/// Visits the cells near a line with `use(i, j, floor)`, slab by slab along the dominant axis of
/// the line. The part of the line near a slab limits its cells and their smallest height.
template <class Use>
void EachCellOfField(const SurfaceTable& s, const LineReach& line, const Use& use) noexcept {
  const Vec3 a = line.At(line.low), b = line.At(line.high);
  const bool by_x = GoesByX(line.along);
  const double start = by_x ? a.x - s.low.x : a.y - s.low.y;
  const double end = by_x ? b.x - s.low.x : b.y - s.low.y;
  const double slope = by_x ? line.along.x : line.along.y;
  const int slabs = by_x ? s.columns : s.rows, across = by_x ? s.rows : s.columns;
  const double origin = by_x ? s.low.y : s.low.x;
  const int first = CellAt((Smaller(start, end) - line.limit_m) * s.inv_cell, slabs);
  const int last = CellAt((Larger(start, end) + line.limit_m) * s.inv_cell, slabs);
  const double inverse = slope != 0.0 ? 1.0 / slope : 0.0;
  for (int slab = first; slab <= last; ++slab) {
    double low = line.low, high = line.high;
    if (slope != 0.0) {
      const double from = (slab * s.cell_m - line.limit_m - start) * inverse;
      const double to = ((slab + 1) * s.cell_m + line.limit_m - start) * inverse;
      low = Larger(low, line.low + Smaller(from, to));
      high = Smaller(high, line.low + Larger(from, to));
      if (low > high) continue;
    }
    const Vec3 p = line.At(low), q = line.At(high);
    const double side_p = (by_x ? p.y : p.x) - origin, side_q = (by_x ? q.y : q.x) - origin;
    const int begin = CellAt((Smaller(side_p, side_q) - line.limit_m) * s.inv_cell, across);
    const int stop = CellAt((Larger(side_p, side_q) + line.limit_m) * s.inv_cell, across);
    const double floor = Smaller(p.z, q.z) - line.limit_m;
    for (int k = begin; k <= stop; ++k) use(by_x ? slab : k, by_x ? k : slab, floor);
  }
}

template <class UseEdge, class UseCorner>
void EachSharpOfField(const SurfaceTable& s, const LineReach& line, const UseEdge& use_edge,
                      const UseCorner& use_corner) noexcept {
  EachCellOfField(s, line, [&](int i, int j, double floor) noexcept {
    EachSharpOfCell(s, i, j, floor, use_edge, use_corner);
  });
}

inline SurfaceEdge EdgeOfMesh(const SurfaceTable& s, const MeshEdge& found) noexcept {
  SurfaceEdge edge;
  edge.from = s.corners[found.from], edge.to = s.corners[found.to];
  edge.sides = found.count < SurfaceEdge::kMaxSides ? found.count : SurfaceEdge::kMaxSides;
  for (int n = 0; n < edge.sides; ++n) edge.apex[n] = s.corners[s.beside[found.first + n]];
  edge.border = false;
  return edge;
}

/// Visits the sharp edges and corners of a mesh between bounds.
template <class UseEdge, class UseCorner>
void EachSharpOfBounds(const SurfaceTable& s, const Vec3& low, const Vec3& high,
                       const UseEdge& use_edge, const UseCorner& use_corner) noexcept {
  EachOfMesh(s, low, high, [&](int triangle) noexcept {
    for (int e = s.first_edge[triangle]; e < s.first_edge[triangle + 1]; ++e) {
      const MeshEdge& found = s.edges[e];
      use_edge(s.corners[found.from], s.corners[found.to],
               [&]() noexcept { return EdgeOfMesh(s, found); });
    }
    for (int c = s.first_corner[triangle]; c < s.first_corner[triangle + 1]; ++c) {
      const MeshCorner& found = s.sharp_corners[c];
      use_corner(s.corners[found.corner], [&](const auto& use) noexcept {
        for (int n = 0; n < found.count; ++n) use(s.corners[s.beside[found.first + n]]);
      });
    }
  });
}

/// Visits the sharp edges and corners of a mesh for each segment of the line. Segments share edges
/// and corners that are near both.
template <class UseEdge, class UseCorner>
void EachSharpOfMesh(const SurfaceTable& s, const LineReach& line, const UseEdge& use_edge,
                     const UseCorner& use_corner) noexcept {
  EachPiece(s, line, [&](const LineStretch& piece, const Vec3& low, const Vec3& high) noexcept {
    EachSharpOfBounds(
        s, low, high,
        [&](const Vec3& from, const Vec3& to, const auto& edge) noexcept {
          use_edge(piece, from, to, edge);
        },
        [&](const Vec3& corner, const auto& each_beside) noexcept {
          use_corner(piece, corner, each_beside);
        });
  });
}

}  // namespace detail

/// Visits all sharp edges and corners within reach of a line, and possibly some others near it.
/// For an edge, calls `use_edge(stretch, from, to, edge)`; `edge()` returns the complete edge. For
/// a corner, calls `use_corner(stretch, corner, each_beside)`; `each_beside(use)` calls `use` with
/// each corner at the other end of an edge of this corner. `stretch` is a segment of the line. Each
/// edge or corner within reach of a segment is visited once with this segment, and possibly again
/// with other segments.
template <class UseEdge, class UseCorner>
void EachSharp(const SurfaceTable& s, const LineReach& line, const UseEdge& use_edge,
               const UseCorner& use_corner) noexcept {
  if (!s.is_field) return detail::EachSharpOfMesh(s, line, use_edge, use_corner);
  const LineStretch all{line.low, line.high};
  detail::EachSharpOfField(
      s, line,
      [&](const Vec3& from, const Vec3& to, const auto& edge) noexcept {
        use_edge(all, from, to, edge);
      },
      [&](const Vec3& corner, const auto& each_beside) noexcept {
        use_corner(all, corner, each_beside);
      });
}

/// Visits the sharp edges and corners between bounds, each once: `use_edge(from, to, edge)` and
/// `use_corner(corner, each_beside)`.
template <class UseEdge, class UseCorner>
void EachSharpWithin(const SurfaceTable& s, const Vec3& low, const Vec3& high,
                     const UseEdge& use_edge, const UseCorner& use_corner) noexcept {
  if (!s.is_field) return detail::EachSharpOfBounds(s, low, high, use_edge, use_corner);
  // Visit one cell more, because an edge belongs to its first corner.
  const int i0 = CellAt((low.x - s.low.x) * s.inv_cell - 1.0, s.columns);
  const int i1 = CellAt((high.x - s.low.x) * s.inv_cell, s.columns);
  const int j0 = CellAt((low.y - s.low.y) * s.inv_cell - 1.0, s.rows);
  const int j1 = CellAt((high.y - s.low.y) * s.inv_cell, s.rows);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      detail::EachSharpOfCell(s, i, j, low.z, use_edge, use_corner);
    }
  }
}

}  // namespace taut::sim
