// Narrow phase of two boxes: separating axis test, then clipping of the best face or crossing of
// the best edges.
#include "sim/geometry/face_or_edge.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {
namespace {

constexpr int kMeetingFeature = 12;
static_assert(kMeetingFeature < kMaxPointsPerPair, "every feature needs a number");

double Sign(double x) noexcept { return x < 0.0 ? -1.0 : 1.0; }

/// Returns the separation of two boxes along a unit direction; negative: overlap.
double Apart(const BoxShape& a, const BoxShape& b, const Vec3& direction) noexcept {
  const Vec3 ab = Load(b.center) - Load(a.center);
  return Abs(Dot(ab, direction)) - Reach(a, direction) - Reach(b, direction);
}

struct FaceAxis {
  int axis = 0;
  double apart_m = -1e300;
};

/// Returns the best of the face axes of `a`.
FaceAxis BestFace(const BoxShape& a, const BoxShape& b) noexcept {
  FaceAxis best;
  for (int i = 0; i < 3; ++i) {
    const double apart = Apart(a, b, AxisOf(a, i));
    if (apart > best.apart_m) best = {i, apart};
  }
  return best;
}

struct EdgeAxis {
  bool exists = false;
  int a = 0, b = 0;     ///< Box axes along both edges.
  Vec3 direction = {};  ///< Unit vector from `a` to `b`.
  double apart_m = -1e300;
};

EdgeAxis BestEdges(const BoxShape& a, const BoxShape& b) noexcept {
  EdgeAxis best;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec3 c = Cross(AxisOf(a, i), AxisOf(b, j));
      const double length = Norm(c);
      if (length < kParallelSin) continue;
      const Vec3 direction = (1.0 / length) * c;
      const double apart = Apart(a, b, direction);
      if (apart <= best.apart_m) continue;
      const double sign = Sign(Dot(direction, Load(b.center) - Load(a.center)));
      best = {true, i, j, sign * direction, apart};
    }
  }
  return best;
}

/// Returns the middle of the edge along `axis` that is farthest in a direction.
Vec3 ForemostEdge(const BoxShape& box, int axis, const Vec3& direction) noexcept {
  Vec3 p = Load(box.center);
  for (int i = 0; i < 3; ++i) {
    if (i == axis) continue;
    p = p + (Sign(Dot(AxisOf(box, i), direction)) * box.half_m[i]) * AxisOf(box, i);
  }
  return p;
}

/// Adds the contact point of two edges, if they cross.
void TouchEdges(const BoxShape& a, const BoxShape& b, const EdgeAxis& edges,
                TouchList& list) noexcept {
  const Vec3 along_a = AxisOf(a, edges.a), along_b = AxisOf(b, edges.b);
  const Vec3 middle_a = ForemostEdge(a, edges.a, edges.direction);
  const Vec3 middle_b = ForemostEdge(b, edges.b, -1.0 * edges.direction);
  const Vec3 c = Cross(along_a, along_b), ab = middle_b - middle_a;
  const double c2 = Dot(c, c);
  const double s = Dot(Cross(ab, along_b), c) / c2, t = Dot(Cross(ab, along_a), c) / c2;
  const double s_max = a.half_m[edges.a], t_max = b.half_m[edges.b];
  const double slack = 1.0 + kCutSlack;
  if (Abs(s) > slack * s_max || Abs(t) > slack * t_max) return;
  const Vec3 on_a = middle_a + Clamp(s, -s_max, s_max) * along_a;
  const Vec3 on_b = middle_b + Clamp(t, -t_max, t_max) * along_b;
  list.Add(0.5 * (on_a + on_b), -1.0 * edges.direction, edges.apart_m, kMeetingFeature);
}

/// Corner of the clipped face: position in the clipping face, and height above it.
struct Corner {
  double x[2], height_m;
  int feature;
};

/// Four corners, and one more per cut.
struct Polygon {
  static constexpr int kMax = 8;
  Corner corners[kMax];
  int count = 0;
  void Add(const Corner& corner) noexcept {
    // Rounding may make a convex outline slightly concave and add corners.
    if (count < kMax) corners[count++] = corner;
  }
};

Corner Between(const Corner& p, const Corner& q, double share, int feature) noexcept {
  return {{p.x[0] + share * (q.x[0] - p.x[0]), p.x[1] + share * (q.x[1] - p.x[1])},
          p.height_m + share * (q.height_m - p.height_m),
          feature};
}

/// Removes the part beyond `limit` along sign * x[axis]. `feature` and the next number identify the
/// two points at which the outline leaves and enters.
Polygon Cut(const Polygon& polygon, int axis, double sign, double limit, int feature) noexcept {
  Polygon kept;
  for (int i = 0; i < polygon.count; ++i) {
    const Corner& p = polygon.corners[i];
    const Corner& q = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
    const double over_p = sign * p.x[axis] - limit, over_q = sign * q.x[axis] - limit;
    if (over_p <= 0.0) kept.Add(p);
    if ((over_p <= 0.0) == (over_q <= 0.0)) continue;
    kept.Add(Between(p, q, over_p / (over_p - over_q), over_p <= 0.0 ? feature : feature + 1));
  }
  return kept;
}

/// Returns the face of `box` most opposite to `direction`, in the frame of the clipping face:
/// origin, two axes, and `direction` as up.
Polygon FacingFace(const BoxShape& box, const Vec3& direction, const Vec3& origin,
                   const Vec3& axis0, const Vec3& axis1) noexcept {
  int face = 0;
  double most = -1.0;
  for (int i = 0; i < 3; ++i) {
    const double facing = Abs(Dot(AxisOf(box, i), direction));
    if (facing <= most + 1e-9) continue;
    most = facing;
    face = i;
  }
  const double side = -Sign(Dot(AxisOf(box, face), direction));
  const int i0 = face == 0 ? 1 : 0, i1 = face == 2 ? 1 : 2;
  const Vec3 middle = Load(box.center) + (side * box.half_m[face]) * AxisOf(box, face) - origin;
  const Vec3 u = box.half_m[i0] * AxisOf(box, i0), v = box.half_m[i1] * AxisOf(box, i1);
  const Vec3 corners[4] = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  Polygon polygon;
  for (int i = 0; i < 4; ++i) {
    const Vec3& p = corners[i];
    polygon.Add({{Dot(p, axis0), Dot(p, axis1)}, Dot(p, direction), i});
  }
  return polygon;
}

/// Adds a face contact: the opposite face of `other`, clipped to the face of `box`.
void TouchFace(const BoxShape& box, int axis, const BoxShape& other, bool box_is_a,
               TouchList& list) noexcept {
  const double side = Sign(Dot(AxisOf(box, axis), Load(other.center) - Load(box.center)));
  const Vec3 direction = side * AxisOf(box, axis);
  const Vec3 origin = Load(box.center) + box.half_m[axis] * direction;
  const int axes[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
  const Vec3 axis0 = AxisOf(box, axes[0]), axis1 = AxisOf(box, axes[1]);
  Polygon polygon = FacingFace(other, direction, origin, axis0, axis1);
  for (int cut = 0; cut < 4; ++cut) {
    const double limit = (1.0 + kCutSlack) * box.half_m[axes[cut / 2]];
    polygon = Cut(polygon, cut / 2, cut % 2 == 0 ? 1.0 : -1.0, limit, 4 + 2 * cut);
  }
  const Vec3 normal = (box_is_a ? -1.0 : 1.0) * direction;
  const double half0 = box.half_m[axes[0]], half1 = box.half_m[axes[1]];
  for (int i = 0; i < polygon.count; ++i) {
    const Corner& p = polygon.corners[i];
    const Vec3 point = origin + Clamp(p.x[0], -half0, half0) * axis0 +
                       Clamp(p.x[1], -half1, half1) * axis1 + (0.5 * p.height_m) * direction;
    list.Add(point, normal, p.height_m, p.feature);
  }
}

/// Corner, and the nearest point of the other box.
struct CornerPair {
  Vec3 corner, other;
  double distance_m = 1e300;
};

CornerPair NearestCorner(const BoxShape& box, const BoxShape& other) noexcept {
  CornerPair best;
  for (int i = 0; i < 8; ++i) {
    Vec3 corner = Load(box.center);
    for (int k = 0; k < 3; ++k) {
      corner = corner + ((i >> k & 1) != 0 ? 1.0 : -1.0) * box.half_m[k] * AxisOf(box, k);
    }
    const Vec3 d = corner - Load(other.center);
    Vec3 nearest = Load(other.center);
    for (int k = 0; k < 3; ++k) {
      const double half = other.half_m[k];
      nearest = nearest + Clamp(Dot(d, AxisOf(other, k)), -half, half) * AxisOf(other, k);
    }
    const double distance = Norm(corner - nearest);
    if (distance < best.distance_m) best = {corner, nearest, distance};
  }
  return best;
}

/// Adds the contact of the nearest corner of two separate boxes that are diagonal neighbors.
void TouchCorner(const BoxShape& a, const BoxShape& b, double slack_m, TouchList& list) noexcept {
  const CornerPair from_a = NearestCorner(a, b), from_b = NearestCorner(b, a);
  const bool use_b = from_b.distance_m < from_a.distance_m;
  const CornerPair& best = use_b ? from_b : from_a;
  if (!(best.distance_m < list.least_gap_m() - slack_m)) return;
  const Vec3 normal = ((use_b ? -1.0 : 1.0) / best.distance_m) * (best.corner - best.other);
  list.Add(0.5 * (best.corner + best.other), normal, best.distance_m, kMeetingFeature);
}

double SizeOf(const BoxShape& box) noexcept {
  return Smaller(box.half_m[0], Smaller(box.half_m[1], box.half_m[2]));
}

/// Returns the distance from `a` to the bounding box of `b` along the axes of `a`.
double DistanceAlongAxes(const BoxShape& a, const BoxShape& b) noexcept {
  double sum2 = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double apart = Larger(Apart(a, b, AxisOf(a, i)), 0.0);
    sum2 += apart * apart;
  }
  return Sqrt(sum2);
}

}  // namespace

int Touch(const BoxShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept {
  TouchList list(out, margin_m);
  const FaceAxis face_a = BestFace(a, b), face_b = BestFace(b, a);
  if (!(Larger(face_a.apart_m, face_b.apart_m) < margin_m)) return 0;
  const EdgeAxis edges = BestEdges(a, b);
  if (!(edges.apart_m < margin_m)) return 0;

  const double size = Smaller(SizeOf(a), SizeOf(b));
  const bool use_b = ClearlyBetter(face_b.apart_m, face_a.apart_m, size);
  const double face_m = use_b ? face_b.apart_m : face_a.apart_m;
  if (edges.exists && ClearlyBetter(edges.apart_m, face_m, size)) {
    TouchEdges(a, b, edges, list);
    if (list.count() > 0) return list.count();
  }
  if (use_b) {
    TouchFace(b, face_b.axis, a, false, list);
  } else {
    TouchFace(a, face_a.axis, b, true, list);
  }
  if (Larger(face_m, edges.apart_m) > 0.0) TouchCorner(a, b, kBetterSize * size, list);
  return list.count();
}

double Distance(const BoxShape& a, const BoxShape& b) noexcept {
  return Larger(Larger(DistanceAlongAxes(a, b), DistanceAlongAxes(b, a)), BestEdges(a, b).apart_m);
}

}  // namespace taut::sim
