// Narrow phase of a rod or a sphere on a terrain surface.
#include "sim/geometry/shape_contacts.h"
#include "sim/geometry/surface_near.h"
#include "sim/geometry/touch_list.h"

namespace taut::sim {
namespace {

constexpr int kPlacesOfEnd = 3, kPlacesBetween = 4;
/// Contacts between the ends are numbered by their position on the rod.
static_assert(FeaturesOfEnd(1) == 7u << kPlacesOfEnd && FeaturesOfEnd(0) == 7u);
constexpr int kStretches = kMaxPointsPerPair - 2 * kPlacesOfEnd;
static_assert(kPlacesBetween <= kStretches);
/// Search distance below a shape in units of its size; fraction of it that is searched exactly;
/// factor between further searches, which use bounds.
constexpr double kFarthestLook = 4.0, kNearestLook = 1.0 / 64, kFurther = 4.0;
/// Points closer than a thousandth of the radius are merged. Therefore the smallest gap may jump
/// when the rod hardly moves. The constant is the bound of this jump, in radii.
constexpr double kSameContact = 0.01;

/// A point of a rod is redundant if a chord between its neighbors lies below it. Tolerance in
/// radii, and cosine above which all three normals agree.
constexpr double kSameGap = 1e-6, kSameWay = 0.999;

/// Contact found along a rod.
struct Found {
  double share;
  SurfacePlace place;
  int feature;
};

/// Returns whether two other points, one on each side, keep the rod off this place.
bool IsHeld(const Found* all, int count, int which, double tolerance_m) noexcept {
  const Found& f = all[which];
  for (int i = 0; i < count; ++i) {
    const Found& low = all[i];
    if (!(low.share < f.share) || Dot(low.place.normal, f.place.normal) < kSameWay) continue;
    for (int k = 0; k < count; ++k) {
      const Found& high = all[k];
      if (!(high.share > f.share) || Dot(high.place.normal, f.place.normal) < kSameWay) continue;
      const double part = (f.share - low.share) / (high.share - low.share);
      const double chord =
          low.place.distance_m + part * (high.place.distance_m - low.place.distance_m);
      if (f.place.distance_m > chord - tolerance_m) return true;
    }
  }
  return false;
}

/// Returns whether `a` precedes `b` lexicographically. The order of normals does not change while
/// shapes slide.
bool Before(const Vec3& a, const Vec3& b) noexcept {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

}  // namespace

int Touch(const RoundShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept {
  return TouchGround(a, b, margin_m, 0, nullptr, out);
}

int TouchGround(const RoundShape& a, const SurfaceShape& b, double margin_m, unsigned elsewhere,
                NearParts* kept, TouchPoint* out) noexcept {
  const SurfaceTable& s = *b.table;
  TouchList list(out, margin_m);
  const double r = a.radius_m, limit_m = r + Larger(margin_m, 0.0);
  const Vec3 from = Load(a.from), to = Load(a.to);
  bool known = kept != nullptr && Serves(s, from, to, limit_m, *kept);
  LineReach line{from, to - from, 0.0, 1.0, limit_m};
  if (known && kept->looks < NearParts::kFewLooks) ++kept->looks;
  // If the line is above all edges, omitted parts have no effect.
  if (!known || !kept->over || kept->between.count > NearParts::kMostBetween) {
    const LineReach reach = ReachOfLine(s, from, to, WiderLook(s) * limit_m);
    if (reach.low > reach.high) return 0;
    line.low = reach.low, line.high = reach.high;
  }
  if (kept != nullptr && !known) known = KeepParts(s, from, to, limit_m, *kept);
  Found all[2 * kPlacesOfEnd + kPlacesBetween];
  int count = 0;
  const bool ball = from.x == to.x && from.y == to.y && from.z == to.z;
  LinePlace between[kPlacesBetween];
  const int places_between =
      ball ? 0
           : NearestAlong(s, line, r, between, kPlacesBetween, known ? &kept->between : nullptr);
  for (int end = 0; end < (ball ? 1 : 2); ++end) {
    if (end == 0 ? line.low > 0.0 : line.high < 1.0) continue;
    // An end covered by another shape counts only as support for points between the ends.
    if ((elsewhere & FeaturesOfEnd(end)) != 0 && places_between == 0) continue;
    SurfacePlace places[kPlacesOfEnd];
    const int ways = NearestPlaces(s, end == 0 ? from : to, limit_m, places, kPlacesOfEnd,
                                   known ? &kept->ends[end] : nullptr, known && kept->above[end]);
    for (int i = 1; i < ways; ++i) {
      for (int k = i; k > 0 && Before(places[k].normal, places[k - 1].normal); --k) {
        const SurfacePlace swapped = places[k];
        places[k] = places[k - 1], places[k - 1] = swapped;
      }
    }
    for (int i = 0; i < ways; ++i) {
      all[count++] = {static_cast<double>(end), places[i], kPlacesOfEnd * end + i};
    }
  }
  bool taken[kStretches] = {};
  for (int i = 0; i < places_between; ++i) {
    int stretch = static_cast<int>(between[i].share * kStretches);
    while (taken[stretch]) stretch = stretch + 1 == kStretches ? 0 : stretch + 1;
    taken[stretch] = true;
    all[count++] = {between[i].share, between[i].place, 2 * kPlacesOfEnd + stretch};
  }
  for (int i = 0; i < count; ++i) {
    if (elsewhere >> all[i].feature & 1u) continue;
    const SurfacePlace& place = all[i].place;
    const double gap = place.distance_m - r;
    if (IsHeld(all, count, i, kSameGap * r)) continue;
    list.Add(place.at + gap * place.normal, place.normal, gap, all[i].feature);
  }
  return list.count();
}

double DistanceUpTo(const RoundShape& a, const SurfaceShape& b, double enough_m) noexcept {
  return DistanceToGround(a, b, enough_m, nullptr);
}

double DistanceToGround(const RoundShape& a, const SurfaceShape& surface, double enough_m,
                        NearParts* kept) noexcept {
  if (!(enough_m > 0.0)) return 0.0;  // the search below multiplies enough_m
  const SurfaceShape b{&Alone(*surface.table)};
  const Vec3 from = Load(a.from), to = Load(a.to);
  const double most_m = kFarthestLook * (Norm(to - from) + a.radius_m);
  double look_m = Smaller(enough_m, kNearestLook * most_m);
  TouchPoint points[kMaxPointsPerPair];
  // This search is wider than a contact search, so it must not refill the cache.
  const bool serves = kept != nullptr && Serves(*b.table, from, to, a.radius_m + look_m, *kept);
  const int count = TouchGround(a, b, look_m, 0, serves ? kept : nullptr, points);
  if (count > 0) {
    double least_m = look_m;
    for (int i = 0; i < count; ++i) least_m = Smaller(least_m, points[i].gap_m);
    return Larger(least_m - kSameContact * a.radius_m, 0.0);
  }
  const auto is_clear = [&](double reach_m) noexcept {
    const LineReach line = ReachOfLine(*b.table, from, to, reach_m + a.radius_m);
    return line.low > line.high;
  };
  while (look_m < most_m && is_clear(kFurther * look_m)) look_m = kFurther * look_m;
  return look_m;
}

}  // namespace taut::sim
