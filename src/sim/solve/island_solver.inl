/// One island's solve: stages from the fast to the sure (docs/theory/contact.md, section 5).

namespace taut::sim {

/// From m.l, which may be anything. Leaves the best impulses found, which the laws admit, in m.l
/// with their velocities in m.v. Returns their residual [m/s].
template <class Num, class P>
double SolveIsland(Island<Num, P>& island, double tolerance, SolverWork& work) noexcept {
  constexpr int kSweeps = 30;
  double residual = island.Judge();
  if (residual <= tolerance) return residual;
  for (int again = 0;; ++again) {
    residual = PlainNewton(island, tolerance, work);
    if (residual <= tolerance || again == 2) break;
    residual = Sweep(island, kSweeps);
    if (residual <= tolerance) return residual;
  }
  constexpr double kSoftness[] = {1e-2, 1e-1, 1e-4, 1e-1};
  for (const double softness : kSoftness) {
    if (residual <= tolerance || work.linear_solves >= work.limit) break;
    if (softness != kSoftness[0]) Sweep(island, kSweeps);
    residual = Proximal<Num, P>(island, tolerance, work).Solve(softness);
  }
  return residual;
}

}  // namespace taut::sim
