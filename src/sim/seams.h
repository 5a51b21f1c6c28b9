/// Seams: where pieces of terrain meet, they are one surface (docs/theory/ground.md, section 9).
///
/// Each piece finds its contacts without the others. What is a contact with one piece may be none
/// with all of them: an edge where a neighbor goes on in the same plane, a side wall that a
/// neighbor covers. The functions below tell those apart. They look only at the neighborhood of one
/// place.
///
/// Part of a step: no standard library.
#pragma once

#include "math/vec.h"
#include "sim/shapes.h"

namespace taut::sim {

struct SurfaceTriangle;

/// A piece of terrain near another one.
struct SeamPiece {
  enum Kind { kPlane, kBox, kSurface };
  Kind kind = kPlane;
  double same_m = 0;  ///< Places of both pieces that are no further apart are one.
  Vec3 low, high;     ///< Bounds, grown by `same_m`; of a field and a plane without a lower one.
  Vec3 normal;        ///< Of a plane: normal . x = offset_m.
  double offset_m = 0;
  BoxShape box = {};
  const SurfaceTable* surface = nullptr;
};

/// What is near a piece of terrain.
struct SeamList {
  const SeamPiece* pieces = nullptr;
  int count = 0;
  double same_m = 0;  ///< The largest of the pieces.
};

/// A normal leads along a piece, not into it, if it rises from it by no more than this: a length,
/// and a sine.
struct SeamSlack {
  double length_m, sine;
};

/// Whether a place belongs to some piece, too.
bool IsOnSeam(const SeamList& seams, const Vec3& place, double more_m = 0.0) noexcept;

/// Whether a piece has the place, too, and goes on in the direction of the normal: something of it
/// is nearer to what the normal leads to.
bool IsCovered(const SeamList& seams, const Vec3& place, const Vec3& normal, const SeamSlack& slack,
               double more_m = 0.0) noexcept;

/// A contact that may be covered. `middle`: of a body with flat faces, else null.
struct SeamContact {
  Vec3 place, normal;
  const Vec3* middle;
};

/// The same for a place of a triangle or an edge, along which it may come out of what covers it
/// nearby, as the foot of a wall does: there a body with flat faces has a contact.
bool IsFaceCovered(const SeamList& seams, const SurfaceTriangle& face, const SeamContact& contact,
                   const SeamSlack& slack) noexcept;
bool IsEdgeCovered(const SeamList& seams, const Vec3& from, const Vec3& to,
                   const SeamContact& contact, const SeamSlack& slack) noexcept;
/// Whether the way from a covered place to `end`, at right angles to the normal and to where the
/// body is, is open.
bool IsExposed(const SeamList& seams, const Vec3& end, const SeamContact& contact,
               const SeamSlack& slack, double more_m = 0.0) noexcept;

/// Whether a piece, or `own` if that is not null, goes straight on from a place in a direction of
/// length 1. With `boxes` also boxes do.
bool GoesStraightOn(const SurfaceTable* own, const SeamList& seams, const Vec3& place,
                    const Vec3& way, bool boxes) noexcept;
/// Whether all directions at right angles to the normal go straight on.
bool IsFlatAround(const SurfaceTable& own, const SeamList& seams, const Vec3& place,
                  const Vec3& normal) noexcept;

}  // namespace taut::sim
