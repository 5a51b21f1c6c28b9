// Narrow phase of capsules and spheres with each other and with boxes.
#include "sim/geometry/shape_contacts.h"

#include "sim/geometry/touch_list.h"

namespace taut::sim {
namespace {

/// Distance between centerline points below which its direction is undefined [m].
constexpr double kCoincidentM = 1e-10;
/// sin^2 of the angle below which two capsules may touch along a line instead of at a point.
constexpr double kAlongsideSin2 = 0.25;
/// A point is redundant if its neighbors imply the same gap there, to within this fraction of the
/// radius.
constexpr double kSameGap = 1e-6;

struct Segment {
  Vec3 from, to, along;
  explicit Segment(const RoundShape& shape) noexcept
      : from(Load(shape.from)), to(Load(shape.to)), along(to - from) {}
  Vec3 At(double t) const noexcept { return t == 1.0 ? to : from + t * along; }
  double Nearest(const Vec3& p) const noexcept {
    const double length2 = Dot(along, along);
    return length2 > 0.0 ? Clamp(Dot(p - from, along) / length2, 0.0, 1.0) : 0.0;
  }
};

/// A point of each centerline and their distance.
struct CenterPair {
  Vec3 a, b;
  double distance_m;
};

CenterPair MakePair(const Vec3& a, const Vec3& b) noexcept { return {a, b, Norm(a - b)}; }
CenterPair FromA(const Vec3& a, const Segment& b) noexcept {
  return MakePair(a, b.At(b.Nearest(a)));
}
CenterPair FromB(const Segment& a, const Vec3& b) noexcept {
  return MakePair(a.At(a.Nearest(b)), b);
}

void KeepCloser(CenterPair& best, const CenterPair& other) noexcept {
  if (other.distance_m < best.distance_m) best = other;
}

/// Returns the closest points of two centerlines. Each closest point is an interior point where the
/// lines are closest, or an end. All candidates are tried, so nearly parallel lines lose no
/// accuracy.
CenterPair ClosestPair(const Segment& a, const Segment& b) noexcept {
  CenterPair best = FromA(a.from, b);
  KeepCloser(best, FromA(a.to, b));
  KeepCloser(best, FromB(a, b.from));
  KeepCloser(best, FromB(a, b.to));
  const Vec3 c = Cross(a.along, b.along);
  const double c2 = Dot(c, c);
  if (c2 > 0.0) {
    const Vec3 ab = b.from - a.from;
    const double s = Dot(Cross(ab, b.along), c) / c2, t = Dot(Cross(ab, a.along), c) / c2;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) KeepCloser(best, MakePair(a.At(s), b.At(t)));
  }
  return best;
}

/// Returns a unit vector normal to `a`, which is not zero.
Vec3 Perpendicular(const Vec3& a) noexcept {
  const double x = Abs(a.x), y = Abs(a.y), z = Abs(a.z);
  const Vec3 axis = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 p = Cross(a, axis);
  return (1.0 / Norm(p)) * p;
}

/// Returns a normal for centerlines that intersect: normal to both if they cross, normal to the
/// line if they coincide, up for two points. The sign is arbitrary.
Vec3 NormalOfMeeting(const Segment& a, const Segment& b) noexcept {
  const double a2 = Dot(a.along, a.along), b2 = Dot(b.along, b.along);
  const Vec3 c = Cross(a.along, b.along);
  if (Dot(c, c) > 1e-16 * a2 * b2) return (1.0 / Norm(c)) * c;
  if (a2 == 0.0 && b2 == 0.0) return {0, 0, 1};
  return Perpendicular(a2 > b2 ? a.along : b.along);
}

/// Two round shapes and their contact points.
struct RoundPair {
  Segment a, b;
  double radius_a_m, radius_b_m;
  TouchList list;

  double Gap(const CenterPair& p) const noexcept { return p.distance_m - radius_a_m - radius_b_m; }
  void Add(const CenterPair& p, int feature) noexcept {
    if (!(Gap(p) < list.margin_m())) return;
    const Vec3 n =
        p.distance_m > kCoincidentM ? (1.0 / p.distance_m) * (p.a - p.b) : NormalOfMeeting(a, b);
    const Vec3 middle = 0.5 * (p.a + p.b + (radius_b_m - radius_a_m) * n);
    list.Add(middle, n, Gap(p), feature);
  }
  double SameGapM() const noexcept { return kSameGap * (radius_a_m + radius_b_m); }
};

/// Segment along which two capsules overlap, in the direction of `a`.
struct Overlap {
  bool exists = false;
  CenterPair low = {}, high = {};
  double low_at_m = 0, high_at_m = 0;  ///< Positions along `direction`.
  Vec3 direction = {};
};

Overlap FindOverlap(const RoundPair& pair) noexcept {
  const Segment &a = pair.a, &b = pair.b;
  Overlap overlap;
  const double a2 = Dot(a.along, a.along), b2 = Dot(b.along, b.along);
  const Vec3 c = Cross(a.along, b.along);
  if (a2 == 0.0 || b2 == 0.0 || Dot(c, c) > kAlongsideSin2 * a2 * b2) return overlap;
  const bool same_way = Dot(a.along, b.along) > 0.0;
  const Vec3 &b_low = same_way ? b.from : b.to, &b_high = same_way ? b.to : b.from;
  // The bisector of both directions, so that exchanging the shapes does not change the result.
  const Vec3 both = (1.0 / Sqrt(a2)) * a.along + (1.0 / Sqrt(b2)) * (b_high - b_low);
  overlap.direction = (1.0 / Norm(both)) * both;
  const double a_from = Dot(overlap.direction, a.from), b_from = Dot(overlap.direction, b_low);
  const double a_to = Dot(overlap.direction, a.to), b_to = Dot(overlap.direction, b_high);
  overlap.low_at_m = Larger(a_from, b_from);
  overlap.high_at_m = Smaller(a_to, b_to);
  overlap.exists =
      overlap.high_at_m - overlap.low_at_m > 1e-3 * (pair.radius_a_m + pair.radius_b_m);
  if (!overlap.exists) return overlap;
  overlap.low = a_from > b_from ? FromA(a.from, b) : FromB(a, b_low);
  overlap.high = a_to < b_to ? FromA(a.to, b) : FromB(a, b_high);
  return overlap;
}

/// Capsule in the frame of a box.
struct CapsuleAtBox {
  double from[3], along[3];
  double length_m, radius_m;
  const double* half_m;

  CapsuleAtBox(const RoundShape& shape, const BoxShape& box) noexcept
      : radius_m(shape.radius_m), half_m(box.half_m) {
    const Vec3 a = Load(shape.from) - Load(box.center), ab = Load(shape.to) - Load(shape.from);
    for (int i = 0; i < 3; ++i) {
      from[i] = Dot(AxisOf(box, i), a);
      along[i] = Dot(AxisOf(box, i), ab);
    }
    length_m = Norm(ab);
  }
  double At(int axis, double t) const noexcept { return from[axis] + t * along[axis]; }

  /// Returns the vector from the box to the centerline point at `t`; zero inside.
  Vec3 Beyond(double t) const noexcept {
    double out[3];
    for (int i = 0; i < 3; ++i) {
      const double x = At(i, t);
      out[i] = x - Clamp(x, -half_m[i], half_m[i]);
    }
    return Load(out);
  }
  /// Returns half the derivative of the squared distance, which is piecewise linear and
  /// nondecreasing.
  double Slope(double t) const noexcept { return Dot(Beyond(t), Load(along)); }
};

/// Point of the centerline.
struct Station {
  double t;
  int feature;
};

/// Ends of the centerline, and its intersections with the planes of the box faces.
struct Stations {
  Station all[8];
  int count = 0;

  void Add(double t, int feature) noexcept { all[count++] = {t, feature}; }

  explicit Stations(const CapsuleAtBox& c) noexcept {
    Add(0.0, 0);
    if (c.length_m == 0.0) return;
    Add(1.0, 1);
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const double plane = side == 0 ? -c.half_m[axis] : c.half_m[axis];
        const double t = (plane - c.from[axis]) / c.along[axis];  // infinite or NaN if parallel
        if (t > 0.0 && t < 1.0) Add(t, 3 + 2 * axis + side);
      }
    }
  }
};

/// Returns the point of the centerline nearest to the box: the root of the slope, which is linear
/// between stations.
double NearestToBox(const CapsuleAtBox& c, const Stations& stations) noexcept {
  double low = 0.0, high = 1.0;
  double slope_low = c.Slope(low), slope_high = c.Slope(high);
  if (c.length_m == 0.0 || slope_low >= 0.0) return low;
  if (slope_high <= 0.0) return high;
  for (int i = 2; i < stations.count; ++i) {
    const double t = stations.all[i].t;
    if (t <= low || t >= high) continue;
    const double slope = c.Slope(t);
    (slope < 0.0 ? low : high) = t;
    (slope < 0.0 ? slope_low : slope_high) = slope;
  }
  return Clamp(low + (high - low) * (slope_low / (slope_low - slope_high)), low, high);
}

/// Capsule near a box, and their contact points.
struct RoundBoxPair {
  CapsuleAtBox capsule;
  const BoxShape& box;
  TouchList list;

  /// `out`: unit normal in the frame of the box; `distance_m`: distance of the centerline point
  /// from the box.
  void Add(double t, const Vec3& out, double distance_m, int feature) noexcept {
    const Vec3 n = out.x * AxisOf(box, 0) + out.y * AxisOf(box, 1) + out.z * AxisOf(box, 2);
    Vec3 point = Load(box.center) - 0.5 * (capsule.radius_m + distance_m) * n;
    for (int i = 0; i < 3; ++i) point = point + capsule.At(i, t) * AxisOf(box, i);
    list.Add(point, n, distance_m - capsule.radius_m, feature);
  }
  void AddOutside(double t, int feature) noexcept {
    const Vec3 beyond = capsule.Beyond(t);
    const double distance = Norm(beyond);
    Add(t, (1.0 / distance) * beyond, distance, feature);
  }
};

/// Adds the contacts of a centerline outside of the box: one per station, at its nearest point of
/// the box.
void TouchOutside(RoundBoxPair& pair, const Stations& stations, double nearest) noexcept {
  const CapsuleAtBox& c = pair.capsule;
  const double margin = pair.list.margin_m();
  double before = 0.0, after = 1.0;
  double kept[8];
  int kept_count = 0;
  for (int i = 0; i < stations.count; ++i) {
    const double t = stations.all[i].t;
    bool repeats = false;
    for (int k = 0; k < kept_count; ++k) {
      repeats = repeats || Abs(t - kept[k]) * c.length_m < 1e-3 * c.radius_m;
    }
    if (repeats && i >= 2) continue;
    kept[kept_count++] = t;
    if (t <= nearest) before = Larger(before, t);
    if (t >= nearest) after = Smaller(after, t);
    pair.AddOutside(t, stations.all[i].feature);
  }
  if (c.length_m == 0.0) return;
  // The distance is convex along the line. If the nearest point is not below the chord between its
  // neighbors, these neighbors can carry all loads of the point.
  const double d_before = Norm(c.Beyond(before)), d_after = Norm(c.Beyond(after));
  const double d_nearest = Norm(c.Beyond(nearest));
  const double share = after > before ? (nearest - before) / (after - before) : 0.0;
  const double chord = d_before + share * (d_after - d_before);
  const bool neighbours = Smaller(d_before, d_after) - c.radius_m < margin;
  if (neighbours && chord - d_nearest <= kSameGap * c.radius_m) return;
  pair.AddOutside(nearest, 2);
}

/// Segment of the centerline.
struct Stretch {
  Station low, high;
};

/// Returns the segment between the four faces adjacent to the two faces normal to `face_axis`.
Stretch BetweenSides(const CapsuleAtBox& c, const Stations& stations, int face_axis) noexcept {
  Stretch s{{0.0, 0}, {1.0, 1}};
  for (int i = 2; i < stations.count; ++i) {
    const Station& station = stations.all[i];
    const int plane = station.feature - 3, axis = plane / 2;
    if (axis == face_axis) continue;
    const bool enters = (c.along[axis] > 0.0) == (plane % 2 == 0);
    if (enters && station.t > s.low.t) s.low = station;
    if (!enters && station.t < s.high.t) s.high = station;
  }
  return s;
}

Vec3 UnitAxis(int axis, double sign) noexcept {
  return {axis == 0 ? sign : 0.0, axis == 1 ? sign : 0.0, axis == 2 ? sign : 0.0};
}

/// Shortest exit from a box for a centerline that passes through it: through a face, or normal to
/// the line and an edge.
struct WayOut {
  int axis = 0;  ///< Axis normal to the face, or along the edge.
  bool through_face = true;
  Vec3 normal = {};
  double distance_m = -1e300;  ///< Minus the distance to move the line out of the box.
};

WayOut ThroughFace(const CapsuleAtBox& c, const Stations& stations) noexcept {
  WayOut way;
  for (int axis = 0; axis < 3; ++axis) {
    const Stretch s = BetweenSides(c, stations, axis);
    const double low = c.At(axis, s.low.t), high = c.At(axis, s.high.t);
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? -1.0 : 1.0;
      const double distance = Smaller(sign * low, sign * high) - c.half_m[axis];
      if (distance > way.distance_m) way = {axis, true, UnitAxis(axis, sign), distance};
    }
  }
  return way;
}

WayOut AcrossEdge(const CapsuleAtBox& c) noexcept {
  WayOut way;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 n = Cross(Load(c.along), UnitAxis(axis, 1.0));
    const double length = Norm(n);
    if (length <= 1e-6 * c.length_m) continue;
    n = ((Dot(n, Load(c.from)) < 0.0 ? -1.0 : 1.0) / length) * n;
    const double reach = Abs(n.x) * c.half_m[0] + Abs(n.y) * c.half_m[1] + Abs(n.z) * c.half_m[2];
    const double distance = Dot(n, Load(c.from)) - reach;
    if (distance > way.distance_m) way = {axis, false, n, distance};
  }
  return way;
}

/// Returns the point of the centerline nearest to the edge over which it exits.
double NearestToEdge(const CapsuleAtBox& c, const WayOut& way) noexcept {
  const double n[3] = {way.normal.x, way.normal.y, way.normal.z};
  double dot = 0.0, norm2 = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (i == way.axis) continue;
    const double corner = n[i] < 0.0 ? -c.half_m[i] : c.half_m[i];
    dot += (corner - c.from[i]) * c.along[i];
    norm2 += c.along[i] * c.along[i];
  }
  return Clamp(dot / norm2, 0.0, 1.0);
}

/// Adds the contacts of a centerline deep inside. All points exit in the same direction, because
/// separate directions could contradict each other.
void TouchInside(RoundBoxPair& pair, const Stations& stations) noexcept {
  const CapsuleAtBox& c = pair.capsule;
  const WayOut face = ThroughFace(c, stations), edge = AcrossEdge(c);
  // A face gives two points instead of one, so it is preferred unless the edge is clearly better.
  if (edge.distance_m > face.distance_m + 0.05 * Abs(face.distance_m)) {
    pair.Add(NearestToEdge(c, edge), edge.normal, edge.distance_m, 2);
    return;
  }
  const Stretch s = BetweenSides(c, stations, face.axis);
  const double sign = face.normal.x + face.normal.y + face.normal.z;
  const double half = c.half_m[face.axis];
  pair.Add(s.low.t, face.normal, sign * c.At(face.axis, s.low.t) - half, s.low.feature);
  if ((s.high.t - s.low.t) * c.length_m <= 1e-3 * c.radius_m) return;
  pair.Add(s.high.t, face.normal, sign * c.At(face.axis, s.high.t) - half, s.high.feature);
}

}  // namespace

int Touch(const RoundShape& a, const RoundShape& b, double margin_m, TouchPoint* out) noexcept {
  RoundPair pair{Segment(a), Segment(b), a.radius_m, b.radius_m, TouchList(out, margin_m)};
  const CenterPair closest = ClosestPair(pair.a, pair.b);
  if (!(pair.Gap(closest) < margin_m)) return 0;
  const Overlap overlap = FindOverlap(pair);
  bool closest_counts = true;
  if (overlap.exists) {
    pair.Add(overlap.low, 1);
    pair.Add(overlap.high, 2);
    // The closest point of a twisted rod is below the chord between the ends of the overlap. For
    // parallel rods, its place is arbitrary; the point is omitted if it adds nothing to this chord.
    const double at = Dot(overlap.direction, 0.5 * (closest.a + closest.b));
    const double share =
        Clamp((at - overlap.low_at_m) / (overlap.high_at_m - overlap.low_at_m), 0.0, 1.0);
    const double chord =
        overlap.low.distance_m + share * (overlap.high.distance_m - overlap.low.distance_m);
    closest_counts = pair.list.count() == 0 || chord - closest.distance_m > pair.SameGapM();
  }
  if (closest_counts) pair.Add(closest, 0);
  return pair.list.count();
}

int Touch(const RoundShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept {
  RoundBoxPair pair{CapsuleAtBox(a, b), b, TouchList(out, margin_m)};
  const Stations stations(pair.capsule);
  const double nearest = NearestToBox(pair.capsule, stations);
  const double distance = Norm(pair.capsule.Beyond(nearest));
  if (!(distance - a.radius_m < margin_m)) return 0;
  if (distance > kCoincidentM) {
    TouchOutside(pair, stations, nearest);
  } else {
    TouchInside(pair, stations);
  }
  return pair.list.count();
}

double Distance(const RoundShape& a, const RoundShape& b) noexcept {
  const CenterPair closest = ClosestPair(Segment(a), Segment(b));
  return Larger(closest.distance_m - a.radius_m - b.radius_m, 0.0);
}

double Distance(const RoundShape& a, const BoxShape& b) noexcept {
  const CapsuleAtBox capsule(a, b);
  const double nearest = NearestToBox(capsule, Stations(capsule));
  return Larger(Norm(capsule.Beyond(nearest)) - a.radius_m, 0.0);
}

}  // namespace taut::sim
