/// Second stage of an island's solve: Gauss-Seidel sweeps, which solve one constraint after the
/// other exactly (docs/theory/contact.md, eq. 23). Sweeps converge slowly if loads pass through
/// many bodies, but need no good initial guess.
#pragma once

#include "sim/constraint/links.h"
#include "sim/data/island.h"

namespace taut::sim {

/// Improves m.l. On entry and return, m.v and m.u are the velocities of m.l. Returns the residual
/// [m/s].
template <class Num, class P>
double Sweep(Island<Num, P>& island, int count) noexcept {
  auto& m = island.m;
  for (int sweep = 0; sweep < count; ++sweep) {
    island.pools.ForEach([&](auto& law, auto&, int row, int) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      const int rows = RowsOf(law);
      Num u[R], l[R];
      for (int r = 0; r < rows; ++r) u[r] = Num::Splat(0.0), l[r] = m.l[row + r];
      for (int i = 0; i < law.link_count; ++i) {
        const Twist<Num> t = island.Load(m.v + kDofs * law.links[i].body);
        AddVelocity(law.links[i], t.v, t.w, u);
      }
      law.SolveAlone(u, l);
      Num change[R];
      for (int r = 0; r < rows; ++r) change[r] = l[r] - m.l[row + r], m.l[row + r] = l[r];
      for (int i = 0; i < law.link_count; ++i) {
        Num* const at = m.v + kDofs * law.links[i].body;
        Twist<Num> t = island.Load(at);
        Push(law.links[i], change, t.v, t.w);
        island.Store(t, at);
      }
    });
  }
  return island.Judge();
}

}  // namespace taut::sim
