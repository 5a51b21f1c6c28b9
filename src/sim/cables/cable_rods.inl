/// Contact of a cable with rods (docs/theory/cables.md, section 6). For each rod, the side of its
/// axis on which the path passes is stored. A change of side reveals a crossing at any speed.
#pragma once

#include "sim/cables/cable_edges.h"
#include "sim/data/rows.h"
#include "sim/geometry/line_crossing.h"

namespace taut::sim {

/// Conjunction and disjunction of SIMD masks or bools.
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

/// Pose of a body at a time before the middle of the step, extrapolated at constant velocity.
template <class W>
struct BodyThen {
  V3<W> way, half_turn;  ///< Displacement since that time, and half the rotation vector back to it.
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

/// Computes the axes of the rods of a cable for the following functions. `ago`: time before the
/// middle of the step [s]; null: 0.
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

/// Position of a rod relative to the nearest straight part of a path.
template <class S>
struct RodPass {
  S side;  ///< -1 or 1; 0: no part crosses the rod in the projection.
  S part;  ///< Index of the nearest part.
  S off2;  ///< Squared distance from the rod's axis to this part [m^2].

  static RodPass None() noexcept {
    using C = Constant<S>;
    return {C::Of(0.0), C::Of(0.0), C::Of(1e300)};
  }
};

/// Compares a straight part with the nearest one so far, in the lanes `is`.
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

/// Returns the side of a rod without contact and the index of the path part, encoded in one number
/// (row touch_side). 0: unknown.
template <class S>
TAUT_INLINE S SideOfPart(S side, S part) noexcept {
  return side * (part + Constant<S>::Of(1.0));
}

/// Comparison of a rod's position with its stored side.
template <class S>
struct Pressed {
  decltype(S() < S()) same;     ///< The part is the stored part or its neighbor.
  decltype(S() < S()) through;  ///< The path has changed to the other side of the axis.
  decltype(S() < S()) inside;   ///< The path is inside the rod.
};

/// Compares a rod's position with its stored side. Parts of a looped path pass a rod on different
/// sides, and the nearest part may change as the rod moves. Therefore only the stored part is
/// compared. Near a bend, the next part is compared, too, since it is on the same side there.
template <class S>
TAUT_INLINE Pressed<S> PressedBy(const RodPass<S>& pass, S known, double radius_m) noexcept {
  using C = Constant<S>;
  constexpr double kClose = 4.0;  ///< Square of twice the radius.
  const S zero = C::Of(0.0), one = C::Of(1.0), radius2 = C::Of(radius_m * radius_m);
  const S apart = Abs(pass.part + one - Abs(known));
  const auto follows = Both(apart < C::Of(1.5), pass.off2 < C::Of(kClose) * radius2);
  const auto same = Both(!(pass.side * known == zero), Either(apart < C::Of(0.5), follows));
  return {same, pass.side * known < zero, pass.off2 < radius2};
}

/// Returns the updated side of a rod without contact. A side is stored only while the cable is
/// outside the rod. A cable that enters over the end of a rod passes through it, because wrapping
/// would make its length jump. A side is deleted if the cable is deep inside.
template <class S>
TAUT_INLINE S SideNext(const RodPass<S>& pass, S known, double radius_m) noexcept {
  using C = Constant<S>;
  constexpr double kDeep = 0.25;  ///< Square of half the radius.
  const Pressed<S> pressed = PressedBy(pass, known, radius_m);
  const auto holds =
      pressed.same & !pressed.through & !(pass.off2 < C::Of(kDeep * radius_m * radius_m));
  const S now = SideOfPart(pass.side, pass.part);
  return Select(pressed.inside & !holds, C::Of(0.0), now);
}

/// Returns the lanes in which a cable without bends (`free`) may touch a rod. In the other free
/// lanes, updates the sides of the rods.
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
    // 0 (unknown) if the rod is out of reach, so that the result does not depend on other lanes
    next = Select(near, SideNext(pass, known, rod.radius_m), zero);
  }
  // The full check needs the stored sides.
  const auto write = free & !touches;
  for (int i = 0; i < touch.rod_count; ++i) {
    W& side = s.touch_side[touch.first_rod + i];
    side = Select(write, work.rod_sides[i], side);
  }
  return touches;
}

/// Rods have no largest wrap angle.
inline constexpr double kAnyTurns = 1e300;

/// Returns the key of a rod; it differs from all keys of edges.
TAUT_INLINE double KeyOf(const TouchRodTable& rod) noexcept { return kEdgesOfShape * rod.shape; }

/// Deletes the stored side of the rod with this key (if it is a rod) in one lane. The cable then
/// passes through the rod until it is outside again.
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

/// Straight parts of the path of one lane; part k ends at bend k.
struct StraightParts {
  FreeSpan span[kMostBends + 1];
  int count;
};

/// Finds the rod with the deepest penetration in one lane, like FindEdge for edges.
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
    const double around = known < 0.0 ? 1.0 : -1.0;  // toward the previous side
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
