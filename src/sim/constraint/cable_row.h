/// A kind of constraint: a cable whose tension is found together with the contacts
/// (docs/theory/cables.md, eq. 8-11; docs/theory/contact.md, eq. 14, 17).
///
///   l = base - gain u,  0 <= l <= upper;   u: the rate at which it shortens after the step
/// The law is a spring and a damper by itself: its compliance is 1 / gain.
#pragma once

#include "sim/constraint/links.h"

namespace taut::sim {

template <class Num>
struct CableRow {
  using Number = Num;
  static constexpr int kRows = 1;

  Num live;        ///< 1 in lanes in which this cable is stiff, else 0.
  Num base, gain;  ///< Impulse at u = 0 [N s], less per u [kg].
  Num inv_gain;    ///< [1/kg]
  Num A;           ///< Inverse effective mass along the cable [1/kg].
  Num inverse;     ///< 1 / (1 + gain A).
  Num upper;       ///< Largest impulse [N s].
  Num l[1];        ///< Impulse [N s].
  int link_count;
  Link<Num, 1>* links;

  struct Branch {
    MaskOf<Num> inside;  ///< Neither slack nor at its limit.
    Num lower;           ///< 1 where it is slack.
  };
  static bool Same(const Branch& a, const Branch& b) noexcept {
    return Any(a.inside) == Any(b.inside) && !Any(Abs(a.lower - b.lower) > Num::Splat(0.5));
  }

  void FinishMasses() noexcept {
    A = Num::Splat(0.0);
    for (int i = 0; i < link_count; ++i) AddCoupling(links[i], links[i], &A);
    inverse = Num::Splat(1.0) / (Num::Splat(1.0) + gain * A);
    inv_gain = Num::Splat(1.0) / gain;
  }

  Branch Project(const Num* u, const Num* center, Num e, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0), soft = gain * e * A;
    const Num wish = (base - gain * u[0] + soft * center[0]) / (one + soft);
    out[0] = Min(Max(wish, zero), upper);
    return {(wish > zero) & (wish < upper), Select(wish > zero, zero, one)};
  }
  void ProjectFrozen(const Num* u, const Num* center, Num e, const Num*, Num* out) const noexcept {
    Project(u, center, e, out);
  }
  void Derivative(const Branch& b, Num e, Num* g) const noexcept {
    g[0] = Select(b.inside, gain / (Num::Splat(1.0) + gain * e * A), Num::Splat(0.0));
  }

  void Stiffen(const Branch&, Num, Num*) const noexcept {}

  TAUT_INLINE Branch BranchOf(const Num* u, const Num*) const noexcept {
    const Num zero = Num::Splat(0.0), wish = base - gain * u[0];
    return {(live > zero) & (wish > zero) & (wish < upper),
            Select(wish > zero, zero, Num::Splat(1.0))};
  }

  TAUT_INLINE Num Residual(const Branch&, const Num* u, const Num* l_now) const noexcept {
    const Num zero = Num::Splat(0.0);
    const Num wish = Min(Max(base - gain * u[0], zero), upper);
    return Select(live > zero, Abs(wish - l_now[0]) * inverse * A, zero);
  }

  TAUT_INLINE void Linearize(const Branch& b, const Num* u, const Num* l_now, Num,
                             LinearLaw<Num, 1>& out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    const Num wish = base - gain * u[0];
    out.A[0][0] = Select(b.inside, inv_gain, one);
    out.S[0][0] = Select(b.inside, one, zero);
    out.r[0] =
        Select(b.inside, inv_gain * (wish - l_now[0]), Min(Max(wish, zero), upper) - l_now[0]);
    out.r[0] = Select(live > zero, out.r[0], zero);
  }

  void SolveAlone(const Num* u, Num* l_now) const noexcept {
    l_now[0] += inverse * (base - gain * u[0] - l_now[0]);
    Clamp(l_now);
  }
  void Clamp(Num* l_now) const noexcept { l_now[0] = Min(Max(l_now[0], Num::Splat(0.0)), upper); }
};

}  // namespace taut::sim
