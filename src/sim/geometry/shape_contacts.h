/// Narrow phase: contact points, normals and gaps of two shapes, for one world. Scalar, so that
/// every instruction set runs the same code.
///
/// Guarantees
///   - All functions need only + - * / and square roots, allocate nothing and never throw.
///   - The contact manifold changes continuously as shapes move: a point appears and disappears
///     where its gap equals the margin, or where other points replace it (capsules: within 1e-6 of
///     the radius in gap, or 1e-3 in place). Two choices do jump: the shortest way out of a deep
///     penetration, and the pair of faces or edges of two boxes.
///   - Features number the points of a pair; they are part of the key for warm starts.
#pragma once

#include "sim/geometry/shapes.h"

namespace taut::sim {

/// A contact point; the unit normal points from the second shape to the first.
struct TouchPoint {
  double point[3];  ///< Midway between the two surfaces; for shapes on ground, on the shape's
                    ///< surface [m].
  double normal[3];
  double gap_m;   ///< Negative: penetration.
  int feature;    ///< Below kMaxPointsPerPair; stable while the shapes slide.
  double when_s;  ///< Time from now at which point and normal hold; 0 except from passing.h.
};

/// Largest contact manifold of a pair: room for the features below. New pairs of shapes must fit.
inline constexpr int kMaxPointsPerPair = 13;

/// Each `Touch` fills `out` (kMaxPointsPerPair entries) with the points whose gap is below
/// `margin_m`, and returns their number.
///
/// Features: 0 the closest points; 1, 2 the ends of the stretch along which capsules at less than
/// 30 degrees overlap.
int Touch(const RoundShape& a, const RoundShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0, 1 the ends (a sphere has one); 2 the point of the centerline nearest to the box;
/// 3..8 the crossings of the centerline with the planes of the box's faces.
int Touch(const RoundShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..3 corners of a face; 4..11 points where its edges leave and enter the other box's
/// face across each of the four sides of the latter; 12 crossing edges, or a nearer corner outside
/// the face.
int Touch(const BoxShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0, 1 the ends (a sphere has one); 2 the point of the centerline nearest to the hull;
/// 3..12 the points where the centerline enters and leaves the Voronoi region of an edge.
int Touch(const RoundShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..12 by place; larger manifolds are reduced (many_touches.h).
int Touch(const BoxShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;
int Touch(const HullShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..2 and 3..5 places of the ends (a sphere has one), ordered by their normals; 6..12
/// sharp edges and corners against the flank, by the seventh of the rod's length.
int Touch(const RoundShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;

/// Returns the features of an end as a bit mask.
constexpr unsigned FeaturesOfEnd(int end) { return 7u << (3 * end); }

struct NearParts;
/// Like Touch, without the features `elsewhere`, of ends that another shape of the body has.
/// `kept`: cache of near parts (surface_parts.h), or null; any cache of this pair gives the same
/// bits.
int TouchGround(const RoundShape& a, const SurfaceShape& b, double margin_m, unsigned elsewhere,
                NearParts* kept, TouchPoint* out) noexcept;

/// Features: 0..12 by place, for a box 0..7 its corners; larger manifolds are reduced.
int Touch(const BoxShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;
int Touch(const HullShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;

/// Neither moves.
inline int Touch(const SurfaceShape&, const SurfaceShape&, double, TouchPoint*) noexcept {
  return 0;
}

/// Returns a lower bound of the distance between two shapes, 0 if they may touch. Exact where one
/// is round.
double Distance(const RoundShape& a, const RoundShape& b) noexcept;
double Distance(const RoundShape& a, const BoxShape& b) noexcept;
double Distance(const BoxShape& a, const BoxShape& b) noexcept;
double Distance(const RoundShape& a, const HullShape& b) noexcept;
inline double Distance(const SurfaceShape&, const SurfaceShape&) noexcept { return 1e300; }

/// Like Distance, for callers that need no more than `enough_m`: the search near ground ends there.
template <class A, class B>
double DistanceUpTo(const A& a, const B& b, double) noexcept {
  return Distance(a, b);
}
/// Not exact where two corners are nearest to each other.
double DistanceUpTo(const BoxShape& a, const HullShape& b, double enough_m) noexcept;
double DistanceUpTo(const HullShape& a, const HullShape& b, double enough_m) noexcept;
/// Computed from the points of `Touch`: at most their least gap, and less by at most 0.01 radius
/// (boxes and hulls: by 1e-5 of the gap). Beyond `enough_m` from bounds.
double DistanceUpTo(const RoundShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceUpTo(const BoxShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceUpTo(const HullShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceToGround(const RoundShape& a, const SurfaceShape& b, double enough_m,
                        NearParts* kept) noexcept;

/// Call the function above for shapes of any two kinds, in either order, each given in its body's
/// frame.
int TouchShapes(const Shape& a, const ShapePose& at_a, const Shape& b, const ShapePose& at_b,
                double margin_m, TouchPoint* out) noexcept;
double DistanceOfShapes(const Shape& a, const ShapePose& at_a, const Shape& b,
                        const ShapePose& at_b, double enough_m = 1e300) noexcept;

}  // namespace taut::sim
