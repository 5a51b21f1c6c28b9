/// Where two shapes touch, for one world: the rare part of collision, kept scalar so that every
/// instruction set runs the very same code.
///
/// What a caller may rely on
///   - All functions need only + - * / and square roots, allocate nothing and never throw.
///   - As shapes move, a point enters and leaves with its gap at the margin, or where others make
///     up for it: for a capsule to a millionth of the radius in gap, or a thousandth in place. Two
///     things do jump: which way out is shortest for a deep penetration, and which of two boxes'
///     faces or edges meet.
///   - Features number the points of a pair, so that a solver finds its last answer again.
#pragma once

#include "sim/geometry/shapes.h"

namespace taut::sim {

/// A contact point: the unit normal points from the second shape to the first.
struct TouchPoint {
  double point[3];  ///< Midway between the two surfaces; on the shape's where it meets ground [m].
  double normal[3];
  double gap_m;   ///< Negative: penetration.
  int feature;    ///< Below kMaxPointsPerPair; stable while the shapes slide.
  double when_s;  ///< Point and normal are those of this moment, from now; 0 but for passing.h.
};

/// What the features below need, and every pair that is to come.
inline constexpr int kMaxPointsPerPair = 13;

/// Each fills `out` (kMaxPointsPerPair entries) with the points whose gap is below `margin_m`, and
/// returns how many there are.
///
/// Features: 0 the closest points; 1, 2 the ends of the stretch that capsules at less than 30
/// degrees have in common.
int Touch(const RoundShape& a, const RoundShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0, 1 the ends (a sphere has one); 2 the point of the centre line nearest to the box;
/// 3..8 where the centre line crosses the planes of the box's faces.
int Touch(const RoundShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..3 corners of a face; 4..11 where its edges leave and enter the other box's face
/// along each of that one's four sides; 12 edges that cross, or a
/// corner beside the face that is nearer.
int Touch(const BoxShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0, 1 the ends (a sphere has one); 2 the place of the centre line nearest to the hull;
/// 3..12 where the centre line comes beside an edge and leaves it.
int Touch(const RoundShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..12 by where the points are; more of them are thinned out (many_touches.h).
int Touch(const BoxShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;
int Touch(const HullShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..2 and 3..5 places of the ends (a sphere has one), by their normals' directions;
/// 6..12 edges and corners that stick out, against the flank, by the seventh of it.
int Touch(const RoundShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;

/// Those of an end, a bit each.
constexpr unsigned FeaturesOfEnd(int end) { return 7u << (3 * end); }

struct NearParts;
/// The same without the features `elsewhere`, of ends that another shape of the body has. `kept`
/// holds what was near (surface_parts.h), or is null; any `kept` of this pair gives the same bits.
int TouchGround(const RoundShape& a, const SurfaceShape& b, double margin_m, unsigned elsewhere,
                NearParts* kept, TouchPoint* out) noexcept;

/// Features: 0..12 by where the points are, of a box 0..7 its corners; more of them are thinned
/// out.
int Touch(const BoxShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;
int Touch(const HullShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;

/// Neither moves.
inline int Touch(const SurfaceShape&, const SurfaceShape&, double, TouchPoint*) noexcept {
  return 0;
}

/// A lower bound of the distance between two shapes, 0 if they may touch. Exact where one is round.
double Distance(const RoundShape& a, const RoundShape& b) noexcept;
double Distance(const RoundShape& a, const BoxShape& b) noexcept;
double Distance(const BoxShape& a, const BoxShape& b) noexcept;
double Distance(const RoundShape& a, const HullShape& b) noexcept;
inline double Distance(const SurfaceShape&, const SurfaceShape&) noexcept { return 1e300; }

/// The same for who knows that `enough_m` is far enough: what is near ground looks no further.
template <class A, class B>
double DistanceUpTo(const A& a, const B& b, double) noexcept {
  return Distance(a, b);
}
/// Not exact where two corners are nearest to each other.
double DistanceUpTo(const BoxShape& a, const HullShape& b, double enough_m) noexcept;
double DistanceUpTo(const HullShape& a, const HullShape& b, double enough_m) noexcept;
/// From what `Touch` finds: never more than the least gap of that, and no less by a hundredth of
/// the radius (of a box by a hundred-thousandth of the gap). Beyond `enough_m` it goes by bounds.
double DistanceUpTo(const RoundShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceUpTo(const BoxShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceUpTo(const HullShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceToGround(const RoundShape& a, const SurfaceShape& b, double enough_m,
                        NearParts* kept) noexcept;

/// The same for shapes of any two kinds, in either order, each given in a frame of its own.
int TouchShapes(const Shape& a, const ShapePose& at_a, const Shape& b, const ShapePose& at_b,
                double margin_m, TouchPoint* out) noexcept;
double DistanceOfShapes(const Shape& a, const ShapePose& at_a, const Shape& b,
                        const ShapePose& at_b, double enough_m = 1e300) noexcept;

}  // namespace taut::sim
