// Detection of adjacent pieces of terrain during the compilation of a model (seams.h).
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/data/tables.h"
#include "sim/geometry/bvh.h"
#include "sim/geometry/surface_sharp.h"
#include "sim/geometry/touch_list.h"

namespace taut::sim {
namespace {

/// Largest gap between adjacent pieces, relative to the extent of the larger one: three times the
/// rounding error of single-precision coordinates.
constexpr double kSeamShare = 2e-7;
constexpr double kAll = 1e300;

double SameM(double extent_m) { return kJoinedM + kSeamShare * extent_m; }

Vec3 BoundOf(const double* p) { return {p[0], p[1], p[2]}; }

/// Piece of terrain with its description and extent.
struct Piece {
  SeamPiece seam;
  double extent_m = 0;
  int shape = -1;
};

Piece PieceOf(const ShapeTable& shape, int number) {
  Piece piece;
  piece.shape = number;
  SeamPiece& seam = piece.seam;
  if (shape.shape_P.kind == ShapeKind::kBox) {
    const BoxShape& box = shape.shape_P.box;
    const Bounds bounds = BoundsOf(shape.shape_P);
    seam.kind = SeamPiece::kBox;
    seam.box = box;
    seam.low = BoundOf(bounds.low), seam.high = BoundOf(bounds.high);
    piece.extent_m = 2 * std::max({box.half_m[0], box.half_m[1], box.half_m[2]});
  } else {
    const SurfaceTable& s = *shape.shape_P.surface.table;
    seam.kind = SeamPiece::kSurface;
    seam.surface = &s;
    seam.low = s.low, seam.high = s.high;
    const Vec3 size = s.high - s.low;
    piece.extent_m = std::max({size.x, size.y, size.z});
    if (s.is_field) seam.low.z = -kAll;
  }
  return piece;
}

Piece PieceOf(const PlaneTable& plane) {
  Piece piece;
  piece.seam.normal = BoundOf(plane.normal);
  piece.seam.offset_m = plane.offset_m;
  piece.seam.low = {-kAll, -kAll, -kAll}, piece.seam.high = {kAll, kAll, kAll};
  return piece;
}

/// Returns the smallest height of a bounding box above a plane.
double LowestOver(const SeamPiece& plane, const Vec3& low, const Vec3& high) {
  const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
  const Vec3& n = plane.normal;
  return Dot(n, middle) - plane.offset_m -
         (std::fabs(n.x) * half.x + std::fabs(n.y) * half.y + std::fabs(n.z) * half.z);
}

double HighestOver(const SeamPiece& plane, const BoxShape& box) {
  return Dot(plane.normal, Load(box.center)) - plane.offset_m + Reach(box, plane.normal);
}

bool BoundsMeet(const SeamPiece& a, const SeamPiece& b, double same_m) {
  return a.low.x <= b.high.x + same_m && b.low.x <= a.high.x + same_m &&
         a.low.y <= b.high.y + same_m && b.low.y <= a.high.y + same_m &&
         a.low.z <= b.high.z + same_m && b.low.z <= a.high.z + same_m;
}

/// Returns whether a convex edge of a surface is at a box. Border edges count as convex.
bool EndsAtBox(const SurfaceTable& s, const SeamPiece& box, double same_m) {
  const Vec3 reach{same_m, same_m, same_m};
  bool ends = false;
  EachSharpWithin(
      s, box.low - reach, box.high + reach,
      [&](const Vec3& from, const Vec3& to, const auto&) noexcept {
        const RoundShape edge{{from.x, from.y, from.z}, {to.x, to.y, to.z}, 0.0};
        ends = ends || Distance(edge, box.box) <= same_m;
      },
      [](const Vec3&, const auto&) noexcept {});
  return ends;
}

/// Returns whether contacts on `a` may depend on `b`. A box on a plane or in the middle of a field
/// has no effect; a box at an edge has.
bool Meets(const Piece& a, const SeamPiece& b, double same_m) {
  if (b.kind == SeamPiece::kPlane) {
    return a.seam.kind == SeamPiece::kBox ? std::fabs(HighestOver(b, a.seam.box)) <= same_m
                                          : LowestOver(b, a.seam.low, a.seam.high) <= same_m;
  }
  if (!BoundsMeet(a.seam, b, same_m)) return false;
  if (a.seam.kind != SeamPiece::kBox) return true;
  return b.kind == SeamPiece::kBox ? Distance(a.seam.box, b.box) <= same_m
                                   : EndsAtBox(*b.surface, a.seam, same_m);
}

}  // namespace

void JoinPieces(Tables& t) {
  std::vector<Piece> pieces;
  double largest_m = 0;
  for (std::size_t i = 0; i < t.shapes.size(); ++i) {
    const ShapeTable& shape = t.shapes[i];
    const bool is_box = shape.shape_P.kind == ShapeKind::kBox;
    if (shape.body != t.body_count || !(is_box || shape.shape_P.kind == ShapeKind::kSurface)) {
      continue;
    }
    pieces.push_back(PieceOf(shape, static_cast<int>(i)));
    largest_m = std::max(largest_m, pieces.back().extent_m);
  }
  std::vector<Piece> planes;
  for (const PlaneTable& plane : t.planes) planes.push_back(PieceOf(plane));
  // Sweep and prune along x: tests only pieces with overlapping extents.
  std::vector<std::size_t> order(pieces.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(pieces[a].seam.low.x, a) < std::pair(pieces[b].seam.low.x, b);
  });
  std::vector<std::vector<std::size_t>> near(pieces.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      const std::size_t a = order[i], b = order[k];
      if (pieces[b].seam.low.x - pieces[a].seam.high.x > SameM(largest_m)) break;
      near[a].push_back(b);
      near[b].push_back(a);
    }
  }
  bool joins_boxes = false;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    std::vector<SeamPiece> seams;
    SeamList list;
    const auto look = [&](const Piece& other) {
      SeamPiece seam = other.seam;
      seam.same_m = SameM(std::max(piece.extent_m, other.extent_m));
      if (!Meets(piece, seam, seam.same_m)) return;
      const Vec3 more{seam.same_m, seam.same_m, seam.same_m};
      seam.low = seam.low - more, seam.high = seam.high + more;
      list.same_m = std::max(list.same_m, seam.same_m);
      seams.push_back(seam);
    };
    std::sort(near[i].begin(), near[i].end());
    for (const std::size_t other : near[i]) look(pieces[other]);
    for (const Piece& plane : planes) look(plane);
    if (seams.empty()) continue;
    t.seams.push_back(std::move(seams));
    list.pieces = t.seams.back().data(), list.count = static_cast<int>(t.seams.back().size());
    ShapeTable& shape = t.shapes[static_cast<std::size_t>(piece.shape)];
    if (piece.seam.kind == SeamPiece::kBox) {
      shape.seams = list;
      joins_boxes = true;
    } else {
      const std::size_t first = t.shapes.size() - t.surfaces.size();
      t.surfaces[static_cast<std::size_t>(piece.shape) - first].Join(list);
    }
  }
  if (!joins_boxes) return;
  for (WorldPairTable& pair : t.world_pairs) {
    pair.joined = pair.b == t.body_count && !pair.on_ground;
  }
}

}  // namespace taut::sim
