// Narrow phase of two hulls, or of a box and a hull: separating axis test, then clipping of the
// best face or crossing of the best edges (docs/theory/contact.md, section 8).
#include "sim/geometry/contact_reduction.h"
#include "sim/geometry/convex.h"
#include "sim/geometry/face_or_edge.h"

namespace taut::sim {
namespace {

/// Distance below which points are merged, relative to the size of the thinner body.
constexpr double kSamePlace = 1e-6;
/// First ids of points: corners of the clipped face, two per cut, crossing edges or nearest
/// corners.
constexpr int kFirstCut = kMaxHullCorners, kMeeting = 3 * kMaxHullCorners;

struct FaceAxis {
  int face = 0;
  double apart_m = -1e300;
};

/// Returns the face of `a` with the largest distance to `b`.
FaceAxis BestFace(const Convex& a, const Convex& b) noexcept {
  FaceAxis best;
  for (int face = 0; face < a.table->face_count; ++face) {
    // Skips faces that cannot be better: some corner is lower than the center by thin_m or more.
    if (a.Above(face, b.center) - b.thin_m <= best.apart_m) continue;
    const double apart = b.Lowest(a.normals[face], a.offsets_m[face]);
    if (apart > best.apart_m) best = {face, apart};
  }
  return best;
}

/// Edges of a body near the bounds of another one.
struct NearEdges {
  int all[kMaxHullEdges];
  int count = 0;

  NearEdges(const Convex& convex, const Convex& other, double reach_m) noexcept {
    Vec3 low, high;
    other.Bounds(&low, &high);
    const Vec3 reach{reach_m, reach_m, reach_m};
    low = low - reach, high = high + reach;
    for (int i = 0; i < convex.table->edge_count; ++i) {
      const HullEdge& edge = convex.table->edges[i];
      const Vec3 &p = convex.corners[edge.from], &q = convex.corners[edge.to];
      if (Larger(p.x, q.x) < low.x || Smaller(p.x, q.x) > high.x) continue;
      if (Larger(p.y, q.y) < low.y || Smaller(p.y, q.y) > high.y) continue;
      if (Larger(p.z, q.z) < low.z || Smaller(p.z, q.z) > high.z) continue;
      all[count++] = i;
    }
  }
};

/// Returns whether two edges are farthest on both bodies in some direction, so that they form a
/// face of the Minkowski difference. Test: the arc between the normals of one edge's faces crosses
/// the negated arc of the other edge.
bool AreForemost(const Convex& a, const HullEdge& edge_a, const Convex& b,
                 const HullEdge& edge_b) noexcept {
  const Vec3 along_a = a.AlongOf(edge_a), along_b = b.AlongOf(edge_b);
  const double left_b = Dot(b.normals[edge_b.left], along_a);
  const double right_b = Dot(b.normals[edge_b.right], along_a);
  if (!(left_b * right_b < 0.0)) return false;
  const double left_a = Dot(a.normals[edge_a.left], along_b);
  const double right_a = Dot(a.normals[edge_a.right], along_b);
  if (!(left_a * right_a < 0.0)) return false;
  return left_b * right_a < 0.0;
}

struct EdgeAxis {
  bool exists = false;
  int a = 0, b = 0;     ///< Edge indices.
  Vec3 direction = {};  ///< Unit vector from `a` to `b`.
  double apart_m = -1e300;
};

/// Returns the best edge axis among edges at most `reach_m` apart; may include further edges.
EdgeAxis BestEdges(const Convex& a, const Convex& b, double reach_m) noexcept {
  EdgeAxis best;
  const NearEdges near_a(a, b, reach_m), near_b(b, a, reach_m);
  for (int i = 0; i < near_a.count; ++i) {
    const HullEdge& edge_a = a.table->edges[near_a.all[i]];
    const Vec3 along_a = a.AlongOf(edge_a);
    for (int k = 0; k < near_b.count; ++k) {
      const HullEdge& edge_b = b.table->edges[near_b.all[k]];
      if (!AreForemost(a, edge_a, b, edge_b)) continue;
      const Vec3 along_b = b.AlongOf(edge_b), c = Cross(along_a, along_b);
      const double length = Norm(c);
      if (length < kParallelSin * Sqrt(Dot(along_a, along_a) * Dot(along_b, along_b))) continue;
      Vec3 direction = (1.0 / length) * c;
      if (Dot(direction, a.FromOf(edge_a) - a.center) < 0.0) direction = -1.0 * direction;
      const double apart = Dot(direction, b.FromOf(edge_b) - a.FromOf(edge_a));
      if (apart > best.apart_m) best = {true, near_a.all[i], near_b.all[k], direction, apart};
    }
  }
  return best;
}

/// Adds the contact point of two edges if they cross. Returns whether they do.
bool TouchEdges(const Convex& a, const Convex& b, const EdgeAxis& edges,
                ManyTouches& touches) noexcept {
  const HullEdge &edge_a = a.table->edges[edges.a], &edge_b = b.table->edges[edges.b];
  const Vec3 along_a = a.AlongOf(edge_a), along_b = b.AlongOf(edge_b);
  const Vec3 from_a = a.FromOf(edge_a), from_b = b.FromOf(edge_b);
  const Vec3 c = Cross(along_a, along_b), ab = from_b - from_a;
  const double c2 = Dot(c, c);
  const double s = Dot(Cross(ab, along_b), c) / c2, t = Dot(Cross(ab, along_a), c) / c2;
  if (s < -kCutSlack || s > 1.0 + kCutSlack || t < -kCutSlack || t > 1.0 + kCutSlack) return false;
  const Vec3 on_a = from_a + Clamp(s, 0.0, 1.0) * along_a;
  const Vec3 on_b = from_b + Clamp(t, 0.0, 1.0) * along_b;
  touches.Add(0.5 * (on_a + on_b), -1.0 * edges.direction, edges.apart_m, kMeeting);
  return true;
}

/// A corner of the clipped face.
struct Corner {
  Vec3 p;
  int id;
};

/// Polygon with space for the corners of a face and one more corner per cut.
struct Polygon {
  static constexpr int kMax = 2 * kMaxHullCorners;
  Corner corners[kMax];
  int count = 0;
  void Add(const Corner& corner) noexcept {
    // Rounding may make a convex outline slightly concave and add corners.
    if (count < kMax) corners[count++] = corner;
  }
};

/// Removes the part beyond a plane. `id` and the next number identify the two points at which the
/// outline leaves and enters.
void Cut(const Polygon& polygon, const Vec3& out, double offset_m, int id, Polygon* kept) noexcept {
  kept->count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const Corner& p = polygon.corners[i];
    const Corner& q = polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
    const double over_p = Dot(out, p.p) - offset_m, over_q = Dot(out, q.p) - offset_m;
    if (over_p <= 0.0) kept->Add(p);
    if ((over_p <= 0.0) == (over_q <= 0.0)) continue;
    const double share = over_p / (over_p - over_q);
    kept->Add({p.p + share * (q.p - p.p), over_p <= 0.0 ? id : id + 1});
  }
}

/// Adds a face contact: the most opposite face of `other`, clipped to this face.
void TouchFace(const Convex& convex, int face, const Convex& other, bool convex_is_a,
               ManyTouches& touches) noexcept {
  const Vec3 up = convex.normals[face];
  int facing = 0;
  for (int i = 1; i < other.table->face_count; ++i) {
    if (Dot(other.normals[i], up) < Dot(other.normals[facing], up) - 1e-9) facing = i;
  }
  Polygon rims[2];
  Polygon* rim = rims;
  const int first = other.table->first_in_face[facing];
  const int last = other.table->first_in_face[facing + 1];
  for (int i = first; i < last; ++i) {
    const int corner = other.table->in_face[i];
    rim->Add({other.corners[corner], corner});
  }
  const double slack_m = kCutSlack * convex.thin_m;
  int id = kFirstCut;
  convex.EachSide(face, [&](const Vec3& from, const Vec3& to) noexcept {
    const Vec3 out = Cross(to - from, up);
    const double length = Norm(out);
    Polygon* const kept = rim == rims ? rims + 1 : rims;
    Cut(*rim, (1.0 / length) * out, Dot(out, from) / length + slack_m, id, kept);
    rim = kept;
    id += 2;
  });
  const Vec3 normal = (convex_is_a ? -1.0 : 1.0) * up;
  for (int i = 0; i < rim->count; ++i) {
    const Corner& p = rim->corners[i];
    const double height = convex.Above(face, p.p);
    touches.Add(p.p - (0.5 * height) * up, normal, height, p.id);
  }
}

/// Corner, and the nearest point of the other body.
struct CornerPair {
  Vec3 corner;
  NearestOfConvex other;
};

CornerPair NearestCorner(const Convex& convex, const Convex& other) noexcept {
  CornerPair best{{}, {{}, {}, 1e300}};
  for (int i = 0; i < convex.table->corner_count; ++i) {
    const Vec3& corner = convex.corners[i];
    bool farther = false;
    for (int face = 0; face < other.table->face_count && !farther; ++face) {
      farther = other.Above(face, corner) >= best.other.distance_m;
    }
    if (farther) continue;
    const NearestOfConvex nearest = NearestTo(other, corner);
    if (nearest.distance_m < best.other.distance_m) best = {corner, nearest};
  }
  return best;
}

/// Nearest corner of both bodies.
struct NearestOfBoth {
  CornerPair pair;
  bool of_b;
};

NearestOfBoth NearestCorners(const Convex& a, const Convex& b) noexcept {
  const CornerPair from_a = NearestCorner(a, b), from_b = NearestCorner(b, a);
  const bool of_b = from_b.other.distance_m < from_a.other.distance_m;
  return {of_b ? from_b : from_a, of_b};
}

/// Adds the contact of the nearest corner of both bodies if its distance is below `below_m`.
void TouchCorner(const Convex& a, const Convex& b, double below_m, ManyTouches& touches) noexcept {
  const auto [pair, of_b] = NearestCorners(a, b);
  const NearestOfConvex& place = pair.other;
  if (!(place.distance_m < below_m)) return;
  touches.Add(0.5 * (pair.corner + place.at), (of_b ? -1.0 : 1.0) * place.normal, place.distance_m,
              kMeeting);
}

int TouchConvex(const Convex& a, const Convex& b, double margin_m, TouchPoint* out) noexcept {
  const FaceAxis face_a = BestFace(a, b);
  if (!(face_a.apart_m < margin_m)) return 0;
  const FaceAxis face_b = BestFace(b, a);
  if (!(face_b.apart_m < margin_m)) return 0;
  const EdgeAxis edges = BestEdges(a, b, Larger(margin_m, 0.0));
  if (!(edges.apart_m < margin_m)) return 0;

  const double size = Smaller(a.thin_m, b.thin_m);
  TouchList list(out, margin_m);
  ManyTouches touches(kSamePlace * size, margin_m);
  const bool use_b = ClearlyBetter(face_b.apart_m, face_a.apart_m, size);
  const double face_m = use_b ? face_b.apart_m : face_a.apart_m;
  const bool by_edges = edges.exists && ClearlyBetter(edges.apart_m, face_m, size) &&
                        TouchEdges(a, b, edges, touches);
  if (!by_edges) {
    if (use_b) {
      TouchFace(b, face_b.face, a, false, touches);
    } else {
      TouchFace(a, face_a.face, b, true, touches);
    }
    if (Larger(face_m, edges.apart_m) > 0.0) {
      TouchCorner(a, b, touches.least_gap_m() - kBetterSize * size, touches);
    }
  }
  touches.AddTo(list);
  return list.count();
}

/// Returns a lower bound of the distance. Exact except if two corners are nearest to each other.
double DistanceOfConvex(const Convex& a, const Convex& b, double enough_m) noexcept {
  const double face_m = Larger(BestFace(a, b).apart_m, BestFace(b, a).apart_m);
  if (face_m >= enough_m) return face_m;
  const auto [pair, of_b] = NearestCorners(a, b);
  const double nearest_m = pair.other.distance_m;
  if (nearest_m <= 0.0) return 0.0;
  // The direction from a corner to its nearest point may separate the bodies by the full distance.
  const Convex &one = of_b ? b : a, &other = of_b ? a : b;
  const Vec3 way = pair.other.normal;
  const double at = Dot(way, pair.other.at);
  const double corner_m = one.Lowest(way, at) + other.Lowest(-1.0 * way, -at);
  const double edges_m = BestEdges(a, b, Smaller(nearest_m, enough_m)).apart_m;
  return Larger(Larger(face_m, corner_m), Larger(edges_m, 0.0));
}

}  // namespace

int Touch(const BoxShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept {
  return TouchConvex(Convex(a), Convex(b), margin_m, out);
}

int Touch(const HullShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept {
  return TouchConvex(Convex(a), Convex(b), margin_m, out);
}

double DistanceUpTo(const BoxShape& a, const HullShape& b, double enough_m) noexcept {
  return DistanceOfConvex(Convex(a), Convex(b), enough_m);
}

double DistanceUpTo(const HullShape& a, const HullShape& b, double enough_m) noexcept {
  return DistanceOfConvex(Convex(a), Convex(b), enough_m);
}

}  // namespace taut::sim
