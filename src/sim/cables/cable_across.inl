/// Capstan friction across a cable, along the axis of an edge or rod (docs/theory/cables.md,
/// section 7): the cable has no mass, so a bend slides at once until friction can hold it.
#pragma once

#include "sim/cables/cable_rods.inl"
#include "sim/cables/cable_wrapping.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Returns the pull of both parts of a bend along the axis, per tension: its deviation from the
/// straight line on the unrolled cylinder. It decreases with `along`.
TAUT_INLINE double AsideAt(const Tangents<Vec3>& way, double along) noexcept {
  const Rises<double> rise = RisesAt(way, along);
  return rise.behind / Sqrt(1.0 + rise.behind * rise.behind) -
         rise.before / Sqrt(1.0 + rise.before * rise.before);
}

/// Returns the place at which AsideAt is `goal`, which is between zero and its value at `from`.
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
      fa = 0.5 * fa;  // regula falsi without stagnation (Illinois)
    }
    b = c, fb = fc;
  }
  return b;
}

/// Slides one lane's bend if friction cannot hold it. Returns the displacement [m].
template <class W>
double SlideBend(const Rows<W>& s, const CableTable& cable, Scratch<W>& work, double friction,
                 const Vec3& p, const Vec3& q, int k, int lane) noexcept {
  constexpr double kSteepest = 0.995;  ///< Share of the friction limit that keeps some slip.
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
  const double mean_n = 0.5 * (before_n + behind_n), old = along[lane];
  const bool taut = before_n > 0.0 && behind_n > 0.0;
  if (!(old < kNotHeld) || !taut) {
    along.Set(lane, straight);
    across.aside.Set(lane, 0.0), across.drift.Set(lane, 0.0);
    return old < kNotHeld ? Abs(straight - old) : 0.0;
  }
  const double hold = friction * Max(way.theta, 0.0), aside = AsideAt(way, old);
  double now = old;
  if (Abs(aside) > hold) {
    now = SlideTo(way, old, aside > 0.0 ? hold : -hold);
    along.Set(lane, now);
    W& loss = s.slip_loss[cable.first_slip + k];
    loss.Set(lane, loss[lane] + 0.5 * mean_n * (Abs(aside) + hold) * Abs(now - old));
  }
  const double left = Max(Min(aside, hold), -hold);
  const double part = hold > 0.0 ? Max(Min(left / hold, kSteepest), -kSteepest) : 0.0;
  across.aside.Set(lane, left);
  across.drift.Set(lane, part / Sqrt(1.0 - part * part));
  across.far.Set(lane, straight - now);
  return Abs(now - old);
}

/// Drift of bends (eq. 23): slip along the cable carries a bend in the direction against which
/// friction acts, until it is straight.
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

/// Slides all bends of a laid cable across, and lays the path over their new places.
template <class W>
[[gnu::noinline]] void SlideAcross(const View& m, const Rows<W>& s, Scratch<W>& work,
                                   const TouchTable& touch, int used,
                                   AttachmentWork<W>* ends) noexcept {
  constexpr int kMostRounds = 20;
  constexpr double kStillM = 1e-13;
  const CableTable& cable = m.cables[touch.cable];
  const W zero = W::Splat(0.0);
  for (int k = 0; k < kMostBends; ++k) work.across[cable.first_slip + k] = {zero, zero, zero};
  auto slides = s.halted[0] == zero;
  for (int round = 0; round < kMostRounds && Any(slides); ++round) {
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (!slides[lane]) continue;
      double moved = 0.0;
      int before = 0;
      for (int k = 0; k < used; ++k) {
        if (!(work.wheels[k].theta[lane] > 0.0)) continue;
        int behind = k + 1;
        while (behind < used && !(work.wheels[behind].theta[lane] > 0.0)) ++behind;
        const Vec3 p = PlaceOf(ends[before].p, lane), q = PlaceOf(ends[2 * behind + 1].p, lane);
        moved = Max(moved, SlideBend(s, cable, work, touch.friction, p, q, k, lane));
        before = 2 + 2 * k;
      }
      slides.Set(lane, moved > kStillM);
    }
    LayOverBends(m, s, touch, used, ends, work.wheels, PoseNow(s, work));
  }
}

}  // namespace taut::sim
