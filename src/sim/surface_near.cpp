// Contacts with a surface are the local minima of its distance over all of it: a place in a
// triangle, or on an edge or a corner that sticks out and is the nearest of every triangle there.
// So what rolls over triangles of one plane feels nothing of them.
#include "sim/surface_near.h"

#include "math/scalar.h"
#include "sim/touch_list.h"

namespace taut::sim {
namespace {

/// Nearer than this a point has no direction from a place.
constexpr double kCoincidentM = 1e-10;
/// Two triangles may find their common place at distances that differ so much, as a share.
constexpr double kSameDistance = 1e-12;
/// And, as its root, so far from each other.
constexpr double kSamePlace = 4e-6;
/// A point so nearly above the plane of a triangle, seen from its edge, is above the plane: what is
/// over an edge of one plane has the plane's normal, whatever rounding says of which triangle it
/// is.
constexpr double kAbovePlane = 1e-7;
constexpr int kMaxPlaces = 16;

/// The place of a triangle that is nearest to a point. Source: C. Ericson, Real-Time Collision
/// Detection (Morgan Kaufmann 2005), section 5.1.5.
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
  // From the plane, not from the corner: the direction is then as good as the normal.
  const Vec3 n = Cross(ab, ac);
  return p - (Dot(n, ap) / Dot(n, n)) * n;
}

Vec3 NormalOf(const SurfaceTriangle& t) noexcept {
  const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  return (1.0 / Norm(n)) * n;
}

/// Of all triangles near a point the one that is nearest.
struct NearestOfAll {
  double limit_m, distance_m;
  bool found = false;
  SurfaceTriangle triangle;
  Vec3 at;

  NearestOfAll(const SurfaceTable& s, const Vec3& p, double limit) noexcept
      : limit_m(limit), distance_m(limit) {
    const Vec3 reach{limit_m, limit_m, limit_m};
    EachTriangle(s, p - reach, p + reach, [&](const SurfaceTriangle& t) noexcept {
      const Vec3 place = NearestOf(t, p);
      const double distance = Norm(p - place);
      if (!(distance <= limit_m) || (found && !(distance < distance_m))) return;
      found = true;
      triangle = t, at = place, distance_m = distance;
    });
  }
};

/// Whether a point is inside of a closed mesh, seen from the triangles at the nearest place of all:
/// at an edge or a corner that one knows which faces the point most directly.
bool IsInsideOfMesh(const SurfaceTable& s, const Vec3& p, const NearestOfAll& near) noexcept {
  if (!near.found) return false;
  const double same = near.distance_m * (1.0 + kSameDistance);
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

/// The nearest place of all.
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

/// Local minima of the distance of a point, and those found so far, the nearest first.
class PlaceSearch {
 public:
  PlaceSearch(const Vec3& point, double limit_m, SurfacePlace* out, int most) noexcept
      : point_(point), limit_m_(limit_m), out_(out), most_(most) {}

  /// A place within a triangle.
  void Face(const SurfaceTriangle& t) noexcept {
    const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const double n2 = Dot(n, n), at = Dot(n, point_ - t.p[0]);
    if (at * at > limit_m_ * limit_m_ * n2) return;
    const double slack2 = kAbovePlane * kAbovePlane * (at * at) + kCoincidentM * kCoincidentM * n2;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = t.p[k == 2 ? 0 : k + 1] - t.p[k];
      const double within = Dot(Cross(n, edge), point_ - t.p[k]);
      if (within >= 0.0) continue;
      if (within * within > slack2 * Dot(edge, edge)) return;
    }
    // From the plane, not from a corner: the direction is then as good as the normal.
    const double length = Sqrt(n2), height = at / length;
    Add({point_ - (at / n2) * n, (height < 0.0 ? -1.0 / length : 1.0 / length) * n, Abs(height)});
  }
  /// One on an edge that sticks out.
  template <class EdgeOf>
  void Edge(const Vec3& start, const Vec3& end, const EdgeOf& edge_of) noexcept {
    const Vec3 edge = end - start, a = point_ - start;
    const double along = Dot(a, edge), edge2 = Dot(edge, edge);
    const Vec3 away = a - (along / edge2) * edge;
    const double away2 = Dot(away, away);
    if (away2 > limit_m_ * limit_m_) return;
    // A ridge that goes straight on past a corner has no corner there.
    const double beyond = Larger(-along, along - edge2);
    const double slack2 = kAbovePlane * kAbovePlane * away2 + kCoincidentM * kCoincidentM;
    if (beyond > 0.0 && beyond * beyond > slack2 * edge2) return;
    const SurfaceEdge e = edge_of();
    for (int k = 0; k < e.sides; ++k) {
      if (Dot(away, e.apex[k] - e.from) > 0.0) return;
    }
    AddAway(point_ - away, away);
  }
  /// A corner that sticks out.
  template <class EachBeside>
  void Corner(const Vec3& p, const EachBeside& each_beside) noexcept {
    const Vec3 away = point_ - p;
    if (Dot(away, away) > limit_m_ * limit_m_) return;
    bool outside = true;
    each_beside(
        [&](const Vec3& other) noexcept { outside = outside && Dot(away, other - p) <= 0.0; });
    if (outside) AddAway(p, away);
  }
  /// Of what is found twice the first counts: a face's direction is exact.
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
  Vec3 point_;
  double limit_m_;
  SurfacePlace* out_;
  int most_, count_ = 0, kept_count_ = 0;
  Vec3 kept_[kMaxPlaces];
};

}  // namespace

Vec3 NearestPlaceOf(const SurfaceTriangle& t, const Vec3& point) noexcept {
  return NearestOf(t, point);
}

int NearestPlaces(const SurfaceTable& s, const Vec3& point, double limit_m, SurfacePlace* out,
                  int most, const NearParts::OfEnd* known, bool above) noexcept {
  if (above && known != nullptr && known->count == 0) return 0;
  PlaceSearch search(point, limit_m, out, most);
  // So deep it is still found.
  const double depth = above ? 0.0 : s.is_field ? DepthBelow(s, point) : s.bucket_m;
  // Beside a field it may be seen from below, where other edges stick out.
  const bool beside = s.is_field && (point.x < s.low.x || point.x > s.high.x || point.y < s.low.y ||
                                     point.y > s.high.y);
  if (s.solid && (!s.is_field || depth > 0.0 || beside)) {
    const NearestOfAll near(s, point, s.is_field ? Larger(limit_m, depth) : limit_m + depth);
    const bool inside = s.is_field ? depth > 0.0 : IsInsideOfMesh(s, point, near);
    if (near.found && inside) {
      out[0] = PlaceOf(near, point, true);
      return 1;
    }
    if (near.found && beside) search.Add(PlaceOf(near, point, false));
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
