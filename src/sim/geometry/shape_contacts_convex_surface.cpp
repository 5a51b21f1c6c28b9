// Narrow phase of a box or a hull on a surface (docs/theory/ground.md, section 3): corners of the
// body on faces, edges on sharp edges, and faces on sharp corners of the surface. Sharp bodies have
// no other contacts.
#include "sim/geometry/contact_reduction.h"
#include "sim/geometry/convex.h"
#include "sim/geometry/surface_near.h"

namespace taut::sim {
namespace {

/// First ids of points by place: corners, their further planes, edges, faces.
constexpr int kFirstPlane = kMaxHullCorners, kFirstEdge = 2 * kMaxHullCorners;
constexpr int kFirstFace = kFirstEdge + kMaxHullEdges;
/// Maximum number of places of a corner, and of its planes.
constexpr int kPlacesOfCorner = 3, kPlanesOfCorner = 4;
/// Rounding tolerance of sines and cosines.
constexpr double kLevel = 1e-6;
/// Two edges at a smaller angle count as parallel and have no contact with each other: other
/// pairs of features support the body [rad].
constexpr double kParallel = 1e-6;
/// Normals with a larger cosine belong to one plane. Contacts at a smaller distance are merged,
/// relative to the size of the body.
constexpr double kSamePlane = 1.0 - 1e-9, kSamePlace = 1e-6;
/// Maximum penetration of edges, and of corners through a sheet, in units of the smallest half
/// thickness.
constexpr double kDeepestEdge = 0.5, kDeepestSheet = 0.25;
/// Planes that rise next to a corner count up to the search distance plus this factor times the
/// depth of the corner.
constexpr double kBesideDepths = 4.0;
/// Search distance around a body in units of its size; fraction of it that is searched exactly;
/// factor between further searches, which use bounds.
constexpr double kFarthestLook = 4.0, kNearestLook = 1.0 / 64, kFurther = 4.0;
/// Possible reduction of the gap by merged contacts, as a fraction and in [m].
constexpr double kSameGap = 1e-5, kSameGapM = 1e-9;

struct Plane {
  Vec3 normal;
  double gap_m;
};

/// Returns whether `a` precedes `b`, in an order that remains while shapes slide.
bool Before(const Vec3& a, const Vec3& b) noexcept {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// Search for the contacts of a body with a surface.
class ConvexSearch {
 public:
  ConvexSearch(const Convex& body, const SurfaceTable& s, double margin_m) noexcept
      : s_(s),
        body_(body),
        center_(body.center),
        thinnest_m_(body.thin_m),
        limit_m_(Larger(margin_m, 0.0)),
        touches_(kSamePlace * thinnest_m_, margin_m) {}

  void Run(TouchList& list) noexcept {
    if (!IsClear(limit_m_)) Look();
    touches_.AddTo(list);
  }
  /// Returns whether bounds show that no part of the surface is within `reach_m`.
  bool IsClear(double reach_m) const noexcept {
    const LineReach line = Reach(reach_m);
    return line.low > line.high;
  }

 private:
  void Look() noexcept {
    for (int i = 0; i < body_.table->corner_count; ++i) Corner(i);
    Vec3 low, high;
    body_.Bounds(&low, &high);
    const Vec3 reach{limit_m_, limit_m_, limit_m_};
    EachSharpWithin(
        s_, low - reach, high + reach,
        [&](const Vec3& start, const Vec3& end, const auto& edge_of) noexcept {
          Edges(start, end, edge_of);
        },
        [&](const Vec3& p, const auto& each_beside) noexcept { Peak(p, each_beside); });
  }
  /// Returns the search region around the body, as a line through its center and its farthest
  /// corner.
  LineReach Reach(double more_m) const noexcept {
    int farthest = 0;
    double most2 = 0.0;
    for (int i = 0; i < body_.table->corner_count; ++i) {
      const Vec3 d = body_.corners[i] - center_;
      if (Dot(d, d) > most2) most2 = Dot(d, d), farthest = i;
    }
    const Vec3 along = (1.0 / Sqrt(most2)) * (body_.corners[farthest] - center_);
    double low = 0.0, high = 0.0, aside2 = 0.0;
    for (int i = 0; i < body_.table->corner_count; ++i) {
      const Vec3 d = body_.corners[i] - center_;
      const double at = Dot(d, along);
      low = Smaller(low, at), high = Larger(high, at);
      aside2 = Larger(aside2, Dot(d, d) - at * at);
    }
    return ReachOfLine(s_, center_ + low * along, center_ + high * along, Sqrt(aside2) + more_m);
  }
  /// Returns the outward normal of a triangle; for a sheet, toward the body.
  Vec3 NormalOf(const SurfaceTable& s, const SurfaceTriangle& t) const noexcept {
    const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const bool turned = !s.solid && Dot(n, center_ - t.p[0]) < 0.0;
    return ((turned ? -1.0 : 1.0) / Norm(n)) * n;
  }

  /// Returns whether a corner has passed through a sheet at its nearest place, instead of around
  /// its border or over a ridge. If it has passed through, the segment from the corner to the
  /// center of the body also crosses the sheet.
  bool IsThrough(const Vec3& corner, const SurfacePlace& place) const noexcept {
    const double depth_m = place.distance_m, side = Dot(place.normal, center_ - place.at);
    if (depth_m > kDeepestSheet * thinnest_m_) return false;
    const double share = Smaller((kBesideDepths * depth_m + kSameGapM) / (depth_m - side), 1.0);
    const Vec3 way = share * (center_ - corner), end = corner + way;
    const Vec3 low{Smaller(corner.x, end.x), Smaller(corner.y, end.y), Smaller(corner.z, end.z)};
    const Vec3 high{Larger(corner.x, end.x), Larger(corner.y, end.y), Larger(corner.z, end.z)};
    const Vec3 reach{kSameGapM, kSameGapM, kSameGapM};
    bool through = false;
    EachTriangle(s_, low - reach, high + reach, [&](const SurfaceTriangle& t) noexcept {
      const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
      const double up = Dot(n, corner - t.p[0]), on = Dot(n, way);
      if (!(Abs(on) > 0.0)) return;
      const double at = -up / on;
      if (!(at >= -kSameGapM && at <= 1.0)) return;
      const Vec3 crossing = corner + at * way;
      through = through || Norm(crossing - NearestPlaceOf(t, crossing)) <= kSameGapM;
    });
    return through;
  }

  void Corner(int corner) noexcept {
    const Vec3 p = body_.corners[corner];
    SurfacePlace places[kPlacesOfCorner];
    const double look_m = s_.solid ? limit_m_ : Larger(limit_m_, kDeepestSheet * thinnest_m_);
    const int found =
        NearestPlaces(s_, p, look_m, places, kPlacesOfCorner, nullptr, false, &center_);
    // the first plane with its place
    Plane planes[kPlanesOfCorner];
    Vec3 base;
    int count = 0;
    for (int i = 0; i < found; ++i) {
      const SurfacePlace& place = places[i];
      const bool through = !s_.solid && Dot(place.normal, center_ - place.at) < 0.0;
      if (through && (count > 0 || !IsThrough(p, place))) continue;
      const double sign = through ? -1.0 : 1.0;
      if (count == 0) base = place.at;
      if (sign * place.distance_m < limit_m_) {
        planes[count++] = {sign * place.normal, sign * place.distance_m};
      }
      if (through) break;
    }
    if (count == 0) return;
    count = AddRising(p, base, planes, count);
    for (int i = 1; i < count; ++i) {
      for (int k = i; k > 0 && Before(planes[k].normal, planes[k - 1].normal); --k) {
        const Plane swapped = planes[k];
        planes[k] = planes[k - 1], planes[k - 1] = swapped;
      }
    }
    touches_.Add(p, planes[0].normal, planes[0].gap_m, corner);
    for (int i = 1; i < count; ++i) {
      touches_.Add(p, planes[i].normal, planes[i].gap_m, kFirstPlane + corner + i);
    }
  }

  /// Adds planes of triangles that rise next to the nearest place `base` of a corner, if the corner
  /// is not yet above or already below them. If the nearest place is in the edge of a valley, the
  /// planes on both sides replace it. Returns the number of planes.
  int AddRising(const Vec3& p, const Vec3& base, Plane* planes, int count) const noexcept {
    const Plane first = planes[0];
    const double beside_m = limit_m_ + kBesideDepths * Larger(-first.gap_m, 0.0);
    const double at_base_m = (1.0 + kLevel) * Larger(-first.gap_m, 0.0) + kSameGapM;
    const Vec3 reach{beside_m, beside_m, beside_m};
    int sides = 0;
    const auto look = [&](const SurfaceTable& s, const SurfaceTriangle& t) noexcept {
      const Vec3 normal = NormalOf(s, t);
      const double gap_m = Dot(normal, p - t.p[0]);
      if (!(gap_m < limit_m_) || !(Dot(normal, center_ - t.p[0]) > 0.0)) return;
      // The normals must enclose at most a right angle, as at the corner.
      if (!(Dot(first.normal, normal) > -kLevel)) return;
      const Vec3 down = base - t.p[0];
      if (&s == &s_) {
        const Vec3 middle = (1.0 / 3.0) * (t.p[0] + t.p[1] + t.p[2]) - base;
        if (!(Dot(first.normal, middle) > kLevel * Norm(middle))) return;
      } else {  // another piece, which may continue below s_
        double most_m = -1.0;
        for (const Vec3& corner : t.p) {
          const Vec3 way = corner - base;
          most_m = Larger(most_m, Dot(first.normal, way) - kLevel * Norm(way));
        }
        if (!(most_m > s_.seams.same_m)) return;
      }
      if (!(Dot(normal, down) >= -kLevel * Norm(down) - kSameGapM)) return;
      const double apart_m = Norm(p - NearestPlaceOf(t, p));
      if (apart_m > beside_m) return;
      if (&s == &s_ && first.gap_m < 0.0 && apart_m <= at_base_m) ++sides;
      for (int i = 0; i < count; ++i) {
        if (Dot(planes[i].normal, normal) > kSamePlane) return;
      }
      if (count < kPlanesOfCorner) {
        planes[count++] = {normal, gap_m};
      } else if (gap_m < planes[count - 1].gap_m) {
        planes[count - 1] = {normal, gap_m};
      }
    };
    const auto look_at = [&](const SurfaceTable& s) noexcept {
      EachTriangle(s, p - reach, p + reach, [&](const SurfaceTriangle& t) noexcept { look(s, t); });
    };
    look_at(s_);
    for (int i = 0; i < s_.seams.count; ++i) {
      if (s_.seams.pieces[i].kind == SeamPiece::kSurface) look_at(*s_.seams.pieces[i].surface);
    }
    if (sides < 2) return count;
    for (int i = 1; i < count; ++i) planes[i - 1] = planes[i];
    return count - 1;
  }

  /// Adds contacts of a sharp edge of the surface with edges of the body, along their common
  /// normal, if this direction leads out of both.
  template <class EdgeOf>
  void Edges(const Vec3& start, const Vec3& end, const EdgeOf& edge_of) noexcept {
    for (int face = 0; face < body_.table->face_count; ++face) {
      if (body_.Above(face, start) > limit_m_ && body_.Above(face, end) > limit_m_) return;
    }
    const Vec3 along = end - start;
    const double length2 = Dot(along, along);
    SurfaceEdge edge;
    edge.sides = 0;
    for (int i = 0; i < body_.table->edge_count; ++i) {
      const HullEdge& own = body_.table->edges[i];
      const Vec3 from = body_.FromOf(own), side = body_.AlongOf(own), c = Cross(along, side);
      const double c2 = Dot(c, c);
      if (!(c2 > kParallel * kParallel * length2 * Dot(side, side))) continue;
      const double into = Dot(c, center_ - from) < 0.0 ? -1.0 : 1.0;
      const Vec3 normal = (into / Sqrt(c2)) * c, between = from - start;
      const double gap_m = Dot(normal, between);
      if (!(gap_m < limit_m_ && gap_m > -kDeepestEdge * thinnest_m_)) continue;
      const double on_ground = Dot(Cross(between, side), c) / c2;
      const double on_own = Dot(Cross(between, along), c) / c2;
      if (!(on_ground >= 0.0 && on_ground <= 1.0 && on_own >= 0.0 && on_own <= 1.0)) continue;
      if (!IsLowest(own, normal)) continue;
      if (edge.sides == 0) edge = edge_of();
      if (!LeadsOut(edge, normal, length2)) continue;
      if (s_.seams.count > 0 && !IsEdgeOpen(edge, start + on_ground * along, normal)) continue;
      touches_.Add(from + on_own * side, normal, gap_m,
                   kFirstEdge + i + static_cast<int>(on_own > 0.5));
    }
  }
  /// Returns whether the edge is convex and uncovered at a point, considering the neighboring
  /// pieces of terrain (seams.h). The edge is not convex if another piece continues one of its
  /// faces straight.
  bool IsEdgeOpen(const SurfaceEdge& edge, const Vec3& at, const Vec3& normal) const noexcept {
    if (!IsOnSeam(s_.seams, at)) return true;
    if (IsEdgeCovered(s_.seams, edge.from, edge.to, {at, normal, &center_}, {limit_m_, kLevel}))
      return false;
    const Vec3 along = edge.to - edge.from;
    for (int k = 0; k < edge.sides; ++k) {
      const Vec3 in = edge.apex[k] - edge.from;
      const Vec3 inward = in - (Dot(in, along) / Dot(along, along)) * along;
      if (GoesStraightOn(nullptr, s_.seams, at, (-1.0 / Norm(inward)) * inward, false)) {
        return false;
      }
    }
    return true;
  }
  /// Returns whether the faces next to an edge of the body rise from it.
  bool IsLowest(const HullEdge& own, const Vec3& normal) const noexcept {
    const Vec3 from = body_.FromOf(own);
    bool lowest = true;
    const int beside[2] = {own.left, own.right};
    for (const int face : beside) {
      body_.EachSide(face, [&](const Vec3& corner, const Vec3&) noexcept {
        const Vec3 way = corner - from;
        lowest = lowest && Dot(normal, way) >= -limit_m_ - kLevel * Norm(way);
      });
    }
    return lowest;
  }
  bool LeadsOut(const SurfaceEdge& edge, const Vec3& normal, double length2) const noexcept {
    const Vec3 along = edge.to - edge.from;
    for (int k = 0; k < edge.sides; ++k) {
      const Vec3 in = edge.apex[k] - edge.from;
      const Vec3 inward = in - (Dot(in, along) / length2) * along;
      if (Dot(normal, inward) > limit_m_ + kLevel * Norm(inward)) return false;
    }
    return true;
  }

  /// Adds the contact of a sharp corner of the surface near the body. If the corner is inside the
  /// body, the contact is with the nearest face through which it can have entered.
  template <class EachBeside>
  void Peak(const Vec3& p, const EachBeside& each_beside) noexcept {
    const int faces = body_.table->face_count;
    for (int face = 0; face < faces; ++face) {
      if (body_.Above(face, p) > limit_m_) return;
    }
    const auto leads_out = [&](const Vec3& normal) noexcept {
      bool out = true;
      each_beside([&](const Vec3& other) noexcept {
        const Vec3 way = other - p;
        out = out && Dot(normal, way) <= limit_m_ + kLevel * Norm(way);
      });
      if (!out || s_.seams.count == 0 || !IsOnSeam(s_.seams, p)) return out;
      return !IsCovered(s_.seams, p, normal, {limit_m_, kLevel}) &&
             !IsFlatAround(s_, s_.seams, p, normal);
    };
    const NearestOfConvex nearest = NearestTo(body_, p);
    if (nearest.distance_m > kSameGapM) {
      if (nearest.distance_m > limit_m_) return;
      const Vec3 normal = -1.0 * nearest.normal;
      if (leads_out(normal))
        touches_.Add(p + nearest.distance_m * normal, normal, nearest.distance_m, kFirstFace);
      return;
    }
    int best = -1;
    for (int face = 0; face < faces; ++face) {
      if (best >= 0 && body_.Above(face, p) <= body_.Above(best, p)) continue;
      if (leads_out(-1.0 * body_.normals[face])) best = face;
    }
    if (best < 0) return;
    const double gap_m = body_.Above(best, p);
    touches_.Add(p - gap_m * body_.normals[best], -1.0 * body_.normals[best], gap_m,
                 kFirstFace + best);
  }

  const SurfaceTable& s_;
  const Convex& body_;
  Vec3 center_;
  double thinnest_m_, limit_m_;
  ManyTouches touches_;
};

int TouchGround(const Convex& body, const SurfaceTable& s, double margin_m,
                TouchPoint* out) noexcept {
  TouchList list(out, margin_m);
  ConvexSearch(body, s, margin_m).Run(list);
  return list.count();
}

double DistanceToGround(const Convex& body, double size_m, const SurfaceTable& s,
                        double enough_m) noexcept {
  if (!(enough_m > 0.0)) return 0.0;  // the search below multiplies enough_m
  const double most_m = kFarthestLook * size_m;
  double look_m = Smaller(enough_m, kNearestLook * most_m);
  TouchPoint points[kMaxPointsPerPair];
  TouchList list(points, look_m);
  ConvexSearch search(body, Alone(s), look_m);
  search.Run(list);
  if (list.count() > 0) {
    return Larger((1.0 - kSameGap) * list.least_gap_m() - kSameGapM, 0.0);
  }
  while (look_m < most_m && search.IsClear(kFurther * look_m)) look_m = kFurther * look_m;
  return look_m;
}

}  // namespace

int Touch(const BoxShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept {
  return TouchGround(Convex(a), *b.table, margin_m, out);
}
int Touch(const HullShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept {
  return TouchGround(Convex(a), *b.table, margin_m, out);
}

double DistanceUpTo(const BoxShape& a, const SurfaceShape& b, double enough_m) noexcept {
  return DistanceToGround(Convex(a), Norm(Load(a.half_m)), *b.table, enough_m);
}
double DistanceUpTo(const HullShape& a, const SurfaceShape& b, double enough_m) noexcept {
  return DistanceToGround(Convex(a), a.table->bound_m, *b.table, enough_m);
}

}  // namespace taut::sim
