// Contacts of a point with a surface are local minima of its distance: points in triangles, or on
// sharp edges and corners that are the nearest point of every adjacent triangle. Therefore edges
// within a plane do not disturb bodies that roll over them.
#include "sim/geometry/surface_near.h"

#include "math/scalar.h"
#include "sim/geometry/touch_list.h"

namespace taut::sim {
namespace {

/// Distance below which the direction from a surface point to a point is undefined [m].
constexpr double kCoincidentM = 1e-10;
/// Relative difference of the distances computed from two triangles for a common point.
constexpr double kSameDistance = 1e-12;
/// The same tolerance for rounding of coordinates [m].
constexpr double kSameDistanceM = 1e-13;
/// The same tolerance for the distance between surface points (square root of kSameDistance).
constexpr double kSamePlace = 4e-6;
/// Sine of the elevation above the plane of a triangle, seen from its edge, below which a point
/// counts as above the plane. A surface point on an edge within a plane then has the normal of the
/// plane, whichever triangle rounding selects.
constexpr double kAbovePlane = 1e-7;
constexpr int kMaxPlaces = 16;
/// Factor and margin by which a border wall must be nearer than the surface to be the exit from a
/// field. Rounding beyond the border then does not move a point to the wall.
constexpr double kWallNearer = 0.9, kWallNearerM = 1e-6;
/// Directions with a larger cosine count as parallel.
constexpr double kAlongNormal = 1.0 - 1e-9;
/// No tolerance in comparisons of distances.
constexpr SeamSlack kExactly{0.0, kAbovePlane};

/// Returns the point of a triangle nearest to a given point. Source: C. Ericson, Real-Time
/// Collision Detection (Morgan Kaufmann 2005), section 5.1.5.
Vec3 NearestOf(const SurfaceTriangle& t, const Vec3& p) noexcept {
  const Vec3 ab = t.p[1] - t.p[0], ac = t.p[2] - t.p[0], ap = p - t.p[0];
  const double d1 = Dot(ab, ap), d2 = Dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return t.p[0];
  const Vec3 bp = p - t.p[1];
  const double d3 = Dot(ab, bp), d4 = Dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return t.p[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    return t.p[0] + (d1 / (d1 - d3)) * ab;
  }
  const Vec3 cp = p - t.p[2];
  const double d5 = Dot(ab, cp), d6 = Dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return t.p[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    return t.p[0] + (d2 / (d2 - d6)) * ac;
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return t.p[1] + share * (t.p[2] - t.p[1]);
  }
  // The nearest point is computed from p along the normal, not from a corner along the edges, so
  // the direction from it to p is as accurate as the normal.
  const Vec3 n = Cross(ab, ac);
  return p - (Dot(n, ap) / Dot(n, n)) * n;
}

Vec3 NormalOf(const SurfaceTriangle& t) noexcept {
  const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  return (1.0 / Norm(n)) * n;
}

/// Triangle nearest to a point.
struct NearestOfAll {
  double limit_m, distance_m;
  bool found = false;
  SurfaceTriangle triangle;
  Vec3 at;

  /// `seams`: pieces whose covered points are no exits, with exits normal to a triangle; or null.
  NearestOfAll(const SurfaceTable& s, const Vec3& p, double limit, const SeamList* seams,
               const Vec3* middle) noexcept
      : limit_m(limit), distance_m(limit) {
    const Vec3 reach{limit_m, limit_m, limit_m};
    EachTriangle(s, p - reach, p + reach, [&](const SurfaceTriangle& t) noexcept {
      const Vec3 place = NearestOf(t, p);
      const double distance = Norm(p - place);
      if (!(distance <= limit_m) || (found && !(distance < distance_m))) return;
      if (seams != nullptr) {
        const Vec3 out = distance <= kCoincidentM ? NormalOf(t) : (1.0 / distance) * (place - p);
        if (Dot(out, NormalOf(t)) < kAlongNormal) return;
        if (IsFaceCovered(*seams, t, {place, out, middle}, kExactly)) return;
      }
      found = true;
      triangle = t, at = place, distance_m = distance;
    });
  }
};

/// Returns whether a point is inside a closed mesh, from the triangles at its nearest surface
/// point. At an edge or corner, the triangle that faces the point most directly decides.
bool IsInsideOfMesh(const SurfaceTable& s, const Vec3& p, const NearestOfAll& near) noexcept {
  if (!near.found) return false;
  const double same = near.distance_m * (1.0 + kSameDistance) + kSameDistanceM;
  const Vec3 reach{same, same, same}, away = p - near.at;
  double most = 0.0, side = 0.0;
  EachTriangle(s, p - reach, p + reach, [&](const SurfaceTriangle& t) noexcept {
    if (Norm(p - NearestOf(t, p)) > same) return;
    const double facing = Dot(away, NormalOf(t));
    if (Abs(facing) <= most) return;
    most = Abs(facing), side = facing;
  });
  return side < 0.0;
}

/// Returns the nearest surface point.
SurfacePlace PlaceOf(const NearestOfAll& near, const Vec3& p, bool inside) noexcept {
  const Vec3 away = p - near.at, normal = NormalOf(near.triangle);
  const double sign = inside ? -1.0 : 1.0;
  if (near.distance_m <= kCoincidentM) return {near.at, normal, sign * near.distance_m};
  const double height = Dot(away, normal);
  const Vec3 aside = away - height * normal;
  if (Norm(aside) <= kAbovePlane * near.distance_m) {
    const Vec3 n = (height < 0.0 ? -sign : sign) * normal;
    return {near.at + aside, n, sign * Abs(height)};
  }
  return {near.at, (sign / near.distance_m) * away, sign * near.distance_m};
}

/// Search for the local minima of a point's distance; keeps the nearest ones, sorted by distance.
class PlaceSearch {
 public:
  PlaceSearch(const SurfaceTable& s, const Vec3* middle, const Vec3& point, double limit_m,
              SurfacePlace* out, int most) noexcept
      : seams_(s.seams),
        solid_(s.solid),
        middle_(middle),
        point_(point),
        limit_m_(limit_m),
        out_(out),
        most_(most) {}

  /// Adds a minimum within a triangle.
  void Face(const SurfaceTriangle& t) noexcept {
    const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const double n2 = Dot(n, n), at = Dot(n, point_ - t.p[0]);
    if (at * at > limit_m_ * limit_m_ * n2) return;
    // Adjacent pieces may have a gap between them.
    const double beside_m = seams_.count > 0 ? seams_.same_m : kCoincidentM;
    const double slack2 = kAbovePlane * kAbovePlane * (at * at) + beside_m * beside_m * n2;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = t.p[k == 2 ? 0 : k + 1] - t.p[k];
      const double within = Dot(Cross(n, edge), point_ - t.p[k]);
      if (within >= 0.0) continue;
      if (within * within > slack2 * Dot(edge, edge)) return;
    }
    // The nearest point is computed from the point along the normal, not from a corner along the
    // edges, so the direction between both points is as accurate as the normal.
    const double length = Sqrt(n2), height = at / length;
    // The solid is behind its faces.
    if (solid_ && height < -kCoincidentM) return;
    const SurfacePlace place{point_ - (at / n2) * n,
                             (height < 0.0 ? -1.0 / length : 1.0 / length) * n, Abs(height)};
    if (seams_.count > 0 && IsFaceCovered(seams_, t, {place.at, place.normal, middle_}, kExactly))
      return;
    Add(place);
  }
  /// Adds a minimum on a sharp edge.
  template <class EdgeOf>
  void Edge(const Vec3& start, const Vec3& end, const EdgeOf& edge_of) noexcept {
    const Vec3 edge = end - start, a = point_ - start;
    const double along = Dot(a, edge), edge2 = Dot(edge, edge);
    const Vec3 away = a - (along / edge2) * edge;
    const double away2 = Dot(away, away);
    if (away2 > limit_m_ * limit_m_) return;
    // A straight ridge has no corner at its corners.
    const double beyond = Larger(-along, along - edge2);
    const double slack2 = kAbovePlane * kAbovePlane * away2 + kCoincidentM * kCoincidentM;
    if (beyond > 0.0 && beyond * beyond > slack2 * edge2) return;
    const SurfaceEdge e = edge_of();
    for (int k = 0; k < e.sides; ++k) {
      if (Dot(away, e.apex[k] - e.from) > 0.0) return;
    }
    if (seams_.count > 0 && !(away2 <= kCoincidentM * kCoincidentM) &&
        IsEdgeCovered(seams_, start, end, {point_ - away, (1.0 / Sqrt(away2)) * away, middle_},
                      kExactly)) {
      return;
    }
    AddAway(point_ - away, away);
  }
  /// Adds a minimum at a sharp corner.
  template <class EachBeside>
  void Corner(const Vec3& p, const EachBeside& each_beside) noexcept {
    const Vec3 away = point_ - p;
    if (Dot(away, away) > limit_m_ * limit_m_) return;
    bool outside = true;
    each_beside(
        [&](const Vec3& other) noexcept { outside = outside && Dot(away, other - p) <= 0.0; });
    if (!outside) return;
    const double away2 = Dot(away, away);
    if (seams_.count > 0 && !(away2 <= kCoincidentM * kCoincidentM) &&
        IsCovered(seams_, p, (1.0 / Sqrt(away2)) * away, kExactly)) {
      return;
    }
    AddAway(p, away);
  }
  /// Adds a minimum. Of equal minima, the first is kept, because the direction of a face is exact.
  void Add(const SurfacePlace& place) noexcept {
    const double same = kSamePlace * place.distance_m + kCoincidentM;
    for (int i = 0; i < kept_count_; ++i) {
      const Vec3 apart = place.at - kept_[i];
      if (Dot(apart, apart) <= same * same) return;
    }
    if (kept_count_ == kMaxPlaces) return;
    kept_[kept_count_++] = place.at;
    int at = count_;
    while (at > 0 && place.distance_m < out_[at - 1].distance_m) --at;
    if (at == most_) return;
    if (count_ < most_) ++count_;
    for (int i = count_ - 1; i > at; --i) out_[i] = out_[i - 1];
    out_[at] = place;
  }
  int count() const noexcept { return count_; }

 private:
  void AddAway(const Vec3& at, const Vec3& away) noexcept {
    const double distance = Norm(away);
    if (distance > kCoincidentM) Add({at, (1.0 / distance) * away, distance});
  }
  const SeamList& seams_;
  bool solid_;
  const Vec3* middle_;
  Vec3 point_;
  double limit_m_;
  SurfacePlace* out_;
  int most_, count_ = 0, kept_count_ = 0;
  Vec3 kept_[kMaxPlaces];
};

/// Returns whether another piece covers a wall point and all points above it. Fields end at their
/// border in vertical walls.
bool IsWallCovered(const SurfaceTable& s, const SurfacePlace& place, const Vec3* middle) noexcept {
  if (s.seams.count == 0 || !IsCovered(s.seams, place.at, place.normal, kExactly)) return false;
  const Vec3 top{place.at.x, place.at.y, HeightAt(s, place.at.x, place.at.y)};
  return !IsExposed(s.seams, top, {place.at, place.normal, middle}, kExactly);
}

/// Finds the nearest point on the border walls to a point outside a field and below its border.
bool PlaceOnWall(const SurfaceTable& s, const Vec3& p, double limit_m, const Vec3* middle,
                 SurfacePlace* out) noexcept {
  const Vec3 foot{Clamp(p.x, s.low.x, s.high.x), Clamp(p.y, s.low.y, s.high.y), p.z};
  const Vec3 away = p - foot;
  const double distance = Norm(away);
  if (!(distance > kCoincidentM && distance <= limit_m)) return false;
  if (!(p.z < HeightAt(s, foot.x, foot.y))) return false;
  *out = {foot, (1.0 / distance) * away, distance};
  return !IsWallCovered(s, *out, middle);
}

/// Returns whether other pieces cover the shortest exit.
bool IsWayCovered(const SurfaceTable& s, const NearestOfAll& near, const Vec3& p,
                  const Vec3* middle) noexcept {
  if (s.seams.count == 0) return false;
  const Vec3 out = near.distance_m <= kCoincidentM ? NormalOf(near.triangle)
                                                   : (1.0 / near.distance_m) * (near.at - p);
  return IsFaceCovered(s.seams, near.triangle, {near.at, out, middle}, kExactly);
}

/// Finds the shortest exit from a field: to its surface or through a wall.
bool WayOutOfField(const SurfaceTable& s, const Vec3& p, double limit_m, double depth,
                   const Vec3* middle, SurfacePlace* out) noexcept {
  const SurfacePlace walls[] = {{{s.low.x, p.y, p.z}, {-1.0, 0.0, 0.0}, s.low.x - p.x},
                                {{s.high.x, p.y, p.z}, {1.0, 0.0, 0.0}, p.x - s.high.x},
                                {{p.x, s.low.y, p.z}, {0.0, -1.0, 0.0}, s.low.y - p.y},
                                {{p.x, s.high.y, p.z}, {0.0, 1.0, 0.0}, p.y - s.high.y}};
  const SurfacePlace* best = nullptr;
  double least_m = Larger(limit_m, depth);
  for (const SurfacePlace& wall : walls) {
    if (-wall.distance_m > least_m || IsWallCovered(s, wall, middle)) continue;
    best = &wall, least_m = -wall.distance_m;
  }
  const double reach_m =
      best == nullptr ? least_m : (Larger(least_m, 0.0) + kWallNearerM) / kWallNearer;
  const NearestOfAll near(s, p, reach_m, nullptr, nullptr);
  if (near.found && !IsWayCovered(s, near, p, middle)) {
    *out = PlaceOf(near, p, true);
    return true;
  }
  if (near.found) {
    const NearestOfAll open(s, p, reach_m, &s.seams, middle);
    if (open.found) {
      *out = PlaceOf(open, p, true);
      return true;
    }
  }
  if (best != nullptr) *out = *best;
  return best != nullptr;
}

/// Finds the shortest exit from a closed mesh. Returns false if the point is outside, or other
/// pieces cover all exits. A point in a gap smaller than the tolerance `same_m` is inside both
/// pieces.
bool WayOutOfMesh(const SurfaceTable& s, const Vec3& p, double reach_m, const Vec3* middle,
                  bool* inside, SurfacePlace* out) noexcept {
  const NearestOfAll near(s, p, reach_m, nullptr, nullptr);
  if (!near.found) return false;
  *inside = IsInsideOfMesh(s, p, near);
  if (s.seams.count == 0) {
    if (*inside) *out = PlaceOf(near, p, true);
    return *inside;
  }
  bool in_gap = false;
  if (!*inside && near.distance_m <= s.seams.same_m) {
    const Vec3 away = p - near.at;
    const Vec3 out_of =
        near.distance_m <= kCoincidentM ? NormalOf(near.triangle) : (1.0 / near.distance_m) * away;
    in_gap = IsFaceCovered(s.seams, near.triangle, {near.at, out_of, middle}, kExactly);
  }
  if (!*inside && !in_gap) return false;
  if (*inside && !IsWayCovered(s, near, p, middle)) {
    *out = PlaceOf(near, p, true);
    return true;
  }
  const NearestOfAll open(s, p, reach_m, &s.seams, middle);
  if (!open.found) return false;
  if (in_gap && Dot(p - open.at, NormalOf(open.triangle)) > 0.0) return false;
  *out = PlaceOf(open, p, true);
  return true;
}

}  // namespace

Vec3 NearestPlaceOf(const SurfaceTriangle& t, const Vec3& point) noexcept {
  return NearestOf(t, point);
}

int NearestPlaces(const SurfaceTable& s, const Vec3& point, double limit_m, SurfacePlace* out,
                  int most, const NearParts::OfEnd* known, bool above,
                  const Vec3* middle) noexcept {
  if (above && known != nullptr && known->count == 0) return 0;
  PlaceSearch search(s, middle, point, limit_m, out, most);
  if (s.is_field && !above) {
    // Inside the field, the depth limits the search.
    const double depth = DepthBelow(s, point);
    if (depth > 0.0) return WayOutOfField(s, point, limit_m, depth, middle, out) ? 1 : 0;
    if (PlaceOnWall(s, point, limit_m, middle, out)) search.Add(SurfacePlace(*out));
  } else if (s.solid && !s.is_field) {
    bool inside = false;
    if (WayOutOfMesh(s, point, limit_m + s.bucket_m, middle, &inside, out)) return 1;
    if (inside) return 0;
  }
  const auto face = [&](const SurfaceTriangle& t) noexcept { search.Face(t); };
  const auto edge = [&](const Vec3& start, const Vec3& end, const auto& edge_of) noexcept {
    search.Edge(start, end, edge_of);
  };
  const auto corner = [&](const Vec3& p, const auto& each_beside) noexcept {
    search.Corner(p, each_beside);
  };
  if (known != nullptr && known->count <= NearParts::kMostOfEnd) {
    EachPart(s, *known, face, edge, corner);
    return search.count();
  }
  const double wide_m = WiderLook(s) * limit_m;
  const Vec3 reach{wide_m, wide_m, wide_m};
  EachTriangle(s, point - reach, point + reach, face);
  EachSharp(
      s, {point, {0.0, 0.0, 0.0}, 0.0, 0.0, wide_m},
      [&](const LineStretch&, const Vec3& start, const Vec3& end, const auto& edge_of) noexcept {
        edge(start, end, edge_of);
      },
      [&](const LineStretch&, const Vec3& p, const auto& each_beside) noexcept {
        corner(p, each_beside);
      });
  return search.count();
}

}  // namespace taut::sim
