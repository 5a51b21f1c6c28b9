// Rejection of contacts inside the joint surface of adjacent terrain pieces (seams.h).
#include "sim/geometry/seams.h"

#include "sim/geometry/surface_near.h"
#include "sim/geometry/touch_list.h"

namespace taut::sim {
namespace {

/// Rounding tolerance of sines and cosines.
constexpr double kLevel = 1e-6;
/// A direction with a larger sine is not tangential, at any length.
constexpr double kSteep = 0.5;
/// kSteps: search radius around a point, in units of the tolerance `same_m`. kOpenSteps: distance
/// from a covered point to open surface, in the same units; larger than the penetration of pressed
/// bodies.
constexpr double kSteps = 16.0, kOpenSteps = 500.0;

/// Returns whether a vector of this length rises by more than the tolerance.
bool Rises(double up_m, double length_m, const SeamSlack& slack) noexcept {
  return up_m > slack.length_m + slack.sine * length_m || up_m > kSteep * length_m;
}

bool IsWithin(const SeamPiece& piece, const Vec3& p, double more_m) noexcept {
  return p.x >= piece.low.x - more_m && p.x <= piece.high.x + more_m &&
         p.y >= piece.low.y - more_m && p.y <= piece.high.y + more_m &&
         p.z >= piece.low.z - more_m && p.z <= piece.high.z + more_m;
}

/// Calls `use(triangle, nearest)` for the triangles at a point. `nearest`: their nearest points.
template <class Use>
void EachAt(const SurfaceTable& s, const Vec3& place, double same_m, const Use& use) noexcept {
  const Vec3 reach{same_m, same_m, same_m};
  EachTriangle(s, place - reach, place + reach, [&](const SurfaceTriangle& t) noexcept {
    const Vec3 at = NearestPlaceOf(t, place);
    if (Norm(place - at) <= same_m) use(t, at);
  });
}

/// Returns whether a half space covers a normal at a point: the point is in it, and the normal is
/// not parallel to the outward normal of the plane.
bool PlaneCovers(const SeamPiece& plane, const Vec3& place, const Vec3& normal, double same_m,
                 double sine) noexcept {
  if (Dot(plane.normal, place) - plane.offset_m > same_m) return false;
  const double out = Dot(plane.normal, normal);
  return !(out > 0.0) || Norm(normal - out * plane.normal) > sine;
}

/// Returns whether a box covers a normal at a point. The box covers the normal unless the normal
/// lies between the normals of the box's faces there; all other directions are tangential or point
/// into the box.
bool BoxCovers(const BoxShape& box, const Vec3& place, const Vec3& normal, double same_m,
               const SeamSlack& slack) noexcept {
  if (!IsIn(box, place, same_m)) return false;
  const Vec3 d = place - Load(box.center);
  bool on_face = false;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = Dot(d, AxisOf(box, axis)), half_m = box.half_m[axis];
    const double out = (at < 0.0 ? -1.0 : 1.0) * Dot(normal, AxisOf(box, axis));
    const bool here = Abs(at) >= half_m - same_m;
    on_face = on_face || here;
    if (Rises(half_m * (here ? -out : Abs(out)), half_m, slack)) return true;
  }
  return !on_face;
}

/// Returns whether the vertical wall below the border of a field covers a normal at a point.
bool WallCovers(const SurfaceTable& s, const Vec3& place, const Vec3& normal, double same_m,
                double sine) noexcept {
  const double depth = HeightAt(s, place.x, place.y) - place.z;
  if (depth < -same_m) return false;
  const bool west = place.x <= s.low.x + same_m, east = place.x >= s.high.x - same_m;
  const bool south = place.y <= s.low.y + same_m, north = place.y >= s.high.y - same_m;
  const bool border = west || east || south || north;
  if (depth <= same_m) return border && normal.z < -sine;
  const auto covers = [&](double along, bool below, bool above) noexcept {
    if (below == above) return Abs(along) > sine;
    return (above ? -along : along) > sine;
  };
  return !border || Abs(normal.z) > sine || covers(normal.x, west, east) ||
         covers(normal.y, south, north);
}

bool SurfaceCovers(const SurfaceTable& s, const Vec3& place, const Vec3& normal, double same_m,
                   const SeamSlack& slack) noexcept {
  bool rises = false, found = false, into = s.solid;
  EachAt(s, place, same_m, [&](const SurfaceTriangle& t, const Vec3& at) noexcept {
    found = true;
    for (const Vec3& corner : t.p) {
      const Vec3 way = corner - at;
      rises = rises || Rises(Dot(normal, way), Norm(way), slack);
    }
    const Vec3 out = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    into = into && Dot(normal, out) < -kLevel * Norm(out);
  });
  if (rises || (found && into)) return true;
  return s.is_field && WallCovers(s, place, normal, same_m, kLevel);
}

bool SurfaceGoesOn(const SurfaceTable& s, const Vec3& place, const Vec3& way,
                   double same_m) noexcept {
  const double step_m = kSteps * same_m;
  bool on = false;
  EachAt(s, place, same_m, [&](const SurfaceTriangle& t, const Vec3& at) noexcept {
    const Vec3 there = at + step_m * way;
    on = on || Norm(there - NearestPlaceOf(t, there)) <= kLevel * step_m;
  });
  return on;
}

bool BoxGoesOn(const BoxShape& box, const Vec3& place, const Vec3& way, double same_m) noexcept {
  if (!IsIn(box, place, same_m) || !IsIn(box, place + kSteps * same_m * way, same_m)) {
    return false;
  }
  const Vec3 d = place - Load(box.center);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 a = AxisOf(box, axis);
    if (Abs(Dot(d, a)) >= box.half_m[axis] - same_m && Abs(Dot(way, a)) <= kLevel) return true;
  }
  return false;
}

/// Returns whether `way` leads to one side of an open sheet at the point while the center of the
/// body is on the other side.
bool IsBehindSheet(const SeamList& seams, const Vec3& place, const Vec3& way, const Vec3& middle,
                   double more_m) noexcept {
  bool behind = false;
  for (int i = 0; i < seams.count && !behind; ++i) {
    const SeamPiece& piece = seams.pieces[i];
    if (piece.kind != SeamPiece::kSurface || piece.surface->solid || piece.surface->is_field ||
        !IsWithin(piece, place, more_m)) {
      continue;
    }
    EachAt(*piece.surface, place, piece.same_m + more_m,
           [&](const SurfaceTriangle& t, const Vec3&) noexcept {
             const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
             const double along = Dot(n, way), least = kLevel * Norm(n) * Norm(way);
             const double side = Dot(n, middle - place);
             behind = behind || (along > least && side < 0.0) || (along < -least && side > 0.0);
           });
  }
  return behind;
}

}  // namespace

bool IsOnSeam(const SeamList& seams, const Vec3& place, double more_m) noexcept {
  for (int i = 0; i < seams.count; ++i) {
    const SeamPiece& piece = seams.pieces[i];
    const double same_m = piece.same_m + more_m;
    if (!IsWithin(piece, place, more_m)) continue;
    if (piece.kind == SeamPiece::kPlane) {
      if (Dot(piece.normal, place) - piece.offset_m <= same_m) return true;
    } else if (piece.kind == SeamPiece::kBox) {
      if (IsIn(piece.box, place, same_m)) return true;
    } else {
      const SurfaceTable& s = *piece.surface;
      if (s.is_field && HeightAt(s, place.x, place.y) - place.z > same_m) return true;
      bool on = false;
      EachAt(s, place, same_m, [&](const SurfaceTriangle&, const Vec3&) noexcept { on = true; });
      if (on) return true;
    }
  }
  return false;
}

bool IsCovered(const SeamList& seams, const Vec3& place, const Vec3& normal, const SeamSlack& slack,
               double more_m) noexcept {
  for (int i = 0; i < seams.count; ++i) {
    const SeamPiece& piece = seams.pieces[i];
    const double same_m = piece.same_m + more_m;
    if (!IsWithin(piece, place, more_m)) continue;
    const bool covers = piece.kind == SeamPiece::kPlane
                            ? PlaneCovers(piece, place, normal, same_m, slack.sine)
                        : piece.kind == SeamPiece::kBox
                            ? BoxCovers(piece.box, place, normal, same_m, slack)
                            : SurfaceCovers(*piece.surface, place, normal, same_m, slack);
    if (covers) return true;
  }
  return false;
}

bool IsExposed(const SeamList& seams, const Vec3& end, const SeamContact& contact,
               const SeamSlack& slack, double more_m) noexcept {
  const auto& [place, normal, middle] = contact;
  const Vec3 way = end - place;
  const double length_m = Norm(way);
  if (middle == nullptr || !(length_m > 2.0 * (seams.same_m + more_m))) return false;
  if (Abs(Dot(normal, way)) > kLevel * length_m || !(Dot(way, *middle - place) > 0.0)) return false;
  // For inexact points: not tangential to the covering piece beyond its end.
  const double near_m = 3.0 * (seams.same_m + more_m);
  if (more_m > 0.0 && IsOnSeam(seams, place + Smaller(near_m / length_m, 1.0) * way, more_m)) {
    return false;
  }
  if (IsBehindSheet(seams, place, way, *middle, more_m)) return false;
  const double step_m = kOpenSteps * seams.same_m + kSteps * more_m;
  return !IsCovered(seams, place + Smaller(step_m / length_m, 1.0) * way, normal, slack, more_m);
}

bool IsFaceCovered(const SeamList& seams, const SurfaceTriangle& face, const SeamContact& contact,
                   const SeamSlack& slack) noexcept {
  if (!IsCovered(seams, contact.place, contact.normal, slack)) return false;
  for (const Vec3& corner : face.p) {
    if (IsExposed(seams, corner, contact, slack)) return false;
  }
  return true;
}

bool IsEdgeCovered(const SeamList& seams, const Vec3& from, const Vec3& to,
                   const SeamContact& contact, const SeamSlack& slack) noexcept {
  return IsCovered(seams, contact.place, contact.normal, slack) &&
         !IsExposed(seams, from, contact, slack) && !IsExposed(seams, to, contact, slack);
}

bool GoesStraightOn(const SurfaceTable* own, const SeamList& seams, const Vec3& place,
                    const Vec3& way, bool boxes) noexcept {
  if (own != nullptr && SurfaceGoesOn(*own, place, way, seams.same_m)) return true;
  for (int i = 0; i < seams.count; ++i) {
    const SeamPiece& piece = seams.pieces[i];
    if (!IsWithin(piece, place, 0.0)) continue;
    if (piece.kind == SeamPiece::kPlane) {
      const double height = Dot(piece.normal, place) - piece.offset_m;
      if (Abs(height) <= piece.same_m && Abs(Dot(piece.normal, way)) <= kLevel) return true;
    } else if (piece.kind == SeamPiece::kBox) {
      if (boxes && BoxGoesOn(piece.box, place, way, piece.same_m)) return true;
    } else if (SurfaceGoesOn(*piece.surface, place, way, piece.same_m)) {
      return true;
    }
  }
  return false;
}

bool IsFlatAround(const SurfaceTable& own, const SeamList& seams, const Vec3& place,
                  const Vec3& normal) noexcept {
  const Vec3 axis = Abs(normal.x) < 0.6 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  Vec3 u = axis - Dot(axis, normal) * normal;
  u = (1.0 / Norm(u)) * u;
  const Vec3 v = Cross(normal, u);
  constexpr double kDiagonal = 0.70710678118654752;
  const Vec3 ways[] = {u, v, kDiagonal * (u + v), kDiagonal * (u - v)};
  for (const Vec3& way : ways) {
    if (!GoesStraightOn(&own, seams, place, way, false) ||
        !GoesStraightOn(&own, seams, place, -1.0 * way, false)) {
      return false;
    }
  }
  return true;
}

}  // namespace taut::sim
