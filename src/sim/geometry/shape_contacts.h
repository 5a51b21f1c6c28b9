/// Narrow phase: contact points, normals and gaps of two shapes, for one world. Scalar code, so
/// that every instruction set runs the same code.
///
/// Guarantees
///   - All functions need only + - * / and square roots, allocate nothing and never throw.
///   - The contact manifold changes continuously as shapes move: a point appears or disappears
///     where its gap equals the margin, or where other points replace it (capsules: within 1e-6 of
///     the radius in gap, or 1e-3 in place). Two choices do jump: the shortest exit from a deep
///     penetration, and the pair of faces or edges of two boxes.
///   - Features number the points of a pair; they are part of the key for warm starts.
#pragma once

#include "sim/geometry/shapes.h"

namespace taut::sim {

/// Contact point. The unit normal points from the second shape to the first.
struct TouchPoint {
  /// Midway between both surfaces; for surfaces of the terrain, on the surface of the shape [m].
  double point[3];
  double normal[3];
  double gap_m;   ///< Negative: penetration.
  int feature;    ///< Less than kMaxPointsPerPair; stable while the shapes slide.
  double when_s;  ///< Time from now at which point and normal are valid; 0 except for swept_test.h.
};

/// Maximum size of the contact manifold of a pair, sufficient for the features below.
inline constexpr int kMaxPointsPerPair = 13;

/// Each `Touch` fills `out` (kMaxPointsPerPair entries) with the points whose gaps are below
/// `margin_m`, and returns their number.
///
/// Features: 0: closest points; 1, 2: ends of the overlap of capsules at an angle of less than 30
/// degrees.
int Touch(const RoundShape& a, const RoundShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0, 1: ends (a sphere has one); 2: centerline point nearest to the box; 3..8:
/// intersections of the centerline with the planes of the box faces.
int Touch(const RoundShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..3: corners of a face; 4..11: points where its edges cross the four sides of the
/// other box's face; 12: crossing edges, or a nearer corner outside of the face.
int Touch(const BoxShape& a, const BoxShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0, 1: ends (a sphere has one); 2: centerline point nearest to the hull; 3..12: points
/// where the centerline enters and leaves the Voronoi region of an edge.
int Touch(const RoundShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..12, by place. Larger manifolds are reduced (contact_reduction.h).
int Touch(const BoxShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;
int Touch(const HullShape& a, const HullShape& b, double margin_m, TouchPoint* out) noexcept;

/// Features: 0..2 and 3..5: contacts at both ends (a sphere has one), sorted by their normals;
/// 6..12: sharp edges and corners at the flank, by the seventh of the rod's length.
int Touch(const RoundShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;

/// Returns the features of an end as a bit mask.
constexpr unsigned FeaturesOfEnd(int end) { return 7u << (3 * end); }

struct NearParts;
/// Like Touch, without the features `elsewhere`: ends that another shape of the body also has.
/// `kept`: cache of near parts (surface_parts.h), or null; the bits do not depend on it.
int TouchGround(const RoundShape& a, const SurfaceShape& b, double margin_m, unsigned elsewhere,
                NearParts* kept, TouchPoint* out) noexcept;

/// Features: 0..12 by place, or 0..7 for the corners of a box. Larger manifolds are reduced.
int Touch(const BoxShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;
int Touch(const HullShape& a, const SurfaceShape& b, double margin_m, TouchPoint* out) noexcept;

/// Two surfaces have no contacts, because both are static.
inline int Touch(const SurfaceShape&, const SurfaceShape&, double, TouchPoint*) noexcept {
  return 0;
}

/// Returns a lower bound of the distance between two shapes; 0 if they may touch. Exact if one
/// shape is round.
double Distance(const RoundShape& a, const RoundShape& b) noexcept;
double Distance(const RoundShape& a, const BoxShape& b) noexcept;
double Distance(const BoxShape& a, const BoxShape& b) noexcept;
double Distance(const RoundShape& a, const HullShape& b) noexcept;
inline double Distance(const SurfaceShape&, const SurfaceShape&) noexcept { return 1e300; }

/// Like Distance, but stops searching near surfaces if the distance is at least `enough_m`.
template <class A, class B>
double DistanceUpTo(const A& a, const B& b, double) noexcept {
  return Distance(a, b);
}
/// Returns a lower bound, which is not exact if two corners are nearest to each other.
double DistanceUpTo(const BoxShape& a, const HullShape& b, double enough_m) noexcept;
double DistanceUpTo(const HullShape& a, const HullShape& b, double enough_m) noexcept;
/// The result is at most the smallest gap of the points of `Touch`, and smaller than this gap by at
/// most 0.01 radius (boxes and hulls: 1e-5 of the gap). Results above `enough_m` are lower bounds.
double DistanceUpTo(const RoundShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceUpTo(const BoxShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceUpTo(const HullShape& a, const SurfaceShape& b, double enough_m) noexcept;
double DistanceToGround(const RoundShape& a, const SurfaceShape& b, double enough_m,
                        NearParts* kept) noexcept;

/// Call the functions above for shapes of any kinds, in either order, each in the frame of its
/// body.
int TouchShapes(const Shape& a, const ShapePose& at_a, const Shape& b, const ShapePose& at_b,
                double margin_m, TouchPoint* out) noexcept;
double DistanceOfShapes(const Shape& a, const ShapePose& at_a, const Shape& b,
                        const ShapePose& at_b, double enough_m = 1e300) noexcept;

}  // namespace taut::sim
