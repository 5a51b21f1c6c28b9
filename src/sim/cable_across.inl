/// Friction along the axis of what a cable has come to lie against (docs/theory/cables.md, section
/// 7): the cable has no mass, so it slides until friction can hold it, and stays there.

namespace taut::sim {

/// How far a cable's bend turns aside from the straight line on what it lies against, that is how
/// hard its two parts pull it along the axis, per tension. It falls as `along` grows.
TAUT_INLINE double AsideAt(const Tangents<Vec3>& way, double along) noexcept {
  const Rises<double> rise = RisesAt(way, along);
  return rise.behind / Sqrt(1.0 + rise.behind * rise.behind) -
         rise.before / Sqrt(1.0 + rise.before * rise.before);
}

/// Where that is `goal`, which is between zero and what it is at `from`.
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
      fa = 0.5 * fa;  // regula falsi that does not creep (Illinois)
    }
    b = c, fb = fc;
  }
  return b;
}

/// Of one lane's bend: slides if it has to. Returns how far [m].
template <class W>
double SlideBend(const Rows<W>& s, const CableTable& cable, const Scratch<W>& work, double friction,
                 const Vec3& p, const Vec3& q, int k, int lane) noexcept {
  W& along = s.slip_along[cable.first_slip + k];
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
  const double low = Min(before_n, behind_n), high = Max(before_n, behind_n), old = along[lane];
  if (!(old < kNotHeld) || !(low > 0.0)) {
    along.Set(lane, straight);
    return old < kNotHeld ? Abs(straight - old) : 0.0;
  }
  // What holds it along the cable does not hold it across.
  const double mu_theta = friction * Max(way.theta, 0.0), most = (RatioOf(mu_theta) - 1.0) * low;
  const double used = most > high - low ? (high - low) / most : 1.0;
  const double hold = mu_theta * Sqrt(1.0 - used * used);
  const double aside = AsideAt(way, old);
  if (Abs(aside) <= hold) return 0.0;
  const double now = SlideTo(way, old, aside > 0.0 ? hold : -hold), moved = Abs(now - old);
  along.Set(lane, now);
  W& loss = s.slip_loss[cable.first_slip + k];
  loss.Set(lane, loss[lane] + 0.25 * (low + high) * (Abs(aside) + hold) * moved);
  return moved;
}

/// All bends of a cable that is laid slide as far as they have to, and it is laid there.
template <class W>
[[gnu::noinline]] void SlideAcross(const View& m, const Rows<W>& s, Scratch<W>& work,
                                   const TouchTable& touch, int used,
                                   AttachmentWork<W>* ends) noexcept {
  constexpr int kMostRounds = 20;
  constexpr double kStillM = 1e-13;
  const CableTable& cable = m.cables[touch.cable];
  auto slides = s.halted[0] == W::Splat(0.0);
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
