/// Constraint of a stiff cable, whose tension is solved together with the contacts
/// (docs/theory/cables.md, eq. 8-11; docs/theory/contact.md, eq. 14, 17).
///
/// The unknowns are rates: 2 * stretch / step. z0 is the known value at the start of the step, z =
/// end - u the value at its end. u is the rate at which the cable shortens after the step.
///
///   l = phi (spring (p + p0) + damper (z - z0 + winding)),   0 <= l <= upper
///   p = max(z, 0), p0 = max(z0, 0), phi = (p - p0) / (z - z0): taut fraction of the change
///
/// If the cable is taut at both ends of the step, the law is a line: l = base - gain u. If it is
/// slack at both ends, l = 0. Otherwise, the law is a curve that decreases with u. A row alone
/// therefore has one solution, the root of a quadratic equation.
#pragma once

#include "sim/constraint/links.h"

namespace taut::sim {

template <class Num>
struct CableRow {
  using Number = Num;
  using Mask = MaskOf<Num>;
  static constexpr int kRows = 1;
  /// Curves with a slope below this fraction of the line's slope count as constant.
  static constexpr double kFlat = 1e-12;

  Num live;            ///< 1 in lanes in which this cable is stiff, otherwise 0.
  Num base, gain;      ///< Line: impulse at u = 0 [N s], and decrease per u [kg].
  Num start, end;      ///< z0, and the u at which the stretch at the end of the step is 0 [m/s].
  Num spring, damper;  ///< gain = spring + damper [kg].
  Num winding;         ///< Twice the rate of the rest length [m/s].
  Num inv_gain;        ///< 1 / gain [1/kg].
  Num A;               ///< Inverse effective mass along the cable [1/kg].
  Num inverse;         ///< 1 / (1 + gain A).
  Num upper;           ///< Largest impulse [N s].
  Num l[1];            ///< Impulse [N s].
  int link_count;
  Link<Num, 1>* links;

  struct Branch {
    Mask inside;   ///< Neither slack nor at the limit.
    Mask crosses;  ///< The cable becomes slack or taut within the step.
    Num lower;     ///< 1 where the cable is slack.
    Num wish;      ///< Impulse before the limits [N s].
    Num slope;     ///< Decrease of `wish` per u [kg].
  };
  static bool Same(const Branch& a, const Branch& b) noexcept {
    constexpr double kNearly = 1e-6;
    return Any(a.inside) == Any(b.inside) && Any(a.crosses) == Any(b.crosses) &&
           !Any(Abs(a.lower - b.lower) > Num::Splat(0.5)) &&
           !Any(Abs(a.slope - b.slope) > Num::Splat(kNearly) * (a.slope + b.slope));
  }

  /// Sets the law. `from`: z0; `to`: z at the end of the step if the length does not change. The
  /// file comment defines all rates.
  TAUT_INLINE void SetLaw(Num from, Num to, Num spring_kg, Num damper_kg, Num wound) noexcept {
    start = from, end = to;
    spring = spring_kg, damper = damper_kg;
    winding = wound;
    gain = spring + damper;
    base = spring * (end + start) + damper * ((end - start) + winding);
  }
  /// Sets the law of a spring and a damper that are always taut.
  void SetLine(Num at_rest, Num slope) noexcept {
    start = Num::Splat(1.0), end = Num::Splat(1e300);
    spring = gain = slope;
    damper = winding = Num::Splat(0.0);
    base = at_rest;
  }
  /// Copies law, limit and impulse of another row, each value through `pick`.
  template <class Other, class F>
  TAUT_INLINE void TakeLaw(const CableRow<Other>& from, const F& pick) noexcept {
    live = pick(from.live);
    base = pick(from.base), gain = pick(from.gain);
    start = pick(from.start), end = pick(from.end);
    spring = pick(from.spring), damper = pick(from.damper);
    winding = pick(from.winding);
    upper = pick(from.upper);
    l[0] = pick(from.l[0]);
  }

  void FinishMasses() noexcept {
    A = Num::Splat(0.0);
    for (int i = 0; i < link_count; ++i) AddCoupling(links[i], links[i], &A);
    inverse = Num::Splat(1.0) / (Num::Splat(1.0) + gain * A);
    inv_gain = Num::Splat(1.0) / gain;
  }

  /// Returns the spring part of the impulse of a step that ends with z.
  TAUT_INLINE Num SpringImpulse(Num z) const noexcept {
    const Num zero = Num::Splat(0.0), sum = Max(z, zero) + Max(start, zero);
    const auto crosses = Crosses(start > zero, z > zero);
    return spring * Select(crosses, sum * Share(z, sum), sum);
  }

  Branch Project(const Num* u, const Num* center, Num e, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0), soft = e * A;
    const Num free = (end - u[0]) + soft * center[0];  // z without the impulse of the cable
    const auto was = start > zero;
    Branch b;
    b.slope = gain;
    b.wish = (base - gain * u[0] + (gain * soft) * center[0]) / (one + gain * soft);
    Num z = free - soft * Min(Max(b.wish, zero), upper);
    b.crosses = (was & !(z > zero)) | ((!was) & (free > zero));
    b.wish = Select(was | b.crosses, b.wish, zero);
    if (Any(b.crosses)) {
      b.wish = Select(b.crosses, Select(was, Leaving(free, soft), Entering(free, soft)), b.wish);
      z = free - soft * Min(Max(b.wish, zero), upper);
      b.slope = Select(b.crosses, SlopeAt(z, was), b.slope);
    }
    out[0] = Min(Max(b.wish, zero), upper);
    Judge(b, Mask::Splat(true));
    return b;
  }
  void ProjectFrozen(const Num* u, const Num* center, Num e, const Num*, Num* out) const noexcept {
    Project(u, center, e, out);
  }
  void Derivative(const Branch& b, Num e, Num* g) const noexcept {
    g[0] = Select(b.inside, b.slope / (Num::Splat(1.0) + b.slope * e * A), Num::Splat(0.0));
  }

  void Stiffen(const Branch&, Num, Num*) const noexcept {}

  TAUT_INLINE Branch BranchOf(const Num* u, const Num*) const noexcept {
    const Num zero = Num::Splat(0.0), z = end - u[0];
    const auto was = start > zero, is = z > zero;
    Branch b;
    b.crosses = Crosses(was, is);
    b.wish = Select(was | is, base - gain * u[0], zero);
    b.slope = gain;
    if (Any(b.crosses)) {
      const Num p = Max(z, zero), p0 = Max(start, zero), phi = Share(z, p + p0);
      const Num curve = spring * (phi * (p + p0)) + damper * ((p - p0) + phi * winding);
      b.wish = Select(b.crosses, curve, b.wish);
      b.slope = Select(b.crosses, SlopeAt(z, was), b.slope);
    }
    Judge(b, live > zero);
    return b;
  }

  TAUT_INLINE Num Residual(const Branch& b, const Num*, const Num* l_now) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    const Num wish = Min(Max(b.wish, zero), upper);
    Num alone = inverse;
    if (Any(b.crosses)) alone = Select(b.crosses, one / (one + b.slope * A), alone);
    return Select(live > zero, Abs(wish - l_now[0]) * alone * A, zero);
  }

  TAUT_INLINE void Linearize(const Branch& b, const Num*, const Num* l_now, Num,
                             LinearLaw<Num, 1>& out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    Num inv_slope = inv_gain;
    if (Any(b.crosses)) inv_slope = Select(b.crosses, one / b.slope, inv_slope);
    out.A[0][0] = Select(b.inside, inv_slope, one);
    out.S[0][0] = Select(b.inside, one, zero);
    out.r[0] =
        Select(b.inside, inv_slope * (b.wish - l_now[0]), Min(Max(b.wish, zero), upper) - l_now[0]);
    out.r[0] = Select(live > zero, out.r[0], zero);
  }

  void SolveAlone(const Num* u, Num* l_now) const noexcept {
    Num out;
    Project(u, l_now, Num::Splat(1.0), &out);
    l_now[0] = out;
  }
  void Clamp(Num* l_now) const noexcept { l_now[0] = Min(Max(l_now[0], Num::Splat(0.0)), upper); }

 private:
  TAUT_INLINE static Mask Crosses(Mask was, Mask is) noexcept {
    return (was & !is) | ((!was) & is);
  }

  /// Returns phi for a cable that becomes slack or taut. `above`: p + p0, one of which is 0.
  TAUT_INLINE Num Share(Num z, Num above) const noexcept {
    return above / Max(Abs(z - start), Num::Splat(1e-300));
  }
  /// Returns dl/dz of the curve. A winding motor and the damper may make it negative where l < 0,
  /// which is outside the limits.
  TAUT_INLINE Num SlopeAt(Num z, Mask was) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    const Num way = Max(Abs(z - start), Num::Splat(1e-300));
    const Num phi = Min((Max(z, zero) + Max(start, zero)) / way, one);
    const Num bend = Select(was, phi, one - phi) / way;
    const Num of_spring = phi * Select(was, phi, one + (one - phi));
    const Num of_damper = Select(was, zero, one) + winding * bend;
    return Max(spring * of_spring + damper * of_damper, zero);
  }
  /// Solves l = curve(free - soft l) for a taut cable that becomes slack:
  ///   l (z0 - z) = z0 (spring z0 + damper (z - z0 + winding))
  TAUT_INLINE Num Leaving(Num free, Num soft) const noexcept {
    const Num zero = Num::Splat(0.0), tiny = Num::Splat(1e-300);
    const Num half_b = Num::Splat(0.5) * ((start - free) + damper * soft * start);
    const Num c = start * (spring * start + damper * ((free - start) + winding));
    const Num root = Sqrt(Max(half_b * half_b + soft * c, zero));
    return Select(half_b > zero, c / Max(half_b + root, tiny), (root - half_b) / Max(soft, tiny));
  }
  /// Solves l = curve(free - soft l) for a slack cable that becomes taut; the smaller root, because
  /// z > 0:
  ///   l (z - z0) = z (gain z + damper (winding - z0))
  TAUT_INLINE Num Entering(Num free, Num soft) const noexcept {
    const Num zero = Num::Splat(0.0), half = Num::Splat(0.5);
    const Num rest = damper * (winding - start);
    const Num a = soft * (Num::Splat(1.0) + gain * soft);
    const Num half_b = half * ((free - start) + soft * ((gain + gain) * free + rest));
    const Num c = free * (gain * free + rest);
    const Num root = Sqrt(Max(half_b * half_b - a * c, zero));
    return c / Max(half_b + root, Num::Splat(1e-300));
  }
  TAUT_INLINE void Judge(Branch& b, Mask on) const noexcept {
    const Num zero = Num::Splat(0.0);
    b.inside = on & (b.wish > zero) & (b.wish < upper) & (b.slope > Num::Splat(kFlat) * gain);
    b.lower = Select(b.wish > zero, zero, Num::Splat(1.0));
  }
};

}  // namespace taut::sim
