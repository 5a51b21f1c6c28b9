/// Contact of a cable with rods (docs/theory/cables.md, section 6). The straight parts of the path
/// pass a rod on one side of its axis. A later change of side reveals a crossing at any speed.
#pragma once

#include "sim/cables/cable_edges.h"
#include "sim/data/rows.h"
#include "sim/geometry/line_crossing.h"

namespace taut::sim {

/// Conjunction and disjunction of masks, or of the bools of a single number.
TAUT_INLINE bool Both(bool a, bool b) noexcept { return a && b; }
TAUT_INLINE bool Either(bool a, bool b) noexcept { return a || b; }
template <class M>
TAUT_INLINE M Both(const M& a, const M& b) noexcept {
  return a & b;
}
template <class M>
TAUT_INLINE M Either(const M& a, const M& b) noexcept {
  return a | b;
}

template <class W>
TAUT_INLINE Vec3 PlaceOf(const V3<W>& p, int lane) noexcept {
  return {p.x[lane], p.y[lane], p.z[lane]};
}

/// Pose of a body before the middle of the step, extrapolated backward at constant velocity.
template <class W>
struct BodyThen {
  V3<W> way, half_turn;  ///< Displacement since; half the reverse rotation (tangent).
  W scale;

  BodyThen(const BodyWork<W>& body, W ago) noexcept
      : way(ago * body.v0), half_turn((W::Splat(-0.5) * ago) * body.w0) {
    scale = W::Splat(2.0) / (W::Splat(1.0) + Dot(half_turn, half_turn));
  }
  /// Rotates a body-fixed vector.
  V3<W> Turned(const V3<W>& v) const noexcept {
    return v + scale * Cross(half_turn, v + Cross(half_turn, v));
  }
};

/// Places the rods of a cable for the following functions. `ago`: time before the middle of the
/// step [s]; null: 0.
template <class W>
void PlaceRods(const View& m, const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
               const W* ago) noexcept {
  for (int i = 0; i < touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[touch.first_rod + i];
    const M3<W>& R = work.bodies[rod.body].R;
    const V3<W> center = R * simd::Splat3<W>(rod.center_P), axis = R * simd::Splat3<W>(rod.axis_P);
    RodLine<W>& line = work.rod_lines[i];
    line = {s.pos[rod.body] + center, axis};
    if (ago == nullptr) continue;
    const BodyThen<W> then(work.bodies[rod.body], *ago);
    line = {s.pos[rod.body] - then.way + then.Turned(center), then.Turned(axis)};
  }
}

/// Position of a rod relative to the nearest straight part of the path.
template <class S>
struct RodPass {
  S side;  ///< -1 or 1; 0: no part crosses the rod in projection.
  S part;  ///< Number of that part.
  S off2;  ///< Squared distance of the axis from it [m^2].

  static RodPass None() noexcept {
    using C = Constant<S>;
    return {C::Of(0.0), C::Of(0.0), C::Of(1e300)};
  }
};

/// Adds a straight part in the lanes `is`.
template <class V, class S, class M>
TAUT_INLINE void LookAtPart(const V& from, const V& to, const V& center, const V& axis, S half,
                            int part, M is, RodPass<S>& pass) noexcept {
  using C = Constant<S>;
  const Crossing<V> x = CrossingOf(from, to, center, axis);
  const S off2 = x.across * x.across / Max(x.norm2, C::Of(1e-300));
  const auto nearer = is & CrossWithin(x, half) & (off2 < pass.off2);
  pass.side = Select(nearer, Select(x.across < C::Of(0.0), C::Of(-1.0), C::Of(1.0)), pass.side);
  pass.part = Select(nearer, C::Of(part), pass.part);
  pass.off2 = Select(nearer, off2, pass.off2);
}

/// Side of a rod without contact, and part of the path, as one number; 0: unknown (row touch_side).
template <class S>
TAUT_INLINE S SideOfPart(S side, S part) noexcept {
  return side * (part + Constant<S>::Of(1.0));
}

/// Change of a rod's side against the stored one.
template <class S>
struct Pressed {
  decltype(S() < S()) same;     ///< The part is the stored one or its neighbor.
  decltype(S() < S()) through;  ///< It has changed sides;
  decltype(S() < S()) inside;   ///< it is inside the rod.
};

/// Parts of a looped path pass a rod on different sides, and the nearest part changes as the rod
/// moves. So only one part is compared; close to a bend, also the next one, which is on the same
/// side there.
template <class S>
TAUT_INLINE Pressed<S> PressedBy(const RodPass<S>& pass, S known, double radius_m) noexcept {
  using C = Constant<S>;
  constexpr double kClose = 4.0;  ///< Twice the radius, squared.
  const S zero = C::Of(0.0), one = C::Of(1.0), radius2 = C::Of(radius_m * radius_m);
  const S apart = Abs(pass.part + one - Abs(known));
  const auto follows = Both(apart < C::Of(1.5), pass.off2 < C::Of(kClose) * radius2);
  const auto same = Both(!(pass.side * known == zero), Either(apart < C::Of(0.5), follows));
  return {same, pass.side * known < zero, pass.off2 < radius2};
}

/// Returns the updated side of a rod without contact. It is stored only outside the rod: a cable
/// that enters a rod past its end passes through it, because wrapping at once would make its length
/// jump. It is reset once the cable is deep inside.
template <class S>
TAUT_INLINE S SideNext(const RodPass<S>& pass, S known, double radius_m) noexcept {
  using C = Constant<S>;
  constexpr double kDeep = 0.25;  ///< Half the radius, squared.
  const Pressed<S> pressed = PressedBy(pass, known, radius_m);
  const auto holds =
      pressed.same & !pressed.through & !(pass.off2 < C::Of(kDeep * radius_m * radius_m));
  const S now = SideOfPart(pass.side, pass.part);
  return Select(pressed.inside & !holds, C::Of(0.0), now);
}

/// Returns the lanes in which a cable may have come to touch a rod, among lanes where it has been
/// `free` (straight from end to end). In the other free lanes, updates the sides of the rods.
template <class W>
MaskOf<W> MayTouchRods(const View& m, const Rows<W>& s, const Scratch<W>& work,
                       const TouchTable& touch, const V3<W>& from, const V3<W>& to,
                       MaskOf<W> free) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5);
  const auto all = MaskOf<W>::Splat(true);
  auto touches = MaskOf<W>::Splat(false);
  const V3<W> way = to - from, middle = half * (from + to);
  const W half_way = half * Sqrt(Dot(way, way)) + W::Splat(touch.radius_m);
  int body = -1;
  auto near = MaskOf<W>::Splat(false);
  for (int i = 0; i < touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[touch.first_rod + i];
    W& next = work.rod_sides[i];
    if (rod.body != body) {
      body = rod.body;
      const V3<W> apart = s.pos[body] - middle;
      const W reach = half_way + W::Splat(m.bound_m[body]);
      near = free & (Dot(apart, apart) < reach * reach);
    }
    if (!Any(near)) {
      next = zero;
      continue;
    }
    const M3<W>& R = work.bodies[body].R;
    RodPass<W> pass = RodPass<W>::None();
    LookAtPart(from, to, s.pos[body] + R * simd::Splat3<W>(rod.center_P),
               R * simd::Splat3<W>(rod.axis_P), W::Splat(rod.half_m), 0, all, pass);
    const W known = s.touch_side[touch.first_rod + i];
    const Pressed<W> pressed = PressedBy(pass, known, rod.radius_m);
    touches = touches | (near & pressed.same & (pressed.through | pressed.inside));
    // Unknown for a rod out of reach: the result must not depend on other lanes.
    next = Select(near, SideNext(pass, known, rod.radius_m), zero);
  }
  // The full check starts from the stored sides.
  const auto write = free & !touches;
  for (int i = 0; i < touch.rod_count; ++i) {
    W& side = s.touch_side[touch.first_rod + i];
    side = Select(write, work.rod_sides[i], side);
  }
  return touches;
}

/// A cable may wind around a rod by any number of turns.
inline constexpr double kAnyTurns = 1e300;

/// Returns the key of a rod, which differs from the keys of all edges.
TAUT_INLINE double KeyOf(const TouchRodTable& rod) noexcept { return kEdgesOfShape * rod.shape; }

/// Resets the stored side of the rod with that key (if it is a rod) in one lane: the cable passes
/// through it until it has left.
template <class W>
void ForgetSide(const View& m, const Rows<W>& s, const TouchTable& touch, double key,
                int lane) noexcept {
  for (int i = touch.first_rod; i < touch.first_rod + touch.rod_count; ++i) {
    if (KeyOf(m.touch_rods[i]) == key) s.touch_side[i].Set(lane, 0.0);
  }
}

template <class W>
TAUT_INLINE Vec3 TurnedBy(const M3<W>& R, const double* p, int lane) noexcept {
  const auto row = [&](const V3<W>& r) {
    return r.x[lane] * p[0] + r.y[lane] * p[1] + r.z[lane] * p[2];
  };
  return {row(R.r0), row(R.r1), row(R.r2)};
}

/// Straight parts of one lane's path; part k is before bend k.
struct StraightParts {
  FreeSpan span[kMostBends + 1];
  int count;
};

/// Finds the rod with the deepest penetration in one lane, as FindEdge does for edges.
template <class W>
bool FindRod(const View& m, const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
             const StraightParts& parts, int lane, const double* taken, int taken_count, bool any,
             BendFound* found, int* part) noexcept {
  bool is_new = false;
  for (int i = 0; i < touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[touch.first_rod + i];
    const double known = s.touch_side[touch.first_rod + i][lane];
    if (known == 0.0 || IsTaken(KeyOf(rod), taken, taken_count)) continue;
    const Vec3 center = PlaceOf(work.rod_lines[i].center, lane);
    const Vec3 axis = PlaceOf(work.rod_lines[i].axis, lane);
    RodPass<double> pass = RodPass<double>::None();
    for (int k = 0; k < parts.count; ++k) {
      LookAtPart(parts.span[k].from, parts.span[k].to, center, axis, rod.half_m, k, true, pass);
    }
    const Pressed<double> pressed = PressedBy(pass, known, rod.radius_m);
    if (!pressed.same || !(pressed.through || pressed.inside)) continue;
    const double off = Sqrt(pass.off2);
    const double depth = rod.radius_m + (pressed.through ? off : -off);
    if ((any || is_new) && !(depth > found->depth_m)) continue;
    const double around = known < 0.0 ? 1.0 : -1.0;  // towards the previous side
    const int nearest = static_cast<int>(pass.part);
    const BendPlace place{KeyOf(rod), 0, center, axis, kAnyTurns, rod.half_m, rod.radius_m};
    if (!CanLieOn(place, parts.span[nearest], around)) continue;
    is_new = true;
    *part = nearest;
    const double* const c = rod.center_P;
    const double* const u = rod.axis_P;
    *found = {{KeyOf(rod),
               rod.body,
               {c[0], c[1], c[2]},
               {u[0], u[1], u[2]},
               kAnyTurns,
               rod.half_m,
               rod.radius_m},
              depth,
              around};
  }
  return is_new;
}

}  // namespace taut::sim
