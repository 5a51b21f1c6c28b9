/// Seams: adjacent pieces of terrain form one surface (docs/theory/ground.md, section 9).
///
/// Contacts are detected per piece. A contact with one piece may be inside the joint surface: on an
/// edge where a neighbor continues in the same plane, or on a side wall covered by a neighbor. The
/// functions below reject such contacts. These functions inspect only the neighborhood of one
/// point.
///
/// A step includes this header, so it does not use the standard library.
#pragma once

#include "math/vec.h"
#include "sim/geometry/shapes.h"

namespace taut::sim {

struct SurfaceTriangle;

/// Piece of terrain near another one.
struct SeamPiece {
  enum Kind { kPlane, kBox, kSurface };
  Kind kind = kPlane;
  double same_m = 0;  ///< Largest distance between coinciding points of both pieces.
  Vec3 low, high;     ///< Bounds, enlarged by `same_m`. Fields and planes have no lower bound.
  Vec3 normal;        ///< Plane: normal . x = offset_m.
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

/// Returns whether a piece contains the point and continues in the direction of the normal, so that
/// the tip of the normal is nearer to a part of it.
bool IsCovered(const SeamList& seams, const Vec3& place, const Vec3& normal, const SeamSlack& slack,
               double more_m = 0.0) noexcept;

/// Contact that may be covered. `middle`: center of a body with flat faces, otherwise null.
struct SeamContact {
  Vec3 place, normal;
  const Vec3* middle;
};

/// Like IsCovered, for a point of a triangle or edge whose cover may end nearby, as at the foot of
/// a wall. A body with flat faces has a contact there.
bool IsFaceCovered(const SeamList& seams, const SurfaceTriangle& face, const SeamContact& contact,
                   const SeamSlack& slack) noexcept;
bool IsEdgeCovered(const SeamList& seams, const Vec3& from, const Vec3& to,
                   const SeamContact& contact, const SeamSlack& slack) noexcept;
/// Returns whether the path from a covered point to `end`, normal to the contact normal and toward
/// the body, is open.
bool IsExposed(const SeamList& seams, const Vec3& end, const SeamContact& contact,
               const SeamSlack& slack, double more_m = 0.0) noexcept;

/// Returns whether a piece, or `own` if not null, continues straight from a point in a unit
/// direction. `boxes`: whether boxes count.
bool GoesStraightOn(const SurfaceTable* own, const SeamList& seams, const Vec3& place,
                    const Vec3& way, bool boxes) noexcept;
/// Returns whether the surface continues straight in all tangential directions.
bool IsFlatAround(const SurfaceTable& own, const SeamList& seams, const Vec3& place,
                  const Vec3& normal) noexcept;

}  // namespace taut::sim
