/// Cable path: length, rate and pulls of a cable along its attachments (docs/theory/cables.md, eq.
/// 2, 3). Shared by the step, its sensors, the start, the bounds of stiffness and the statics: for
/// V3<W> of the step and for Vec3, without the standard library.
///
/// A path is a sequence of points that belong to bodies, and the spans between them. It provides
/// its length, its rate, and the pull on each point per unit of tension.
///
/// A point is an attachment, or one of the two points where a cable arrives at a wheel and leaves
/// it (cable_wheel.h). Between those two there is no span that pulls: the arc adds only to the
/// length. The rate is correct without it, since the points slide along the spans that they end
/// (docs/theory/cables.md, eq. 14).
#pragma once

#include "math/scalar.h"

namespace taut {

template <class V>
struct PathPoint {
  V p;    ///< Position; one frame for the whole path [m].
  V v;    ///< Velocity; only for rates [m/s].
  V arm;  ///< From the origin of its body; only for torques [m].
  V u;    ///< Direction of the span from the previous point, per unit of tension.
};

/// Length of a path or a part of it, and its exact rate.
template <class V>
struct PathLength {
  using S = decltype(V::x);
  S l = Constant<S>::Of(0.0), dl = Constant<S>::Of(0.0);
};

/// Adds the span between two neighbors, and fills in `to.u`. Coincident points have no direction;
/// the small length makes u = d / tiny ~ 0.
template <class V>
TAUT_INLINE void AddSpan(const PathPoint<V>& from, PathPoint<V>& to, PathLength<V>& path) noexcept {
  using S = typename PathLength<V>::S;
  const V d = to.p - from.p;
  const S length = Sqrt(Dot(d, d));
  to.u = (Constant<S>::Of(1.0) / Max(length, Constant<S>::Of(1e-12))) * d;
  path.l = path.l + length;
  path.dl = path.dl + Dot(to.u, to.v - from.v);
}

/// Returns length and rate of a path without wheels; fills in the directions.
template <class V>
TAUT_INLINE PathLength<V> MeasurePath(int count, PathPoint<V>* points) noexcept {
  PathLength<V> path;
  for (int i = 1; i < count; ++i) AddSpan(points[i - 1], points[i], path);
  return path;
}

/// Returns the same for points at `place(i)`, without storing directions.
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

/// Adds the forces and torques of a tension to its bodies. `body(i)` returns the sums of point i's
/// body: its `force`, and its `torque` about the origin of the arms.
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
