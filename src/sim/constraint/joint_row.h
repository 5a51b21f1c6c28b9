/// Joint constraint: one direction in which a joint acts (docs/theory/joints.md, eq. 1).
///
///   u + give l  = target   where  lower < l < upper,
///               >= target  where  l = lower,   <= target  where  l = upper;
///
///   u: relative velocity of the two bodies in this direction, after the step
///
/// Constrained direction: no limits; the compliance is a tiny fraction of the inverse effective
/// mass, relative to the previous impulse (joints.md, eq. 3). Joint limit: only pushes. Dry
/// friction: target 0 between the limits. Spring and damper: `give` is their velocity per impulse.
#pragma once

#include "sim/constraint/links.h"

namespace taut::sim {

/// Compliance of constrained rows, relative to their inverse effective masses.
inline constexpr double kHeldCompliance = 1e-7;

template <class Num>
struct JointRow {
  using Number = Num;
  using Mask = MaskOf<Num>;
  static constexpr int kRows = 1;
  static constexpr double kNoLimit = 1e300;

  Num live;          ///< 1 in lanes in which the row acts, otherwise 0.
  Num target;        ///< Target velocity [m/s].
  Num give;          ///< Velocity per impulse [1/kg], >= 0.
  Num lower, upper;  ///< Limits of the impulse [N s], lower <= 0 <= upper.
  Num A;             ///< Inverse effective mass of the row [1/kg].
  Num l[1];          ///< Impulse [N s].
  Num rebound;       ///< Rebound speed of an impact at a joint limit [m/s]; 0: no rebound.
  bool compliant;    ///< `give` is the compliance of eq. 3, not of a spring.
  int link_count;
  Link<Num, 1> links[2];

  struct Branch {
    Mask inside;  ///< The impulse is between its limits.
    Num beyond;   ///< -1: below the limits; 1: above; 0: between.
    Num impulse;  ///< Limit that applies outside of the range.
  };
  static bool Same(const Branch& a, const Branch& b) noexcept {
    return !Any(Abs(a.beyond - b.beyond) > Num::Splat(0.5));
  }

  /// Copies another row without its links, each value through `pick`.
  template <class Other, class F>
  TAUT_INLINE void TakeLaw(const JointRow<Other>& from, const F& pick) noexcept {
    live = pick(from.live);
    target = pick(from.target), give = pick(from.give);
    lower = pick(from.lower), upper = pick(from.upper);
    A = pick(from.A), l[0] = pick(from.l[0]);
    rebound = pick(from.rebound);
    compliant = from.compliant;
  }
  /// Converts the row from velocities to displacements: constrained rows stay closed, springs and
  /// friction have no effect, and the free side of a joint limit stays free.
  void Hold() noexcept {
    const Num zero = Num::Splat(0.0);
    auto free = upper < Num::Splat(kNoLimit);
    if (!compliant) free = free | (give > zero);
    target = give = l[0] = rebound = zero;
    compliant = false;
    lower = Select(free, zero, lower), upper = Select(free, zero, upper);
  }

  void FinishMasses() noexcept {
    A = Num::Splat(0.0);
    for (int i = 0; i < link_count; ++i) AddCoupling(links[i], links[i], &A);
  }

  Branch Project(const Num* u, const Num* center, Num e, Num* out) const noexcept {
    const Num soft = e * A;
    return Judge((target - u[0] + soft * center[0]) / (give + soft), out);
  }
  void ProjectFrozen(const Num* u, const Num* center, Num e, const Num*, Num* out) const noexcept {
    Project(u, center, e, out);
  }
  void Derivative(const Branch& b, Num e, Num* g) const noexcept {
    g[0] = Select(b.inside, Num::Splat(1.0) / (give + e * A), Num::Splat(0.0));
  }
  void Stiffen(const Branch&, Num, Num*) const noexcept {}

  Branch BranchOf(const Num* u, const Num* l_now) const noexcept {
    Num out;
    return Judge((target - u[0] + A * l_now[0]) / (give + A), &out);
  }
  Num Residual(const Branch& b, const Num* u, const Num* l_now) const noexcept {
    const Num inside = Abs(target - u[0] - give * l_now[0]);
    return Select(b.inside, inside, (give + A) * Abs(b.impulse - l_now[0]));
  }
  void Linearize(const Branch& b, const Num* u, const Num* l_now, Num e,
                 LinearLaw<Num, 1>& out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    // The compliance of a constrained row serves as e, so the Newton step solves its law.
    const Num soft = e * A;
    out.A[0][0] = Select(b.inside, compliant ? Max(give, soft) : give + soft, one);
    out.S[0][0] = Select(b.inside, one, zero);
    out.r[0] = Select(b.inside, target - u[0] - give * l_now[0], b.impulse - l_now[0]);
  }

  void SolveAlone(const Num* u, Num* l_now) const noexcept {
    Num out;
    Project(u, l_now, Num::Splat(1.0), &out);
    l_now[0] = out;
  }
  void Clamp(Num* l_now) const noexcept { l_now[0] = Min(Max(l_now[0], lower), upper); }

  /// Returns whether the joint limit rebounds. impacts.inl has computed the speed before.
  bool ExpectRebound(Num) const noexcept { return Any(rebound > Num::Splat(0.0)); }
  Mask Rebound(const Num*, const Num* l_now, Mask lanes, bool) noexcept {
    const Num zero = Num::Splat(0.0);
    const auto now = lanes & (l_now[0] > zero) & (rebound > zero) & (target < rebound);
    target = Select(now, rebound, target);
    return now;
  }

 private:
  Branch Judge(Num wish, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    out[0] = Min(Max(wish, lower), upper);
    Branch b;
    b.inside = (wish > lower) & (wish < upper);
    b.beyond = Select(wish > lower, Select(wish < upper, zero, one), zero - one);
    b.impulse = out[0];
    return b;
  }
};

}  // namespace taut::sim
