/// Cable path: length, rate and pulls of a cable along its attachments (docs/theory/cables.md, eq.
/// 2, 3). Used by the step, sensors, starts, stiffness bounds and statics, with V3<W> in the step
/// and Vec3 elsewhere. No standard library.
///
/// A path is a sequence of points on bodies, and of the spans between them. Results: its length,
/// its rate, and the pull on each point per unit of tension.
///
/// A point is an attachment, or one of the two points at which a cable reaches and leaves a wheel
/// (cable_wheel.h). The arc between these two adds to the length but exerts no pull. The arc does
/// not affect the rate, because both points slide in the directions of their spans
/// (docs/theory/cables.md, eq. 14).
#pragma once

#include "math/scalar.h"

namespace taut {

template <class V>
struct PathPoint {
  V p;    ///< Position [m], in one frame for the whole path.
  V v;    ///< Velocity [m/s]; needed for rates only.
  V arm;  ///< Position relative to the origin of its body [m]; needed for torques only.
  V u;    ///< Unit vector from the previous point to this one.
};

/// Length of a path or of a part of it, and its exact rate.
template <class V>
struct PathLength {
  using S = decltype(V::x);
  S l = Constant<S>::Of(0.0), dl = Constant<S>::Of(0.0);
};

/// Adds the span between two adjacent points and sets `to.u`. For coincident points, which have no
/// direction, the small minimum length gives u ~ 0.
template <class V>
TAUT_INLINE void AddSpan(const PathPoint<V>& from, PathPoint<V>& to, PathLength<V>& path) noexcept {
  using S = typename PathLength<V>::S;
  const V d = to.p - from.p;
  const S length = Sqrt(Dot(d, d));
  to.u = (Constant<S>::Of(1.0) / Max(length, Constant<S>::Of(1e-12))) * d;
  path.l = path.l + length;
  path.dl = path.dl + Dot(to.u, to.v - from.v);
}

/// Returns length and rate of a path without wheels, and sets the directions `u`.
template <class V>
TAUT_INLINE PathLength<V> MeasurePath(int count, PathPoint<V>* points) noexcept {
  PathLength<V> path;
  for (int i = 1; i < count; ++i) AddSpan(points[i - 1], points[i], path);
  return path;
}

/// Returns length and rate of a path through points at `place(i)`, without storing directions.
template <class V, class Place>
PathLength<V> MeasureThrough(int count, const Place& place) noexcept {
  PathLength<V> path;
  PathPoint<V> from{};
  for (int i = 0; i < count; ++i) {
    PathPoint<V> to{};
    to.p = place(i);
    if (i > 0) AddSpan(from, to, path);
    from = to;
  }
  return path;
}

/// Returns the force on point `i` per unit of tension: u_i+1 - u_i.
template <class V>
TAUT_INLINE V PullAt(int count, const PathPoint<V>* points, int i) noexcept {
  const auto zero = Constant<typename PathLength<V>::S>::Of(0.0);
  V pull{zero, zero, zero};
  if (i > 0) pull = pull - points[i].u;
  if (i + 1 < count) pull = pull + points[i + 1].u;
  return pull;
}

/// Adds the forces and torques of a tension to its bodies. `body(i)` returns the body data of point
/// i: `force`, and `torque` about the origin of the body.
template <class V, class Body>
TAUT_INLINE void PullBodies(int count, const PathPoint<V>* points,
                            typename PathLength<V>::S tension, const Body& body) noexcept {
  for (int i = 1; i < count; ++i) {
    const V f = tension * points[i].u;
    auto& a = body(i - 1);
    auto& b = body(i);
    a.force = a.force + f;
    a.torque = a.torque + Cross(points[i - 1].arm, f);
    b.force = b.force - f;
    b.torque = b.torque - Cross(points[i].arm, f);
  }
}

}  // namespace taut
