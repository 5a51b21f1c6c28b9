/// Cable wrapping around wheels: cylinders on bodies in the path of the cable
/// (docs/theory/cables.md, section 4). The path is the shortest one for its winding. The winding
/// (number and direction of turns) follows from one angle per wheel, which is tracked from step to
/// step.
#pragma once

#include "math/angle.h"
#include "math/cable_path.h"

namespace taut {

template <class V>
struct Wheel {
  using S = decltype(V::x);
  V center, axis;  ///< In the frame of the path; the axis is a unit vector.
  S radius;        ///< Radius to the center line of the cable [m].
  S before;        ///< `angle` in the previous step; it changes by at most half a turn.
  /// Index of the path point where the cable reaches the wheel; it leaves at the next point.
  int at;
  // Results:
  S angle;  ///< Angle about the axis from the previous to the next point, with all turns [rad].
  S theta;  ///< Wrap angle [rad]; <= 0 without contact.
  S arc;    ///< Length of the arc [m].
};

/// Selects one of two points, lane by lane.
template <class M, class V>
TAUT_INLINE V Pick(M which, const V& yes, const V& no) noexcept {
  return {Select(which, yes.x, no.x), Select(which, yes.y, no.y), Select(which, yes.z, no.z)};
}

/// Points at which a cable from `p` to `q` reaches and leaves a wheel.
template <class V>
struct Tangents {
  using S = typename Wheel<V>::S;
  V a, b;
  S angle, theta, arc;
  /// Positions along the axis, and lengths across it: before, on and behind the wheel [m].
  S zp, zq, lp, around, lq;
};

/// Value for an arc that is free along the axis, without friction.
inline constexpr double kNotHeld = 1e300;

/// Slopes of a cable along the axis of a wheel, per length across it. Where friction holds the
/// middle of the arc at `along`, the slope changes at both tangent points.
template <class S>
struct Rises {
  S before, on, behind;
};
template <class V, class S = typename Wheel<V>::S>
TAUT_INLINE Rises<S> RisesAt(const Tangents<V>& way, S along) noexcept {
  using C = Constant<S>;
  constexpr double kShortestM = 1e-9;
  const S half = C::Of(0.5), one = C::Of(1.0), w = half * way.around;
  const S lp = Max(way.lp, C::Of(kShortestM)), lq = Max(way.lq, C::Of(kShortestM));
  const S mean = half * ((along - way.zp) / lp + (way.zq - along) / lq);
  const S on = mean / (one + half * w * (one / lp + one / lq));
  return {(along - on * w - way.zp) / lp, on, (way.zq - along - on * w) / lq};
}

/// Lays a cable around a wheel. The path is a straight line on the unrolled cylinder, unless
/// friction holds it at `along` (if not null). Points inside the cylinder count as on its surface.
template <class V, class S = typename Wheel<V>::S>
TAUT_INLINE Tangents<V> LayOn(const Wheel<V>& wheel, const V& p, const V& q,
                              const S* along = nullptr) noexcept {
  using C = Constant<S>;
  const S zero = C::Of(0.0), one = C::Of(1.0), tiny = C::Of(1e-300), R = wheel.radius;
  const V to_p = p - wheel.center, to_q = q - wheel.center;
  const S zp = Dot(to_p, wheel.axis), zq = Dot(to_q, wheel.axis);
  const V rp = to_p - zp * wheel.axis, rq = to_q - zq * wheel.axis;
  const V across_p = Cross(wheel.axis, rp), across_q = Cross(wheel.axis, rq);
  const S principal = Atan2(Dot(across_p, rq), Dot(rp, rq));
  Tangents<V> found;
  found.angle = principal + C::Of(2 * kPi) * Round(C::Of(0.5 / kPi) * (wheel.before - principal));
  const S sp2 = Max(Dot(rp, rp), tiny), sq2 = Max(Dot(rq, rq), tiny);
  const S lp = Sqrt(Max(sp2 - R * R, zero)), lq = Sqrt(Max(sq2 - R * R, zero));
  found.theta = Abs(found.angle) - Atan2(lp, R) - Atan2(lq, R);
  const S side = Select(found.angle < zero, zero - one, one);
  const S around = R * Max(found.theta, zero);
  S rise = (zq - zp) / Max(lp + around + lq, tiny);
  S za = zp + rise * lp, zb = zq - rise * lq;
  found.zp = zp, found.zq = zq, found.lp = lp, found.around = around, found.lq = lq;
  if (along != nullptr) {
    const auto held = *along < C::Of(kNotHeld);
    const Rises<S> bent = RisesAt(found, Select(held, *along, zero));
    rise = Select(held, bent.on, rise);
    za = Select(held, zp + bent.before * lp, za), zb = Select(held, zq - bent.behind * lq, zb);
  }
  found.arc = around * Sqrt(one + rise * rise);
  found.a = wheel.center + za * wheel.axis + (R / sp2) * (R * rp + (side * lp) * across_p);
  found.b = wheel.center + zb * wheel.axis + (R / sq2) * (R * rq - (side * lq) * across_q);
  return found;
}

/// Returns the next path point after wheel k that the cable touches, at the latest `to`.
template <class V>
TAUT_INLINE V Behind(const PathPoint<V>* points, const Wheel<V>* wheels, int k, int last,
                     const V& to) noexcept {
  const auto zero = Constant<typename Wheel<V>::S>::Of(0.0);
  V q = to;
  for (int i = last - 1; i > k; --i) q = Pick(wheels[i].theta > zero, points[wheels[i].at].p, q);
  return q;
}

/// Lays consecutive wheels first..last-1 between the points before and after them. `begun`: points
/// and wrap angles contain an initial guess; otherwise the iteration starts without contact.
template <class V, class S = typename Wheel<V>::S>
void LayOnNeighbours(PathPoint<V>* points, Wheel<V>* wheels, int first, int last, const S* along,
                     bool begun) noexcept {
  using C = Constant<S>;
  constexpr int kMostRounds = 200;
  /// Convergence tolerance relative to the distance of the end points.
  constexpr double kStill = 1e-15;
  const S zero = C::Of(0.0);
  const V from = points[wheels[first].at - 1].p, to = points[wheels[last - 1].at + 2].p;
  for (int k = first; k < last; ++k) {
    wheels[k].arc = zero, wheels[k].angle = wheels[k].before;
    if (begun) continue;
    wheels[k].theta = zero;
    points[wheels[k].at].p = points[wheels[k].at + 1].p = from;
  }
  S busy = C::Of(1.0);
  for (int round = 0; round < (last - first > 1 ? kMostRounds : 1) && Any(busy > zero); ++round) {
    S moved = zero;
    for (int k = first; k < last; ++k) {
      V p = from;
      for (int i = first; i < k; ++i) {
        p = Pick(wheels[i].theta > zero, points[wheels[i].at + 1].p, p);
      }
      const V q = Behind(points, wheels, k, last, to);
      const Tangents<V> now = LayOn(wheels[k], p, q, along == nullptr ? nullptr : along + k);
      V& a = points[wheels[k].at].p;
      V& b = points[wheels[k].at + 1].p;
      const V way_a = now.a - a, way_b = now.b - b, all = q - p;
      const S way2 = Dot(way_a, way_a) + Dot(way_b, way_b);
      const auto still = way2 < C::Of(kStill * kStill) * Dot(all, all);
      const auto off = (!(wheels[k].theta > zero)) & (!(now.theta > zero));
      moved = Select(still | off, moved, busy);
      const auto on = busy > zero;
      a = Pick(on, now.a, a), b = Pick(on, now.b, b);
      wheels[k].theta = Select(on, now.theta, wheels[k].theta);
      wheels[k].arc = Select(on, now.arc, wheels[k].arc);
      wheels[k].angle = Select(on, now.angle, wheels[k].angle);
    }
    busy = moved;
  }
  // Without contact, the pulls on both points of the wheel cancel, wherever these are on the
  // straight line.
  for (int k = first; k < last; ++k) {
    const V half = C::Of(0.5) * (points[wheels[k].at - 1].p + Behind(points, wheels, k, last, to));
    V& a = points[wheels[k].at].p;
    V& b = points[wheels[k].at + 1].p;
    const auto on = wheels[k].theta > zero;
    a = Pick(on, a, half), b = Pick(on, b, half);
  }
}

/// Computes the points at which the cable reaches and leaves wheels; other points are given. A path
/// neither starts nor ends at a wheel. `along`, if not null: per wheel, the axial position [m],
/// relative to the center, at which friction holds the middle of the arc, or kNotHeld. `begun`: see
/// LayOnNeighbours.
template <class V, class S = typename Wheel<V>::S>
void LayOnWheels(PathPoint<V>* points, int wheel_count, Wheel<V>* wheels, const S* along = nullptr,
                 bool begun = false) noexcept {
  int first = 0;
  while (first < wheel_count) {
    int last = first + 1;
    while (last < wheel_count && wheels[last].at == wheels[last - 1].at + 2) ++last;
    LayOnNeighbours(points, wheels, first, last, along, begun);
    first = last;
  }
}

/// Computes an initial guess for consecutive wheels: points on the correct side of each axis, near
/// the crossing with the line to the end, at most `half` from the center [m]. Angles about an axis
/// are measured between neighboring points; the previous angle determines their full turns. With
/// the cable's ends as initial guess, a looped cable would lose contact with its wheel. `has`: 1
/// for existing wheels, otherwise 0.
template <class V, class S = typename Wheel<V>::S>
void BeginOnWheels(PathPoint<V>* points, int count, Wheel<V>* wheels, const S* half,
                   const S* has) noexcept {
  using C = Constant<S>;
  const S zero = C::Of(0.0), one = C::Of(1.0), tiny = C::Of(1e-300);
  const auto unit = [&](const V& v) { return (one / Sqrt(Max(Dot(v, v), tiny))) * v; };
  const V to = points[2 * count + 1].p;
  V from = points[0].p;
  for (int k = 0; k < count; ++k) {
    Wheel<V>& wheel = wheels[k];
    const V way = to - from, across = Cross(way, wheel.axis);
    const S along = Dot(Cross(wheel.center - from, way), across);
    const S place = along / Max(Dot(across, across), tiny);
    const auto is = has[k] > zero;
    from = Pick(is, wheel.center + Max(Min(place, half[k]), zero - half[k]) * wheel.axis, from);
    points[1 + 2 * k].p = Pick(is, from, to);
    wheel.theta = has[k];
  }
  from = points[0].p;
  for (int k = 0; k < count; ++k) {
    const Wheel<V>& wheel = wheels[k];
    const V here = points[1 + 2 * k].p, next = k + 1 < count ? points[3 + 2 * k].p : to;
    const V way = unit(here - from) + unit(next - here);
    const S side = Select(wheel.before < zero, zero - one, one);
    points[1 + 2 * k].p = points[2 + 2 * k].p =
        here + (side * wheel.radius) * unit(Cross(way, wheel.axis));
    from = here;
  }
}

/// Returns the middle of the arc on a wheel as an angle about its axis [rad], measured from `mark`,
/// a direction normal to the axis. The middle separates the material of the spans before and after
/// the wheel. Without contact, returns the angle of the point nearest to the axis on the straight
/// line between the path points before and after the wheel.
template <class V>
TAUT_INLINE typename Wheel<V>::S MiddleOf(const Wheel<V>& wheel, const V& mark,
                                          const PathPoint<V>* points) noexcept {
  using S = typename Wheel<V>::S;
  using C = Constant<S>;
  const S zero = C::Of(0.0), one = C::Of(1.0);
  const V across = Cross(wheel.axis, mark);
  const V from = points[wheel.at - 1].p - wheel.center;
  const V way = points[wheel.at + 2].p - points[wheel.at - 1].p;
  const V arrives = points[wheel.at].p - wheel.center;
  const S px = Dot(mark, from), py = Dot(across, from), dx = Dot(mark, way), dy = Dot(across, way);
  const S nearest = (zero - (px * dx + py * dy)) / Max(dx * dx + dy * dy, C::Of(1e-300));
  const S t = Max(Min(nearest, one), zero);
  const auto on = wheel.theta > zero;
  const S side = Select(wheel.angle < zero, zero - one, one);
  return Atan2(Select(on, Dot(across, arrives), py + t * dy),
               Select(on, Dot(mark, arrives), px + t * dx)) +
         Select(on, C::Of(0.5) * side * wheel.theta, zero);
}

/// Returns length and rate of a path with given points, and sets the directions `u`.
template <class V>
TAUT_INLINE PathLength<V> MeasurePath(int count, PathPoint<V>* points, int wheel_count,
                                      const Wheel<V>* wheels) noexcept {
  const auto zero = Constant<typename Wheel<V>::S>::Of(0.0);
  PathLength<V> path;
  int wheel = 0;
  for (int i = 1; i < count; ++i) {
    if (wheel < wheel_count && i == wheels[wheel].at + 1) {
      points[i].u = {zero, zero, zero};
      path.l = path.l + wheels[wheel++].arc;
    } else {
      AddSpan(points[i - 1], points[i], path);
    }
  }
  return path;
}

}  // namespace taut
