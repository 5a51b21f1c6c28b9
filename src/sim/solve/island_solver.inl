/// Solve of one island in three stages, from fast to robust: plain Newton, Gauss-Seidel sweeps,
/// proximal rounds (docs/theory/contact.md, section 5).
#pragma once

#include "sim/constraint/links.h"
#include "sim/data/island.h"
#include "sim/solve/gauss_seidel.inl"
#include "sim/solve/impacts.inl"
#include "sim/solve/plain_newton.inl"
#include "sim/solve/proximal.inl"

namespace taut::sim {

/// Solves the island. m.l contains any initial guess. Results: the best admissible impulses in m.l,
/// with their velocities in m.v and m.u. Returns their residual [m/s].
template <class Num, class P>
double SolveInStages(Island<Num, P>& island, Target target, SolverWork& work) noexcept {
  constexpr int kSweeps = 30, kSweepsWithoutMatrix = 1000;
  constexpr double kSoftness[] = {1e-2, 1e-1, 1e-4, 1e-1};
  if (!island.has_matrix) return Sweep(island, kSweepsWithoutMatrix);
  double residual = 0;
  for (int again = 0;; ++again) {
    residual = PlainNewton(island, target, work);
    if (residual <= target.tolerance) return residual;
    if (again == 2) break;
    Sweep(island, kSweeps);
  }
  for (const double softness : kSoftness) {
    if (residual <= target.tolerance || work.linear_solves >= work.limit) break;
    if (softness != kSoftness[0]) Sweep(island, kSweeps);
    residual = Proximal<Num, P>(island, target, work).Solve(softness);
  }
  return residual;
}

/// Adapter of an island for impacts.inl.
template <class Num, class P>
class IslandImpacts {
 public:
  IslandImpacts(Island<Num, P>& island, Target target, SolverWork& work) noexcept
      : island_(island), target_(target), work_(work) {}

  template <class F>
  void ForEach(F&& f) noexcept {
    island_.pools.ForEach([&](auto& law, auto&, int row, int) { f(law, row); });
  }
  Num* u() noexcept { return island_.m.u; }
  Num* l() noexcept { return island_.m.l; }
  ImpactRows<Num> impacts() noexcept { return island_.m.impacts; }
  void MeasureBefore() noexcept {
    Num* const v = island_.m.trial_v;
    for (int b = 0; b < island_.body_count; ++b) {
      island_.Store(island_.bodies[b].before, v + kDofs * b);
    }
    island_.Measure(v, island_.m.impacts.before);
  }
  void SolveAgain(MaskOf<Num>) noexcept {
    island_.Judge();
    residual = SolveInStages(island_, target_, work_);
  }
  void Update() noexcept { island_.Judge(); }

  double residual = 0;

 private:
  Island<Num, P>& island_;
  Target target_;
  SolverWork& work_;
};

/// Solves an island with impacts. If friction prevents rebounds (one contact point below a steep,
/// sliding rod), the solution without rebounds is used, which is also valid.
template <class Num, class P>
double SolveIsland(Island<Num, P>& island, Target target, SolverWork& work) noexcept {
  IslandImpacts<Num, P> problem(island, target, work);
  island.Judge();
  const bool impacts = ExpectImpacts(problem);
  problem.residual = SolveInStages(island, target, work);
  if (!impacts) return problem.residual;
  const double first = problem.residual;
  const auto hit = SolveImpacts<Num>(problem, island.rows, MaskOf<Num>::Splat(true));
  if (!Any(hit) || problem.residual <= target.tolerance) return problem.residual;
  for (int i = 0; i < island.rows; ++i) island.m.l[i] = island.m.impacts.l[i];
  problem.Update();
  return first;
}

}  // namespace taut::sim
