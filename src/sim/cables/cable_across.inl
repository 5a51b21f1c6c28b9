/// Capstan friction across a cable, along the axis of an edge or rod (docs/theory/cables.md,
/// section 7). The cable has no mass, so a bend slides immediately until friction can hold it.
#pragma once

#include "sim/cables/cable_rods.inl"
#include "sim/cables/cable_wrapping.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Returns the axial force of both parts of a bend, divided by the tension. This force is zero if
/// the cable is straight on the unrolled cylinder, and decreases with `along`.
TAUT_INLINE double AsideAt(const Tangents<Vec3>& way, double along) noexcept {
  const Rises<double> rise = RisesAt(way, along);
  return rise.behind / Sqrt(1.0 + rise.behind * rise.behind) -
         rise.before / Sqrt(1.0 + rise.before * rise.before);
}

/// Returns the position at which AsideAt is `goal`, a value between zero and AsideAt(from).
TAUT_INLINE double SlideTo(const Tangents<Vec3>& way, double from, double goal) noexcept {
  constexpr int kMostRounds = 100;
  constexpr double kFirstWayM = 1e-6, kFarM = 1e3, kEnough = 1e-14;
  const double start = AsideAt(way, from) - goal, sense = start > 0.0 ? 1.0 : -1.0;
  double a = from, fa = start, b = from, fb = start;
  for (double step = kFirstWayM; fb * start > 0.0; step = 2.0 * step) {
    if (step > kFarM) return from;
    a = b, fa = fb;
    b = from + sense * step, fb = AsideAt(way, b) - goal;
  }
  for (int round = 0; round < kMostRounds && Abs(fb) > kEnough && a != b; ++round) {
    const double c = b - fb * ((b - a) / (fb - fa)), fc = AsideAt(way, c) - goal;
    if (fc * fb <= 0.0) {
      a = b, fa = fb;
    } else {
      fa = 0.5 * fa;  // regula falsi, Illinois variant (no stagnation)
    }
    b = c, fb = fc;
  }
  return b;
}

/// Returns a unit vector normal to the axis of a bend, fixed to the body of the bend.
template <class W>
V3<W> MarkOfBend(const View& m, const Scratch<W>& work, const WrapPointNumbers<W>& bend) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const W* const u = bend.axis;
  const auto x_least = (Abs(u[0]) < Abs(u[1])) & (Abs(u[0]) < Abs(u[2]));
  const V3<W> axis{u[0], u[1], u[2]};
  const V3<W> least{Select(x_least, one, zero), Select(x_least, zero, one), zero};
  V3<W> mark = Cross(axis, least);
  for (int lane = 0; lane < W::kLanes; ++lane) {
    const int body = BodyOfBend(m, bend, lane);
    if (body == m.body_count) continue;
    const Vec3 p = PlaceOf(mark, lane);
    const double in_P[3] = {p.x, p.y, p.z};
    SetPlace(mark, TurnedBy(work.bodies[body].R, in_P, lane), lane);
  }
  return mark;
}

/// Returns the difference of two angles, -pi..pi.
template <class W>
TAUT_INLINE W TurnFrom(W from, W to) noexcept {
  const W turned = to - from;
  return turned - W::Splat(2 * kPi) * Round(W::Splat(0.5 / kPi) * turned);
}

/// Returns the displacement on the surface of a wheel [m] for a rotation about its axis, positive
/// along the cable.
template <class W>
TAUT_INLINE W WayAround(const Wheel<V3<W>>& wheel, W turn) noexcept {
  return Select(wheel.angle < W::Splat(0.0), -turn, turn) * wheel.radius;
}

/// Derivatives of the path length with respect to the axial position of a held bend's middle.
struct Lean {
  /// Half the difference of the derivatives of the parts before and after the middle [1].
  double apart;
  /// Axial displacement per circumferential displacement at which no work is done (eq. 22a).
  double walk;
};
inline Lean LeanOf(const Tangents<Vec3>& way, const Rises<double>& rise) noexcept {
  constexpr double kShortestM = 1e-9, kLeast = 1e-6, kMostTimes = 2.0;
  const double lp = Max(way.lp, kShortestM), lq = Max(way.lq, kShortestM), w = 0.5 * way.around;
  const double bent = 0.5 * w * (1.0 / lp - 1.0 / lq) / (1.0 + 0.5 * w * (1.0 / lp + 1.0 / lq));
  const double cos_before = 1.0 / Sqrt(1.0 + rise.before * rise.before);
  const double cos_behind = 1.0 / Sqrt(1.0 + rise.behind * rise.behind);
  const double sin_before = rise.before * cos_before, sin_behind = rise.behind * cos_behind;
  const double sin_on = rise.on / Sqrt(1.0 + rise.on * rise.on);
  const double longer = sin_before * (1.0 - bent) - sin_behind * (1.0 + bent) + 2.0 * bent * sin_on;
  const double mean = (sin_before + sin_behind) / (cos_before + cos_behind);
  const double most = 1.0 + kMostTimes * Abs(mean);
  const double exact = Abs(longer) > kLeast ? (cos_behind - cos_before) / longer : mean;
  return {0.5 * (sin_before + sin_behind + bent * (sin_behind - sin_before)),
          Max(Min(exact, most), -most)};
}

/// Slides a bend of one lane if friction cannot hold it. Returns the displacement across the cable
/// [m]. `moved`: circumferential displacement of the arc's middle on the wheel since the previous
/// step [m]. During this displacement, the bend moves in the mean direction of the cable, like a
/// rope on a rotating drum (eq. 22a).
template <class W>
double SlideBend(const View& m, const Rows<W>& s, const TouchTable& touch, Scratch<W>& work,
                 const Vec3& p, const Vec3& q, int k, int lane, double moved) noexcept {
  /// Largest used fraction of the friction limit, so that some slip remains.
  constexpr double kSteepest = 0.995;
  /// Largest axial motion in a step, relative to the shorter straight part. A larger motion sets a
  /// status bit.
  constexpr double kMostWalk = 0.1;
  const CableTable& cable = m.cables[touch.cable];
  W& along = s.slip_along[cable.first_slip + k];
  AcrossWork<W>& across = work.across[cable.first_slip + k];
  const Wheel<V3<W>>& from = work.wheels[k];
  const Wheel<Vec3> wheel{PlaceOf(from.center, lane),
                          PlaceOf(from.axis, lane),
                          from.radius[lane],
                          from.angle[lane],
                          0,
                          0.0,
                          0.0,
                          0.0};
  const Tangents<Vec3> way = LayOn(wheel, p, q);
  const double straight = way.zp + (way.zq - way.zp) * ((way.lp + 0.5 * way.around) /
                                                        Max(way.lp + way.around + way.lq, 1e-300));
  const double before_n = s.span_tension[cable.first_span + k][lane];
  const double behind_n = s.span_tension[cable.first_span + k + 1][lane];
  const double mean_n = 0.5 * (before_n + behind_n);
  double old = along[lane];
  const bool taut = before_n > 0.0 && behind_n > 0.0;
  if (!(old < kNotHeld) || !taut) {
    along.Set(lane, straight);
    across.aside.Set(lane, 0.0), across.drift.Set(lane, 0.0);
    across.lean.Set(lane, LeanOf(way, RisesAt(way, straight)).apart);
    return old < kNotHeld ? Abs(straight - old) : 0.0;
  }
  if (moved != 0.0) {
    const double walk_m = moved * LeanOf(way, RisesAt(way, old)).walk;
    old = old + walk_m;
    if (Abs(walk_m) > kMostWalk * Min(way.lp, way.lq)) work.WalkedFar(touch.cable, lane);
  }
  const double hold = touch.friction * Max(way.theta, 0.0), aside = AsideAt(way, old);
  double now = old;
  if (Abs(aside) > hold) {
    now = SlideTo(way, old, aside > 0.0 ? hold : -hold);
    W& loss = s.slip_loss[cable.first_slip + k];
    loss.Set(lane, loss[lane] + 0.5 * mean_n * (Abs(aside) + hold) * Abs(now - old));
  }
  along.Set(lane, now);
  const double left = Max(Min(aside, hold), -hold);
  const double part = hold > 0.0 ? Max(Min(left / hold, kSteepest), -kSteepest) : 0.0;
  across.aside.Set(lane, left);
  across.drift.Set(lane, part / Sqrt(1.0 - part * part));
  across.far.Set(lane, straight - now);
  across.lean.Set(lane, LeanOf(way, RisesAt(way, now)).apart);
  return Abs(now - old);
}

/// Drift of bends (eq. 23): slip along the cable moves a bend against the friction force until the
/// path is straight.
template <class W, class Tag>
void DriftAcross(const Rows<W>& s, const Scratch<W>& work, const CableTable& cable,
                 const Capstan<Tag>& found, double area_n, int lane) noexcept {
  for (int i = 0; i + 1 < found.count; ++i) {
    const int slip = cable.first_slip + i;
    const AcrossWork<W>& across = work.across[slip];
    const double tension = 0.5 * (found.tension[i] + found.tension[i + 1]);
    const double way = across.drift[lane] * Abs(found.slip[i]) * (1.0 + tension / area_n);
    if (way == 0.0) continue;
    const double far = across.far[lane], moves = Abs(way) < Abs(far) ? way : far;
    s.slip_along[slip].Set(lane, s.slip_along[slip][lane] + moves);
    const double work_j = tension * Abs(across.aside[lane] * moves);
    s.slip_loss[slip].Set(lane, s.slip_loss[slip][lane] + work_j);
  }
}

/// Slides all bends of a cable across the cable, and updates the path.
template <class W>
[[gnu::noinline]] void SlideAcross(const View& m, const Rows<W>& s, Scratch<W>& work,
                                   const TouchTable& touch, int used,
                                   AttachmentWork<W>* ends) noexcept {
  constexpr int kMostRounds = 20;
  constexpr double kStillM = 1e-13;
  const CableTable& cable = m.cables[touch.cable];
  const W zero = W::Splat(0.0);
  for (int k = 0; k < kMostBends; ++k) work.across[cable.first_slip + k] = {zero, zero, zero, zero};
  const WrapPointNumbers<W>* const bends = &s.bend[touch.first_bend];
  W moved[kMostBends];
  for (int k = 0; k < used; ++k) {
    const Wheel<V3<W>>& wheel = work.wheels[k];
    const W known = s.slip_place[cable.first_slip + k];
    const W turn = TurnFrom(known, MiddleOf(wheel, MarkOfBend(m, work, bends[k]), ends));
    moved[k] = Select(known < W::Splat(kNotHeld), WayAround(wheel, turn), zero);
  }
  auto slides = s.halted[0] == zero;
  for (int round = 0; round < kMostRounds && Any(slides); ++round) {
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (!slides[lane]) continue;
      double slid = 0.0;
      int before = 0;
      for (int k = 0; k < used; ++k) {
        if (!(work.wheels[k].theta[lane] > 0.0)) continue;
        int behind = k + 1;
        while (behind < used && !(work.wheels[behind].theta[lane] > 0.0)) ++behind;
        const Vec3 p = PlaceOf(ends[before].p, lane), q = PlaceOf(ends[2 * behind + 1].p, lane);
        const double way = round == 0 ? moved[k][lane] : 0.0;
        slid = Max(slid, SlideBend(m, s, touch, work, p, q, k, lane, way));
        before = 2 + 2 * k;
      }
      slides.Set(lane, slid > kStillM);
    }
    LayOverBends(m, s, touch, used, ends, work.wheels, PoseNow(s, work));
  }
}

}  // namespace taut::sim
