// Narrow phase of a rod or a sphere and a hull: ends of the centerline, its nearest point, and
// points where it enters and leaves the Voronoi region of an edge.
#include "sim/geometry/convex.h"
#include "sim/geometry/line_stretch.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {
namespace {

constexpr int kNearestFeature = 2, kFirstStation = 3;
/// Distance below which points of the centerline are merged, in radii.
constexpr double kSamePlace = 1e-3;
/// A point is redundant if its neighbors imply the same gap there, to within this fraction of the
/// radius.
constexpr double kSameGap = 1e-6;

/// Search for contacts of a capsule with a convex body.
class RoundSearch {
 public:
  RoundSearch(const RoundShape& round, const HullShape& hull) noexcept
      : convex_(hull),
        from_(Load(round.from)),
        along_(Load(round.to) - from_),
        length_m_(Norm(along_)),
        radius_m_(round.radius_m) {}

  /// Returns the distance of the centerline from the body; 0 if it passes through.
  double Distance() noexcept {
    FindNearest();
    return Larger(nearest_.distance_m, 0.0);
  }

  void Touch(TouchList& list) noexcept {
    FindNearest();
    if (!(nearest_.distance_m - radius_m_ < list.margin_m())) return;
    if (length_m_ == 0.0) {
      Add(list, 0.0, nearest_, 0);
    } else if (nearest_.distance_m > 0.0) {
      TouchOutside(list);
    } else {
      TouchInside(list);
    }
  }

 private:
  Vec3 At(double t) const noexcept { return t == 1.0 ? from_ + along_ : from_ + t * along_; }

  void Add(TouchList& list, double t, const NearestOfConvex& place, int feature) const noexcept {
    const double gap_m = place.distance_m - radius_m_;
    list.Add(At(t) - (radius_m_ + 0.5 * gap_m) * place.normal, place.normal, gap_m, feature);
  }

  void Keep(double t, const NearestOfConvex& place) noexcept {
    if (place.distance_m < nearest_.distance_m) nearest_ = place, nearest_at_ = t;
  }

  /// Finds the nearest point of the centerline: at an end, at an edge, or inside.
  void FindNearest() noexcept {
    ends_[0] = NearestTo(convex_, At(0.0));
    nearest_ = ends_[0], nearest_at_ = 0.0;
    if (length_m_ == 0.0) return;
    ends_[1] = NearestTo(convex_, At(1.0));
    Keep(1.0, ends_[1]);
    inside_ = {0.0, 1.0};
    for (int face = 0; face < convex_.table->face_count; ++face) {
      inside_.CutAbove(convex_.Above(face, from_), Dot(convex_.normals[face], along_));
    }
    if (inside_.low <= inside_.high) {
      nearest_.distance_m = Smaller(nearest_.distance_m, 0.0);
      return;
    }
    for (int i = 0; i < convex_.table->edge_count; ++i) AgainstEdge(convex_.table->edges[i]);
  }

  /// Tests the interior point of the line nearest to an edge.
  void AgainstEdge(const HullEdge& edge) noexcept {
    const Vec3 start = convex_.FromOf(edge), side = convex_.AlongOf(edge);
    const Vec3 c = Cross(along_, side), between = start - from_;
    const double c2 = Dot(c, c);
    if (!(c2 > 0.0)) return;  // parallel: an end is as near
    const double on_edge = Clamp(Dot(Cross(between, along_), c) / c2, 0.0, 1.0);
    const Vec3 place = start + on_edge * side;
    const double t = Dot(place - from_, along_) / (length_m_ * length_m_);
    if (!(t > 0.0 && t < 1.0)) return;
    const Vec3 way = At(t) - place;
    const double distance = Norm(way);
    if (distance < nearest_.distance_m) Keep(t, {place, (1.0 / distance) * way, distance});
  }

  /// Adds the contacts of a centerline outside of the body.
  void TouchOutside(TouchList& list) noexcept {
    AddStation(list, 0.0, ends_[0], 0);
    AddStation(list, 1.0, ends_[1], 1);
    for (int i = 0; i < convex_.table->edge_count; ++i) AlongEdge(i, list);
    if (IsHeld(radius_m_ + list.margin_m())) return;
    Add(list, nearest_at_, nearest_, kNearestFeature);
  }

  /// Adds the points at which the line enters and leaves the Voronoi region of an edge, which lies
  /// between the regions of its two faces.
  void AlongEdge(int which, TouchList& list) noexcept {
    const HullEdge& edge = convex_.table->edges[which];
    const Vec3 start = convex_.FromOf(edge), side = convex_.AlongOf(edge), to_line = from_ - start;
    LineStretch beside{0.0, 1.0};
    beside.CutAbove(-Dot(to_line, side), -Dot(along_, side));
    beside.CutAbove(Dot(to_line, side) - Dot(side, side), Dot(along_, side));
    // Vectors in the plane of each face, pointing into the face.
    const Vec3 left = Cross(convex_.normals[edge.left], side);
    const Vec3 right = Cross(side, convex_.normals[edge.right]);
    beside.CutAbove(Dot(to_line, left), Dot(along_, left));
    beside.CutAbove(Dot(to_line, right), Dot(along_, right));
    if (beside.low > beside.high) return;
    for (int end = 0; end < 2; ++end) {
      const double t = end == 0 ? beside.low : beside.high;
      const Vec3 way = At(t) - start;
      const Vec3 out = way - (Dot(way, side) / Dot(side, side)) * side;
      const double distance = Norm(out);
      if (!(distance > 0.0)) continue;
      AddPlace(list, t, {At(t) - out, (1.0 / distance) * out, distance}, 2 * which + end);
    }
  }

  /// Adds a point unless one is already at this place.
  void AddPlace(TouchList& list, double t, const NearestOfConvex& place, int id) noexcept {
    if (!(place.distance_m - radius_m_ < list.margin_m()) || station_count_ == kStations) return;
    for (int i = 0; i < station_count_; ++i) {
      if (Abs(stations_[i].t - t) * length_m_ < kSamePlace * radius_m_) return;
    }
    int number = id % (kStations - 2);
    while (taken_[number]) number = number + 1 == kStations - 2 ? 0 : number + 1;
    taken_[number] = true;
    AddStation(list, t, place, kFirstStation + number);
  }
  void AddStation(TouchList& list, double t, const NearestOfConvex& place, int feature) noexcept {
    stations_[station_count_++] = {t, place.distance_m};
    Add(list, t, place, feature);
  }

  /// Returns whether the neighbors of the nearest point can carry all of its loads: the distance is
  /// convex along the line, and the point is not below the chord between them.
  bool IsHeld(double reach_m) const noexcept {
    Station before = stations_[0], after = stations_[1];
    for (int i = 2; i < station_count_; ++i) {
      const Station& s = stations_[i];
      if (s.t <= nearest_at_ && s.t > before.t) before = s;
      if (s.t >= nearest_at_ && s.t < after.t) after = s;
    }
    if (nearest_at_ == 0.0) after = before;
    if (nearest_at_ == 1.0) before = after;
    if (!(Smaller(before.distance_m, after.distance_m) < reach_m)) return false;
    const double share = after.t > before.t ? (nearest_at_ - before.t) / (after.t - before.t) : 0.0;
    const double chord = before.distance_m + share * (after.distance_m - before.distance_m);
    return chord - nearest_.distance_m <= kSameGap * radius_m_;
  }

  /// Adds the contacts of a line that runs through the inside of the hull, one at each end of its
  /// inner part. Both contacts have the normal of the face with the smallest depth of the deeper
  /// end.
  void TouchInside(TouchList& list) const noexcept {
    int best = 0;
    double best_m = -1e300;
    const Vec3 low = At(inside_.low), high = At(inside_.high);
    for (int face = 0; face < convex_.table->face_count; ++face) {
      const double out_m = Smaller(convex_.Above(face, low), convex_.Above(face, high));
      if (out_m > best_m) best_m = out_m, best = face;
    }
    const auto add = [&](double t, const Vec3& p, int feature) noexcept {
      const double above = convex_.Above(best, p);
      Add(list, t, {p - above * convex_.normals[best], convex_.normals[best], above}, feature);
    };
    add(inside_.low, low, 0);
    if ((inside_.high - inside_.low) * length_m_ > kSamePlace * radius_m_) {
      add(inside_.high, high, 1);
    }
  }

  /// Point of the centerline.
  struct Station {
    double t, distance_m;
  };
  static constexpr int kStations = kMaxPointsPerPair - kFirstStation + 2;  ///< Includes both ends.

  Convex convex_;
  Vec3 from_, along_;
  double length_m_, radius_m_;
  NearestOfConvex ends_[2], nearest_;
  double nearest_at_ = 0.0;
  LineStretch inside_{1.0, 0.0};  ///< Segment of the line inside the body.
  Station stations_[kStations];
  bool taken_[kStations - 2] = {};
  int station_count_ = 0;
};

}  // namespace

int Touch(const RoundShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept {
  TouchList list(out, margin_m);
  RoundSearch(a, b).Touch(list);
  return list.count();
}

double Distance(const RoundShape& a, const HullShape& b) noexcept {
  return Larger(RoundSearch(a, b).Distance() - a.radius_m, 0.0);
}

}  // namespace taut::sim
