/// Seams: adjacent pieces of terrain form one surface (docs/theory/ground.md, section 9).
///
/// Contacts are detected per piece. A contact with one piece may be internal to the joint surface:
/// an edge where a neighbor continues in the same plane, a side wall that a neighbor covers. The
/// functions below reject internal contacts. They inspect only the neighborhood of one point.
///
/// Part of a step: no standard library.
#pragma once

#include "math/vec.h"
#include "sim/geometry/shapes.h"

namespace taut::sim {

struct SurfaceTriangle;

/// A piece of terrain near another one.
struct SeamPiece {
  enum Kind { kPlane, kBox, kSurface };
  Kind kind = kPlane;
  double same_m = 0;  ///< Largest distance of coincident points of both pieces.
  Vec3 low, high;     ///< Bounds, grown by `same_m`; fields and planes have no lower bound.
  Vec3 normal;        ///< Of a plane: normal . x = offset_m.
  double offset_m = 0;
  BoxShape box = {};
  const SurfaceTable* surface = nullptr;
};

/// Pieces near a piece of terrain.
struct SeamList {
  const SeamPiece* pieces = nullptr;
  int count = 0;
  double same_m = 0;  ///< Largest `same_m` of the pieces.
};

/// Tolerances (length and sine) within which a normal is tangential to a piece and does not point
/// into it.
struct SeamSlack {
  double length_m, sine;
};

/// Returns whether a point belongs to another piece.
bool IsOnSeam(const SeamList& seams, const Vec3& place, double more_m = 0.0) noexcept;

/// Returns whether a piece contains the point and continues in the direction of the normal: a part
/// of it is nearer to the end of the normal.
bool IsCovered(const SeamList& seams, const Vec3& place, const Vec3& normal, const SeamSlack& slack,
               double more_m = 0.0) noexcept;

/// A contact that may be covered. `middle`: center of a body with flat faces, else null.
struct SeamContact {
  Vec3 place, normal;
  const Vec3* middle;
};

/// Like IsCovered, for a point of a triangle or an edge that may emerge from its cover nearby, like
/// the foot of a wall: there a body with flat faces has a contact.
bool IsFaceCovered(const SeamList& seams, const SurfaceTriangle& face, const SeamContact& contact,
                   const SeamSlack& slack) noexcept;
bool IsEdgeCovered(const SeamList& seams, const Vec3& from, const Vec3& to,
                   const SeamContact& contact, const SeamSlack& slack) noexcept;
/// Returns whether the path from a covered point to `end`, perpendicular to the normal and towards
/// the body, is open.
bool IsExposed(const SeamList& seams, const Vec3& end, const SeamContact& contact,
               const SeamSlack& slack, double more_m = 0.0) noexcept;

/// Returns whether a piece, or `own` if not null, continues straight from a point in a unit
/// direction. `boxes`: include boxes.
bool GoesStraightOn(const SurfaceTable* own, const SeamList& seams, const Vec3& place,
                    const Vec3& way, bool boxes) noexcept;
/// Returns whether the surface continues straight in all tangential directions.
bool IsFlatAround(const SurfaceTable& own, const SeamList& seams, const Vec3& place,
                  const Vec3& normal) noexcept;

}  // namespace taut::sim
