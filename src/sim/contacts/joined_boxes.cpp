// Contacts of a shape with the union of adjacent terrain boxes.
#include "sim/contacts/joined_boxes.h"

#include "sim/geometry/convex.h"

namespace taut::sim {
namespace {

/// Distance below which a point of one box also belongs to its neighbor [m].
constexpr double kSamePlaceM = kJoinedM;
/// kNearer: another box counts as nearer to a point between the ends of a rod if its distance is
/// smaller by more than this [m]. kStraightOn: length over which boxes must continue, in radii.
constexpr double kNearer = 1e-9, kStraightOn = 1e-3;
/// A normal with a larger cosine counts as a face normal.
constexpr double kFace = 0.999;
/// Cosine tolerance for coplanar faces: 1e-6 rad.
constexpr double kLevelFace = 1.0 - 5e-13;
/// kCutAside: lateral tolerance of points at which the side of a box cuts a face of another,
/// relative to both sizes. kSteps: length over which boxes must continue, in units of this
/// tolerance.
constexpr double kCutAside = 2e-5, kSteps = 10.0;

double DistanceOf(const BoxShape& box, const Vec3& p) noexcept {
  const Vec3 d = p - Load(box.center);
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double beyond = Abs(Dot(d, AxisOf(box, axis))) - box.half_m[axis];
    if (beyond > 0.0) sum += beyond * beyond;
  }
  return Sqrt(sum);
}

Vec3 PlaceOf(const TouchPoint& t) noexcept {
  return Load(t.point) - (0.5 * t.gap_m) * Load(t.normal);
}

/// Sine by which a normal at other terrain may point into a box. The value is not 0, because
/// crossing edges have no exact normal.
constexpr double kIntoGround = 1e-2, kIntoGroundOfRod = 1e-7;

/// Returns whether other terrain covers a point of a box and its neighborhood.
bool IsUnderGround(const ShapeTable& own, const SeamContact& contact, double same_m) noexcept {
  const SeamSlack slack{0.0, kIntoGround};
  if (!IsCovered(own.seams, contact.place, contact.normal, slack, same_m)) return false;
  const BoxShape& box = own.shape_P.box;
  const Vec3 d = contact.place - Load(box.center);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 a = AxisOf(box, axis);
    const double at = Dot(d, a);
    const Vec3 up = contact.place + (box.half_m[axis] - at) * a;
    const Vec3 down = contact.place - (box.half_m[axis] + at) * a;
    if (IsExposed(own.seams, up, contact, slack, same_m) ||
        IsExposed(own.seams, down, contact, slack, same_m)) {
      return false;
    }
  }
  return true;
}

/// Point on the centerline of a rod.
struct Station {
  Vec3 center;
  bool is_end;
};

Station StationOf(const RoundShape& round, const TouchPoint& t) noexcept {
  if (t.feature == 0) return {Load(round.from), true};
  if (t.feature == 1) return {Load(round.to), true};
  return {Load(t.point) + (0.5 * t.gap_m + round.radius_m) * Load(t.normal), false};
}

/// Returns whether another box that contains the point `place` is nearer to the rod point. If so,
/// the segment from `place` to the rod point is not the shortest, and its start lies inside the
/// other box. If several boxes are equally near to an end, the first one has the contact.
bool IsHidden(const ShapeTable* shapes, int number, const Vec3& place, const Station& station,
              double radius_m, bool* shared) noexcept {
  const ShapeTable& own = shapes[number];
  const double distance = DistanceOf(own.shape_P.box, station.center);
  bool hidden = false;
  for (int i = 0; i < own.beside_count; ++i) {
    const BoxShape& other = shapes[own.beside[i]].shape_P.box;
    if (!IsIn(other, place, kSamePlaceM)) continue;
    *shared = true;
    const double there = DistanceOf(other, station.center);
    if (station.is_end) {
      hidden = hidden || there < distance || (there == distance && own.beside[i] < number);
    } else {
      hidden = hidden || there < distance - kNearer * radius_m;
    }
  }
  return hidden;
}

/// Returns whether boxes continue in the plane of a contact along a tangential direction.
/// `by_face`: with one of their faces.
bool GoesOn(const ShapeTable* shapes, int number, const Vec3& place, const Vec3& normal,
            const Vec3& way, double same_m = kSamePlaceM, bool by_face = false) noexcept {
  const ShapeTable& own = shapes[number];
  const auto in_plane = [&](const BoxShape& box) noexcept {
    const double above = Dot(normal, Load(box.center) - place) + Reach(box, normal);
    bool level = !by_face;
    for (int axis = 0; axis < 3 && !level; ++axis) {
      level = Abs(Dot(normal, AxisOf(box, axis))) > kLevelFace;
    }
    return level && above <= kSamePlaceM && IsIn(box, place + way, same_m);
  };
  if (in_plane(own.shape_P.box)) return true;
  for (int i = 0; i < own.beside_count; ++i) {
    if (in_plane(shapes[own.beside[i]].shape_P.box)) return true;
  }
  return false;
}

/// Finds the face of a box with a normal along `direction`. Returns false if no face is nearly
/// normal to it.
bool FaceAlong(const BoxShape& box, const Vec3& direction, Vec3* normal) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    const double along = Dot(direction, AxisOf(box, axis));
    *normal = (along < 0.0 ? -1.0 : 1.0) * AxisOf(box, axis);
    if (Abs(along) > kFace) return true;
  }
  return false;
}

/// Marks the contacts of a rod with the union of boxes. Contacts are local minima of the distance
/// along the rod. If several boxes form a plane, a point on it between the ends of the rod is not a
/// contact, since the contacts at both ends support the rod.
void MarkRound(const RoundShape& round, const ShapeTable* shapes, JoinedPoint* points,
               int count) noexcept {
  const double r = round.radius_m;
  const Vec3 along = Load(round.to) - Load(round.from);
  for (int i = 0; i < count; ++i) {
    JoinedPoint& p = points[i];
    // Deep inside a box, the exit direction of this box applies.
    if (p.touch.gap_m <= -r) continue;
    const Station station = StationOf(round, p.touch);
    const Vec3 place = PlaceOf(p.touch), normal = Load(p.touch.normal);
    bool shared = false;
    p.kept = !IsHidden(shapes, p.box, place, station, r, &shared);
    const SeamList& seams = shapes[p.box].seams;
    if (p.kept && seams.count > 0 && IsOnSeam(seams, place)) {
      shared = true;
      p.kept = !IsCovered(seams, place, normal, {0.0, kIntoGroundOfRod});
    }
    if (!p.kept || !shared || station.is_end) continue;
    Vec3 up = normal;
    if (!FaceAlong(shapes[p.box].shape_P.box, normal, &up)) up = normal;
    const Vec3 across = along - Dot(along, up) * up;
    if (!(Dot(across, across) > kNearer * Dot(along, along))) continue;
    const Vec3 way = (1.0 / Norm(across)) * across;
    const auto goes_on = [&](double side) noexcept {
      return GoesOn(shapes, p.box, place, up, side * kStraightOn * r * way) ||
             GoesStraightOn(nullptr, seams, place, side * way, false);
    };
    p.kept = !goes_on(1.0) || !goes_on(-1.0);
  }
}

/// Returns whether boxes continue in all directions around a point on a face of one of them.
bool IsFlat(const ShapeTable* shapes, int number, const Vec3& place, const Vec3& up, double step_m,
            double same_m) noexcept {
  const BoxShape& own = shapes[number].shape_P.box;
  const Vec3 side = AxisOf(own, Abs(Dot(up, AxisOf(own, 0))) > 0.5 ? 1 : 0);
  const Vec3 u = step_m * side, v = Cross(up, u);
  for (int a = -1; a <= 1; ++a) {
    for (int b = -1; b <= 1; ++b) {
      if (!GoesOn(shapes, number, place, up, a * u + b * v, same_m, true)) return false;
    }
  }
  return true;
}

bool IsCorner(const Convex& body, const Vec3& p, double same_m) noexcept {
  for (int i = 0; i < body.table->corner_count; ++i) {
    const Vec3 d = p - body.corners[i];
    if (Abs(d.x) <= same_m && Abs(d.y) <= same_m && Abs(d.z) <= same_m) return true;
  }
  return false;
}

/// Marks the contacts of a body with flat faces. On a plane formed by several boxes, only corners
/// of the body have contacts, along the normal of the plane. Elsewhere, the exit direction from one
/// box must not lead into another box.
void MarkFlat(const Convex& body, double size_m, const ShapeTable* shapes, JoinedPoint* points,
              int count) noexcept {
  for (int i = 0; i < count; ++i) {
    JoinedPoint& p = points[i];
    const Vec3 place = PlaceOf(p.touch), normal = Load(p.touch.normal);
    const ShapeTable& own = shapes[p.box];
    const double same_m = kCutAside * (size_m + own.bound_m) + kSamePlaceM;
    const double step_m = kSteps * same_m;
    bool shared = false;
    for (int k = 0; k < own.beside_count && p.kept; ++k) {
      const BoxShape& other = shapes[own.beside[k]].shape_P.box;
      if (!IsIn(other, place, same_m)) continue;
      shared = true;
      p.kept = !IsIn(other, place + step_m * normal, -same_m);
    }
    p.kept = p.kept && !(own.seams.count > 0 && IsUnderGround(own, {place, normal, &body.center},
                                                              same_m + Larger(p.touch.gap_m, 0.0)));
    if (!shared) continue;
    const bool is_corner = IsCorner(body, place + p.touch.gap_m * normal, same_m);
    const Vec3 d = place - Load(own.shape_P.box.center);
    for (int axis = 0; axis < 3 && p.kept; ++axis) {
      const double at = Dot(d, AxisOf(own.shape_P.box, axis));
      const double below = own.shape_P.box.half_m[axis] - Abs(at);
      const Vec3 up = (at < 0.0 ? -1.0 : 1.0) * AxisOf(own.shape_P.box, axis);
      if (below > same_m || (is_corner && Dot(normal, up) > kFace)) continue;
      p.kept = !IsFlat(shapes, p.box, place + below * up, up, step_m, same_m);
    }
  }
}

}  // namespace

void MarkKept(const Shape& shape, const ShapeTable* shapes, JoinedPoint* points,
              int count) noexcept {
  for (int i = 0; i < count; ++i) points[i].kept = true;
  if (shape.kind == ShapeKind::kRound) MarkRound(shape.round, shapes, points, count);
  if (shape.kind == ShapeKind::kBox) {
    MarkFlat(Convex(shape.box), Norm(Load(shape.box.half_m)), shapes, points, count);
  }
  if (shape.kind == ShapeKind::kHull) {
    MarkFlat(Convex(shape.hull), shape.hull.table->bound_m, shapes, points, count);
  }
  for (int i = 0; i < count; ++i) {
    TouchPoint& t = points[i].touch;
    for (int k = 0; k < 3; ++k) t.point[k] += 0.5 * t.gap_m * t.normal[k];
  }
}

uint32_t ArrivesBeside(const MovingShape& a, const ShapeTable* shapes, int box, uint32_t closing,
                       const TouchPoint* points, int count) noexcept {
  const ShapeTable& own = shapes[box];
  const double radius_m = RadiusOf(*a.shape);
  uint32_t beside = 0;
  for (int i = 0; i < count; ++i) {
    if ((closing >> i & 1u) == 0) continue;
    const Vec3 n = Load(points[i].normal);
    const Vec3 center = Load(points[i].point) + radius_m * n;
    const Vec3 place = Load(points[i].point) - points[i].gap_m * n;
    const Vec3 v = Load(a.v) + Cross(Load(a.w), center - Load(a.at.origin));
    const double rate = Dot(n, v);
    if (!(rate < 0.0)) continue;
    const Vec3 there = place + (points[i].gap_m / -rate) * (v - rate * n);
    for (int k = 0; k < own.beside_count; ++k) {
      if (IsIn(shapes[own.beside[k]].shape_P.box, there, kSamePlaceM)) beside |= 1u << i;
    }
    if (own.seams.count > 0 && IsOnSeam(own.seams, there)) beside |= 1u << i;
  }
  return beside;
}

}  // namespace taut::sim
