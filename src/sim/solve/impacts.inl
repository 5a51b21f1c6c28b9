/// Impacts: restitution of contacts and joint limits, all together in the step of the impact
/// (docs/theory/contact.md, section 3). The problem is solved without rebounds, then again with the
/// rebounds of the contacts that took part. Contacts that get a force from these rebounds take part
/// in the next solve. If friction at several contacts adds energy, the result is interpolated
/// toward the first solution as far as necessary. The interpolated result is admissible, because
/// the problem is linear between two solutions and cones are convex.
///
/// A Problem is a solver with this interface:
///   ForEach(f)       f(law, first row) for all constraints
///   u(), l()         velocities and impulses, one per row
///   impacts()        memory for impacts
///   MeasureBefore()  impacts().before <- velocities at the start of the step
///   SolveAgain(M)    solves again from l, in the lanes M
///   Update()         updates all other variables to l
#pragma once

#include "sim/data/island.h"

namespace taut::sim {

template <class Law>
inline constexpr bool kRebounds = requires(Law& law) {
  law.rebound;
};

/// Work of the constraints at a fraction x of the way from the first to the second solution: c0 +
/// c1 x + c2 x^2.
template <class Num>
struct WorkOfImpacts {
  Num c0 = Num::Splat(0.0), c1 = Num::Splat(0.0), c2 = Num::Splat(0.0);

  void Add(Num before, Num u1, Num l1, Num u2, Num l2) noexcept {
    const Num l = l2 - l1, u = u2 - u1, sum = before + u1;
    c0 += l1 * sum;
    c1 += l * sum + l1 * u;
    c2 += l * u;
  }
  /// Returns the largest admissible fraction; 1 if the second solution is admissible.
  Num Share() const noexcept {
    constexpr double kRounding = 1e-12;
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    const Num limit = Max(c0, zero), most = Abs(c0) + Abs(c1) + Abs(c2);
    const auto gains = c0 + c1 + c2 > limit + Num::Splat(kRounding) * most;
    if (!Any(gains)) return one;
    const Num root = Sqrt(Max(c1 * c1 - Num::Splat(4.0) * c2 * (c0 - limit), zero));
    const Num share = (root - c1) / Max(c2 + c2, Num::Splat(1e-300));
    return Select(gains, Max(Min(share, one), zero), one);
  }
};

/// Computes the rebound speed of each contact in case of an impact, from the velocities under the
/// impulses of the previous step. Returns false if no contact would rebound in any lane.
template <class Problem>
bool ExpectImpacts(Problem& p) noexcept {
  bool any = false;
  p.ForEach([&](auto& law, int row) {
    if constexpr (kRebounds<decltype(law)>) {
      any = law.ExpectRebound(p.u()[row]) || any;
    }
  });
  return any;
}

/// Applies impacts after a solve in `lanes`. Returns the lanes with an impact.
template <class Num, class Problem, class M>
M SolveImpacts(Problem& p, int rows, M lanes) noexcept {
  constexpr int kMaxRounds = 4;
  const ImpactRows<Num> kept = p.impacts();
  auto hit = M::Splat(false);
  for (int round = 0; round < kMaxRounds; ++round) {
    auto fresh = M::Splat(false);
    // Later rounds apply only to lanes with an earlier impact.
    const auto may = round > 0 ? lanes & hit : lanes;
    p.ForEach([&](auto& law, int row) {
      if constexpr (kRebounds<decltype(law)>)
        fresh = fresh | law.Rebound(p.u() + row, p.l() + row, may, round > 0);
    });
    if (!Any(fresh)) break;
    for (int i = 0; round == 0 && i < rows; ++i) kept.u[i] = p.u()[i], kept.l[i] = p.l()[i];
    hit = hit | fresh;
    p.SolveAgain(fresh);
  }
  if (!Any(hit)) return hit;
  p.MeasureBefore();
  WorkOfImpacts<Num> work;
  p.ForEach([&](auto& law, int row) {
    if constexpr (kRebounds<decltype(law)>) {
      for (int i = row; i < row + LawOf<decltype(law)>::kRows; ++i) {
        work.Add(kept.before[i], kept.u[i], kept.l[i], p.u()[i], p.l()[i]);
      }
    }
  });
  const Num share = work.Share();
  const auto back = hit & (share < Num::Splat(1.0));
  if (!Any(back)) return hit;
  for (int i = 0; i < rows; ++i) {
    Num &u = p.u()[i], &l = p.l()[i];
    u = Select(back, kept.u[i] + share * (u - kept.u[i]), u);
    l = Select(back, kept.l[i] + share * (l - kept.l[i]), l);
  }
  p.Update();
  return hit;
}

}  // namespace taut::sim
