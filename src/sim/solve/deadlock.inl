/// Deadlocks and inconsistent contacts: how Newton's method recovers from contradictory rows
/// (docs/theory/contact.md, section 5).
///
/// Contacts that stick along a kinematic loop (a rod jammed across a groove, a slab on rollers)
/// have more rows than the bodies have degrees of freedom. Small differences between gaps or arcs
/// make the biases of these rows contradict each other. No velocities satisfy all rows, and each
/// Newton step adds the same impulses along the loop. If these impulses eventually open a contact
/// or make it slide, the solver jumps directly to this point. Otherwise the equations are
/// inconsistent: proximal rounds (proximal.inl) find the velocities with the smallest error, and
/// the laws of the loop are relaxed by this error.
#pragma once

#include "sim/data/island.h"

namespace taut::sim {

template <class Law>
inline constexpr bool kRelaxes = requires(Law& law) {
  law.Relax(nullptr);
};

/// Relaxes inconsistent laws at m.l, m.u and the branches of their residual: changes their biases
/// so that the laws are satisfied. The relaxation is applied only if no bias changes by more than
/// kDisagreementMPerS and the island is then solved. Returns false if nothing has changed.
template <class Num, class P>
bool Relax(Island<Num, P>& island, double tolerance, SolverWork& work) noexcept {
  auto& m = island.m;
  Num most = Num::Splat(0.0);
  const auto each = [&](const auto& f) {
    island.pools.ForEach([&](auto& law, auto& branch, int row, int) {
      if constexpr (kRelaxes<decltype(law)>) f(law, branch, row);
    });
  };
  each([&](auto& law, auto& branch, int row) {
    law.Disagreement(branch, m.u + row, m.l + row, m.projected + row);
    for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) {
      most = Max(Abs(m.projected[row + r]), most);
    }
  });
  if (!(most[0] <= kDisagreementMPerS)) return false;
  each([&](auto& law, auto&, int row) { law.Relax(m.projected + row); });
  if (island.Residual(m.u, m.l)[0] <= tolerance) {
    if (most[0] > work.relaxation) work.relaxation = most[0];
    return true;
  }
  each([&](auto& law, auto&, int row) {
    for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) {
      m.projected[row + r] = -m.projected[row + r];
    }
    law.Relax(m.projected + row);
  });
  return false;
}

/// Finds the end of a deadlock after a Newton step from the velocities m.u2 and the impulses
/// m.projected to m.u and m.l.
template <class Num, class P>
class DeadlockBreaker {
  /// A smaller relative change of the error counts as no change.
  static constexpr double kStays = 1e-2;
  /// Larger steps, relative to the largest impulse, are rejected.
  static constexpr double kFar = 1e3;

 public:
  explicit DeadlockBreaker(Island<Num, P>& island) noexcept : island_(island), m_(island.m) {}

  /// Moves m.l to the first point at which a law leaves its branch, and returns true. Returns false
  /// if there is no deadlock or no such point.
  bool Break() noexcept {
    if (!IsDeadlock()) return false;
    // m.projected <- impulses that each step adds
    for (int i = 0; i < island_.rows; ++i) m_.projected[i] = m_.l[i] - m_.projected[i];
    Num reach = Num::Splat(1e300), size = Num::Splat(0.0), added = size;
    ForEach([&](auto& law, auto& branch, int row) {
      for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) {
        size = Max(Abs(m_.l[row + r]), size);
        added = Max(Abs(m_.projected[row + r]), added);
      }
      reach = Min(law.Reach(branch, m_.l + row, m_.projected + row), reach);
    });
    if (!Any(reach * added < Num::Splat(kFar) * size)) return false;
    const Num beyond = Num::Splat(1.0 + 1e-9) * reach;
    for (int i = 0; i < island_.rows; ++i) m_.l[i] += beyond * m_.projected[i];
    return true;
  }

 private:
  template <class F>
  void ForEach(F&& f) noexcept {
    island_.pools.ForEach([&](auto& law, auto& branch, int row, int) {
      if constexpr (kRelaxes<decltype(law)>) f(law, branch, row);
    });
  }

  /// Returns whether the laws have a small error that the step did not change.
  bool IsDeadlock() noexcept {
    Num most = Num::Splat(0.0), changed = most;
    ForEach([&](auto& law, auto& branch, int row) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      Num now[R], before[R];
      law.Miss(branch, m_.u + row, now);
      law.Miss(branch, m_.u2 + row, before);
      for (int r = 0; r < R; ++r) {
        most = Max(Abs(now[r]), most);
        changed = Max(Abs(now[r] - before[r]), changed);
      }
    });
    return most[0] > 0 && most[0] <= kDisagreementMPerS && changed[0] <= kStays * most[0];
  }

  Island<Num, P>& island_;
  IslandMemory<Num>& m_;
};

}  // namespace taut::sim
