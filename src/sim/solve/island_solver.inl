/// One island's solve: stages from the fast to the sure (docs/theory/contact.md, section 5).

namespace taut::sim {

/// From m.l, which may be anything. Leaves the best impulses found, which the laws admit, in m.l
/// with their velocities in m.v. Returns their residual [m/s].
template <class Num, class P>
double SolveIsland(Island<Num, P>& island, Target target, SolverWork& work) noexcept {
  constexpr int kSweeps = 30, kSweepsWithoutMatrix = 1000;
  constexpr double kSoftness[] = {1e-2, 1e-1, 1e-4, 1e-1};
  double residual = island.Judge();
  if (!island.has_matrix) return Sweep(island, kSweepsWithoutMatrix);
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

}  // namespace taut::sim
