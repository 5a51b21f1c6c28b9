// Contacts with a surface are the local minima of its distance over all of it: a place on an edge
// or a corner counts if it is the nearest of every triangle there. No edge is marked and no angle
// is compared, so that what rolls over triangles of one plane feels nothing of them.
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
constexpr int kMaxNear = 96, kMaxPlaces = 16;

enum class On { kFace, kEdge, kCorner };

/// The place of a triangle that is nearest to a point. Source: C. Ericson, Real-Time Collision
/// Detection (Morgan Kaufmann 2005), section 5.1.5.
struct Nearest {
  Vec3 at;
  On on;
  int a, b;  ///< The corner, or the edge's two, of the triangle's three.
};

Nearest NearestOf(const SurfaceTriangle& t, const Vec3& p) noexcept {
  const Vec3 ab = t.p[1] - t.p[0], ac = t.p[2] - t.p[0], ap = p - t.p[0];
  const double d1 = Dot(ab, ap), d2 = Dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {t.p[0], On::kCorner, 0, 0};
  const Vec3 bp = p - t.p[1];
  const double d3 = Dot(ab, bp), d4 = Dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return {t.p[1], On::kCorner, 1, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    return {t.p[0] + (d1 / (d1 - d3)) * ab, On::kEdge, 0, 1};
  }
  const Vec3 cp = p - t.p[2];
  const double d5 = Dot(ab, cp), d6 = Dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return {t.p[2], On::kCorner, 2, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    return {t.p[0] + (d2 / (d2 - d6)) * ac, On::kEdge, 0, 2};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {t.p[1] + share * (t.p[2] - t.p[1]), On::kEdge, 1, 2};
  }
  // From the plane, not from the corner: the direction is then as good as the normal.
  const Vec3 n = Cross(ab, ac);
  return {p - (Dot(n, ap) / Dot(n, n)) * n, On::kFace, 0, 0};
}

Vec3 NormalOf(const SurfaceTriangle& t) noexcept {
  const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  return (1.0 / Norm(n)) * n;
}

bool Has(const SurfaceTriangle& t, int corner) noexcept {
  return t.corner[0] == corner || t.corner[1] == corner || t.corner[2] == corner;
}

/// A triangle near a point.
struct NearTriangle {
  SurfaceTriangle triangle;
  Nearest nearest;
  double distance_m;
};

/// All triangles within a distance of a point; where there are too many, within a smaller one.
struct Neighbours {
  NearTriangle all[kMaxNear];
  int count = 0;

  void Find(const SurfaceTable& s, const Vec3& p, double limit_m) noexcept {
    double least = limit_m;
    while (!Fill(s, p, limit_m, &least)) limit_m = least + 0.25 * (limit_m - least);
  }

 private:
  bool Fill(const SurfaceTable& s, const Vec3& p, double limit_m, double* least) noexcept {
    count = 0;
    bool overflow = false;
    const Vec3 reach{limit_m, limit_m, limit_m};
    EachTriangle(s, p - reach, p + reach, [&](const SurfaceTriangle& t) noexcept {
      const Nearest nearest = NearestOf(t, p);
      const double distance = Norm(p - nearest.at);
      if (!(distance <= limit_m)) return;
      *least = Smaller(*least, distance);
      overflow = overflow || count == kMaxNear;
      if (count < kMaxNear) all[count++] = {t, nearest, distance};
    });
    // Fans of a hundred at one place are cut off: a smaller limit would not help.
    return !overflow || limit_m - *least <= 1e-9 * limit_m;
  }
};

/// Whether every triangle at this one's nearest place has it for its nearest, too.
bool IsLeast(const Neighbours& near, int which) noexcept {
  const NearTriangle& t = near.all[which];
  if (t.nearest.on == On::kFace) return true;
  const int a = t.triangle.corner[t.nearest.a], b = t.triangle.corner[t.nearest.b];
  const double enough = t.distance_m * (1.0 - kSameDistance);
  for (int i = 0; i < near.count; ++i) {
    const NearTriangle& other = near.all[i];
    if (other.distance_m < enough && Has(other.triangle, a) && Has(other.triangle, b)) return false;
  }
  return true;
}

/// Whether a point is inside, seen from the triangles at the nearest place of all.
bool IsInside(const SurfaceTable& s, const Vec3& p, const Neighbours& near, int nearest) noexcept {
  if (!s.solid) return false;
  if (s.is_field) return DepthBelow(s, p) > 0.0;
  // At an edge or a corner the triangle that faces the point most directly knows.
  const Vec3 away = p - near.all[nearest].nearest.at;
  const double same = near.all[nearest].distance_m * (1.0 + kSameDistance);
  double most = 0.0, side = 0.0;
  for (int i = 0; i < near.count; ++i) {
    const NearTriangle& t = near.all[i];
    if (t.distance_m > same) continue;
    const double facing = Dot(away, NormalOf(t.triangle));
    if (Abs(facing) <= most) continue;
    most = Abs(facing), side = facing;
  }
  return side < 0.0;
}

SurfacePlace PlaceOf(const NearTriangle& t, const Vec3& p, bool inside) noexcept {
  const Vec3 away = p - t.nearest.at, normal = NormalOf(t.triangle);
  const double sign = inside ? -1.0 : 1.0;
  if (t.distance_m <= kCoincidentM) return {t.nearest.at, normal, sign * t.distance_m};
  const double height = Dot(away, normal);
  const Vec3 aside = away - height * normal;
  if (Norm(aside) <= kAbovePlane * t.distance_m) {
    const Vec3 n = (height < 0.0 ? -sign : sign) * normal;
    return {t.nearest.at + aside, n, sign * Abs(height)};
  }
  return {t.nearest.at, (sign / t.distance_m) * away, sign * t.distance_m};
}

/// Places found so far, the nearest first.
class Places {
 public:
  Places(SurfacePlace* out, int most) noexcept : out_(out), most_(most) {}
  void Add(const SurfacePlace& place) noexcept {
    int at = count_;
    while (at > 0 && place.distance_m < out_[at - 1].distance_m) --at;
    if (at == most_) return;
    if (count_ < most_) ++count_;
    for (int i = count_ - 1; i > at; --i) out_[i] = out_[i - 1];
    out_[at] = place;
  }
  int count() const noexcept { return count_; }

 private:
  SurfacePlace* out_;
  int most_, count_ = 0;
};

}  // namespace

int NearestPlaces(const SurfaceTable& s, const Vec3& point, double limit_m, SurfacePlace* out,
                  int most) noexcept {
  if (s.is_field) limit_m = Larger(limit_m, DepthBelow(s, point));
  if (!s.is_field && s.solid) limit_m += s.bucket_m;  // so deep it is still found
  Neighbours near;
  near.Find(s, point, limit_m);
  if (near.count == 0) return 0;
  int nearest = 0;
  for (int i = 1; i < near.count; ++i) {
    if (near.all[i].distance_m < near.all[nearest].distance_m) nearest = i;
  }
  if (IsInside(s, point, near, nearest)) {
    out[0] = PlaceOf(near.all[nearest], point, true);
    return 1;
  }
  Places places(out, most);
  int kept[kMaxPlaces], kept_count = 0;
  // Faces first: what they find is exact, what their edges find in the same place is nearly so.
  constexpr On kOrder[] = {On::kFace, On::kEdge, On::kCorner};
  for (const On on : kOrder) {
    for (int i = 0; i < near.count && kept_count < kMaxPlaces; ++i) {
      const NearTriangle& t = near.all[i];
      if (t.nearest.on != on || !IsLeast(near, i)) continue;
      bool repeats = false;
      for (int k = 0; k < kept_count; ++k) {
        const Vec3 apart = t.nearest.at - near.all[kept[k]].nearest.at;
        repeats = repeats || Norm(apart) <= kSamePlace * t.distance_m + kCoincidentM;
      }
      if (repeats) continue;
      kept[kept_count++] = i;
      places.Add(PlaceOf(t, point, false));
    }
  }
  return places.count();
}

}  // namespace taut::sim
