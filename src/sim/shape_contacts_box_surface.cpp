// A box on ground (docs/theory/ground.md, section 3): its corners against faces, its edges against
// edges that stick out, and corners of the ground that stick out against its faces. Between sharp
// bodies there is nothing else.
#include "sim/shape_contacts.h"
#include "sim/surface_near.h"
#include "sim/touch_list.h"

namespace taut::sim {
namespace {

/// Corners of the box are features 0..7, all else comes behind.
constexpr int kCorners = 8, kOthers = kMaxPointsPerPair - kCorners;
/// Places of a corner, and how many planes it may have.
constexpr int kPlacesOfCorner = 3, kPlanesOfCorner = 4;
/// Sines and cosines by so much are rounding: level is level.
constexpr double kLevel = 1e-6;
/// Edges at a smaller angle are parallel: other pairs hold them [rad].
constexpr double kParallel = 1e-6;
/// Normals that agree so well are of one plane; contacts that are so near to each other, in sizes
/// of the box, one.
constexpr double kSamePlane = 1.0 - 1e-9, kSamePlace = 1e-6;
/// How deep edges may be in each other, and corners through a sheet, in thinnest half edges.
constexpr double kDeepestEdge = 0.5, kDeepestSheet = 0.25;
/// Planes that rise beside a corner count as far from it as the step goes, and so many times its
/// depth.
constexpr double kBesideDepths = 4.0;
/// How far a box looks around, in its size; and where more than bounds are looked at.
constexpr double kFarthestLook = 4.0, kNearestLook = 1.0 / 64, kFurther = 4.0;
/// What was left out as found twice may be nearer by so much, as a share and [m].
constexpr double kSameGap = 1e-5, kSameGapM = 1e-9;

struct Plane {
  Vec3 normal;
  double gap_m;
};

/// An order that stays while shapes slide.
bool Before(const Vec3& a, const Vec3& b) noexcept {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// A contact of an edge, of a face, or one more of a corner. `id` says where, so that most find
/// their memory again.
struct Other {
  Vec3 point, normal;
  double gap_m;
  int id;
};

/// The nearest of them.
class Others {
 public:
  explicit Others(double same_m) noexcept : same2_(same_m * same_m) {}
  void Add(const Other& other) noexcept {
    for (int i = 0; i < count_; ++i) {
      const Vec3 apart = all_[i].point - other.point;
      if (Dot(apart, apart) <= same2_ && Dot(all_[i].normal, other.normal) > kSamePlane) return;
    }
    int at = count_ < kOthers ? count_++ : kOthers;
    while (at > 0 && other.gap_m < all_[at - 1].gap_m) {
      if (at < kOthers) all_[at] = all_[at - 1];
      --at;
    }
    if (at < kOthers) all_[at] = other;
  }
  void AddTo(TouchList& list) const noexcept {
    bool taken[kOthers] = {};
    for (int i = 0; i < count_; ++i) {
      int place = all_[i].id % kOthers;
      while (taken[place]) place = place + 1 == kOthers ? 0 : place + 1;
      taken[place] = true;
      list.Add(all_[i].point, all_[i].normal, all_[i].gap_m, kCorners + place);
    }
  }

 private:
  double same2_;
  Other all_[kOthers];
  int count_ = 0;
};

double Sign(int bits, int axis) noexcept { return (bits >> axis & 1) != 0 ? 1.0 : -1.0; }

/// A box between triangles, and what it found.
class BoxSearch {
 public:
  BoxSearch(const BoxShape& box, const SurfaceTable& s, double margin_m, TouchList& list) noexcept
      : s_(s),
        center_(Load(box.center)),
        axes_{AxisOf(box, 0), AxisOf(box, 1), AxisOf(box, 2)},
        half_{box.half_m[0], box.half_m[1], box.half_m[2]},
        thinnest_m_(Smaller(Smaller(half_[0], half_[1]), half_[2])),
        limit_m_(Larger(margin_m, 0.0)),
        list_(list),
        others_(kSamePlace * thinnest_m_) {}

  void Run() noexcept {
    if (!IsClear(limit_m_)) Look();
    others_.AddTo(list_);
  }
  /// Whether nothing of the surface is as near as that, as far as bounds can say.
  bool IsClear(double reach_m) const noexcept {
    const LineReach line = Reach(reach_m);
    return line.low > line.high;
  }

 private:
  void Look() noexcept {
    for (int corner = 0; corner < kCorners; ++corner) Corner(corner);
    double side[3] = {limit_m_, limit_m_, limit_m_};
    for (int axis = 0; axis < 3; ++axis) {
      side[0] += half_[axis] * Abs(axes_[axis].x);
      side[1] += half_[axis] * Abs(axes_[axis].y);
      side[2] += half_[axis] * Abs(axes_[axis].z);
    }
    const Vec3 reach{side[0], side[1], side[2]};
    EachSharpWithin(
        s_, center_ - reach, center_ + reach,
        [&](const Vec3& start, const Vec3& end, const auto& edge_of) noexcept {
          Edge(start, end, edge_of);
        },
        [&](const Vec3& p, const auto& each_beside) noexcept { Peak(p, each_beside); });
  }
  /// All around the box, as what is around its longest middle line.
  LineReach Reach(double more_m) const noexcept {
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (half_[axis] > half_[longest]) longest = axis;
    }
    const double u = half_[(longest + 1) % 3], v = half_[(longest + 2) % 3];
    const Vec3 half = half_[longest] * axes_[longest];
    return ReachOfLine(s_, center_ - half, center_ + half, Sqrt(u * u + v * v) + more_m);
  }
  /// Away from ground; of a sheet to where the box is.
  Vec3 NormalOf(const SurfaceTriangle& t) const noexcept {
    const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const bool turned = !s_.solid && Dot(n, center_ - t.p[0]) < 0.0;
    return ((turned ? -1.0 : 1.0) / Norm(n)) * n;
  }

  /// Whether a corner has gone through a sheet at its nearest place, and not past its border or
  /// over a ridge: the way from it to the middle of the box comes through, too.
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
    Vec3 p = center_;
    for (int axis = 0; axis < 3; ++axis) p = p + Sign(corner, axis) * half_[axis] * axes_[axis];
    SurfacePlace places[kPlacesOfCorner];
    const double look_m = s_.solid ? limit_m_ : Larger(limit_m_, kDeepestSheet * thinnest_m_);
    const int found = NearestPlaces(s_, p, look_m, places, kPlacesOfCorner);
    // The first of them with its place.
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
    list_.Add(p, planes[0].normal, planes[0].gap_m, corner);
    for (int i = 1; i < count; ++i) others_.Add({p, planes[i].normal, planes[i].gap_m, corner + i});
  }

  /// Beside its nearest place `base` ground may rise: there a corner is held by planes of triangles
  /// that it is not above yet, or that it is under. The nearest place of what is under a valley is
  /// in its edge, and gives way to the planes on both sides.
  int AddRising(const Vec3& p, const Vec3& base, Plane* planes, int count) const noexcept {
    const Plane first = planes[0];
    const double beside_m = limit_m_ + kBesideDepths * Larger(-first.gap_m, 0.0);
    const double at_base_m = (1.0 + kLevel) * Larger(-first.gap_m, 0.0) + kSameGapM;
    const Vec3 reach{beside_m, beside_m, beside_m};
    int sides = 0;
    EachTriangle(s_, p - reach, p + reach, [&](const SurfaceTriangle& t) noexcept {
      const Vec3 normal = NormalOf(t);
      const double gap_m = Dot(normal, p - t.p[0]);
      if (!(gap_m < limit_m_) || !(Dot(normal, center_ - t.p[0]) > 0.0)) return;
      // A right angle at most, as that of the corner.
      if (!(Dot(first.normal, normal) > -kLevel)) return;
      const Vec3 middle = (1.0 / 3.0) * (t.p[0] + t.p[1] + t.p[2]) - base;
      const Vec3 down = base - t.p[0];
      if (!(Dot(first.normal, middle) > kLevel * Norm(middle))) return;
      if (!(Dot(normal, down) >= -kLevel * Norm(down) - kSameGapM)) return;
      const double apart_m = Norm(p - NearestPlaceOf(t, p));
      if (apart_m > beside_m) return;
      if (first.gap_m < 0.0 && apart_m <= at_base_m) ++sides;
      for (int i = 0; i < count; ++i) {
        if (Dot(planes[i].normal, normal) > kSamePlane) return;
      }
      if (count < kPlanesOfCorner) {
        planes[count++] = {normal, gap_m};
      } else if (gap_m < planes[count - 1].gap_m) {
        planes[count - 1] = {normal, gap_m};
      }
    });
    if (sides < 2) return count;
    for (int i = 1; i < count; ++i) planes[i - 1] = planes[i];
    return count - 1;
  }

  struct InBox {
    double x[3];
  };
  InBox Turned(const Vec3& p) const noexcept {
    return {{Dot(p, axes_[0]), Dot(p, axes_[1]), Dot(p, axes_[2])}};
  }

  /// An edge of the ground against those of the box: along the direction at right angles to both,
  /// if it leads out of both.
  template <class EdgeOf>
  void Edge(const Vec3& start, const Vec3& end, const EdgeOf& edge_of) noexcept {
    const InBox a = Turned(start - center_), d = Turned(end - start);
    for (int axis = 0; axis < 3; ++axis) {
      const double beyond = half_[axis] + limit_m_, b = a.x[axis] + d.x[axis];
      if ((a.x[axis] > beyond && b > beyond) || (a.x[axis] < -beyond && b < -beyond)) return;
    }
    const double length2 = Dot(end - start, end - start);
    SurfaceEdge edge;
    edge.sides = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const double du = d.x[u], dv = d.x[v], across2 = du * du + dv * dv;
      if (!(across2 > kParallel * kParallel * length2)) continue;
      const double across = Sqrt(across2);
      for (int which = 0; which < 4; ++which) {
        const double su = Sign(which, 0), sv = Sign(which, 1);
        const double side = dv * su - du * sv > 0.0 ? 1.0 / across : -1.0 / across;
        const double nu = -side * dv, nv = side * du;  // into the box
        const double cu = su * half_[u] - a.x[u], cv = sv * half_[v] - a.x[v];
        const double gap_m = nu * cu + nv * cv;
        if (!(gap_m < limit_m_ && gap_m > -kDeepestEdge * thinnest_m_)) continue;
        if (nu * su * half_[u] > 0.5 * limit_m_ + kLevel * half_[u]) continue;
        if (nv * sv * half_[v] > 0.5 * limit_m_ + kLevel * half_[v]) continue;
        const double along = (cu * du + cv * dv) / across2;
        const double at = a.x[axis] + along * d.x[axis];
        if (!(along >= 0.0 && along <= 1.0 && Abs(at) <= half_[axis])) continue;
        const Vec3 normal = nu * axes_[u] + nv * axes_[v];
        if (edge.sides == 0) edge = edge_of();
        if (!LeadsOut(edge, normal, length2)) continue;
        const Vec3 p =
            center_ + at * axes_[axis] + su * half_[u] * axes_[u] + sv * half_[v] * axes_[v];
        others_.Add({p, normal, gap_m, 4 * axis + which + static_cast<int>(at > 0.0)});
      }
    }
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

  /// A corner of the ground beside the box, or in it and nearest to a face that it can have come
  /// through.
  template <class EachBeside>
  void Peak(const Vec3& p, const EachBeside& each_beside) noexcept {
    const InBox at = Turned(p - center_);
    double above[3], to_box[3], distance2 = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      above[axis] = Abs(at.x[axis]) - half_[axis];
      if (above[axis] > limit_m_) return;
      to_box[axis] = Clamp(at.x[axis], -half_[axis], half_[axis]) - at.x[axis];
      distance2 += to_box[axis] * to_box[axis];
    }
    const auto leads_out = [&](const Vec3& normal) noexcept {
      bool out = true;
      each_beside([&](const Vec3& other) noexcept {
        const Vec3 way = other - p;
        out = out && Dot(normal, way) <= limit_m_ + kLevel * Norm(way);
      });
      return out;
    };
    const auto take = [&](const Vec3& normal, double gap_m, int face) noexcept {
      others_.Add({p + gap_m * normal, normal, gap_m, face});
    };
    const double distance = Sqrt(distance2);
    if (distance > kSameGapM) {
      if (distance > limit_m_) return;
      Vec3 normal{0.0, 0.0, 0.0};
      for (int axis = 0; axis < 3; ++axis) {
        normal = normal + (to_box[axis] / distance) * axes_[axis];
      }
      if (leads_out(normal)) take(normal, distance, 0);
      return;
    }
    bool seen[3] = {false, false, false};
    for (int i = 0; i < 3; ++i) {
      int face = -1;
      for (int axis = 0; axis < 3; ++axis) {
        if (!seen[axis] && (face < 0 || above[axis] > above[face])) face = axis;
      }
      seen[face] = true;
      const Vec3 normal = (at.x[face] < 0.0 ? 1.0 : -1.0) * axes_[face];
      if (!leads_out(normal)) continue;
      take(normal, above[face], face);
      return;
    }
  }

  const SurfaceTable& s_;
  Vec3 center_, axes_[3];
  double half_[3], thinnest_m_, limit_m_;
  TouchList& list_;
  Others others_;
};

}  // namespace

int Touch(const BoxShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept {
  TouchList list(out, margin_m);
  BoxSearch(a, *b.table, margin_m, list).Run();
  return list.count();
}

double DistanceUpTo(const BoxShape& a, const SurfaceShape& b, double enough_m) noexcept {
  const double most_m = kFarthestLook * Norm(Load(a.half_m));
  double look_m = Smaller(enough_m, kNearestLook * most_m);
  TouchPoint points[kMaxPointsPerPair];
  TouchList list(points, look_m);
  BoxSearch search(a, *b.table, look_m, list);
  search.Run();
  if (list.count() > 0) {
    return Larger((1.0 - kSameGap) * list.least_gap_m() - kSameGapM, 0.0);
  }
  while (look_m < most_m && search.IsClear(kFurther * look_m)) look_m = kFurther * look_m;
  return look_m;
}

}  // namespace taut::sim
