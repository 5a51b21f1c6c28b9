/// Stage: impulses of contacts and stiff cables. Sweeps go over all of them, solve each by itself
/// or, for a body on the ground, its contacts together, and stop a lane when nothing changed a
/// velocity by more than the tolerance. Where sweeps crawl, Newton's method takes all of a lane
/// together. A lane that is done freezes: its neighbours cannot change it.

namespace taut::sim {

template <class W>
struct SolveResult {
  W residual;  ///< Largest change of a contact velocity in a lane's last sweep [m/s].
  W sweeps;
};

/// Contacts get their equations and start from the impulses of the step before.
template <class W>
void PrepareContacts(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                     double step_s) noexcept {
  int cursor = 0;
  for (int i = 0; i < work.contact_count; ++i) {
    ContactRow<W>& row = work.contacts[i];
    const ContactMemory<W> memory = Recall(s, g, row.id, cursor);
    if (i < work.single_count) {
      PrepareContact<W, false>(m, s, work, row, memory, step_s);
    } else {
      PrepareContact<W, true>(m, s, work, row, memory, step_s);
    }
  }
  // Only now, so that every contact has seen the velocities without contact.
  for (int i = 0; i < work.contact_count; ++i) {
    const ContactRow<W>& row = work.contacts[i];
    ApplyImpulse(work.bodies[row.a], row.im_a, row, row.ga, row.ln, row.l1, row.l2);
    if (i < work.single_count) continue;
    ApplyImpulse(work.bodies[row.b], row.im_b, row, row.gb, -row.ln, -row.l1, -row.l2);
  }
}

/// Sweeps after which to try Newton's method: 32, 64, 128, ...
TAUT_INLINE bool NewtonIsDue(int sweeps) noexcept {
  return sweeps >= kSweepsBeforeNewton && (sweeps & (sweeps - 1)) == 0;
}

/// One sweep over the contacts from number `first` on, each by itself: each ends inside its own
/// cone. Returns the largest change of a velocity [m/s].
template <class W, class M>
W RelaxContacts(Scratch<W>& work, int first, M lanes) noexcept {
  W change = W::Splat(0.0);
  for (int i = first; i < work.single_count; ++i) {
    change = Max(RelaxContact<W, false>(work, work.contacts[i], lanes), change);
  }
  for (int i = work.single_count; i < work.contact_count; ++i) {
    change = Max(RelaxContact<W, true>(work, work.contacts[i], lanes), change);
  }
  return change;
}

/// Lanes in which bodies on planes are not islands: something else hangs on them.
template <class W>
auto CoupledLanes(const Scratch<W>& work) noexcept {
  W others = W::Splat(0.0);
  for (int i = work.plane_count; i < work.contact_count; ++i) others += work.contacts[i].live;
  for (int i = 0; i < work.stiff_count; ++i) others += work.stiff[i].on;
  return others > W::Splat(0.0);
}

/// Stage: solve.
///   reads   contacts[] (geometry), stiff cables, cache of the step before
///   writes  bodies[].v, .w, impulses, mom
template <class W>
SolveResult<W> StageSolve(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                          const StepSettings& settings, double step_s) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  SolveResult<W> result{zero, zero};
  PrepareContacts(m, s, g, work, step_s);
  StartStiffCables(work);
  const bool anything = work.contact_count + work.stiff_count > 0;
  const W tolerance = W::Splat(settings.tolerance_m_per_s);
  auto busy = s.halted[0] == zero;
  auto hopeful = busy;  // that Newton's method helps
  const auto coupled = CoupledLanes(work);
  for (int sweep = 0; anything && sweep < settings.max_sweeps && Any(busy); ++sweep) {
    W change = RelaxStiffCables(work, busy);
    change = Max(RelaxBlocks(m, work, tolerance, busy, coupled), change);
    change = Max(RelaxContacts(work, work.plane_count, busy), change);
    result.residual = Select(busy, change, result.residual);
    result.sweeps += Select(busy, one, zero);
    busy = busy & (change > tolerance);
    if (!Any(busy) || !NewtonIsDue(sweep + 1)) continue;
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (!(busy & hopeful)[lane]) continue;
      LaneNewton<W> newton(work, lane, m.along_slip);
      hopeful.Set(lane, newton.Solve(settings.tolerance_m_per_s));
    }
  }
  // What has not converged must at least not rub harder than Coulomb allows.
  if (Any(busy)) RelaxContacts(work, 0, busy);
  for (int i = 0; i < work.contact_count; ++i) {
    ContactRow<W>& row = work.contacts[i];
    const V3<W> f = row.ln * row.n + row.l1 * row.t1 + row.l2 * row.t2;
    s.mom[row.a] += Cross(row.arm_a, f);
    if (i < work.single_count) {
      JudgeSlip<W, false>(work, row);
    } else {
      s.mom[row.b] -= Cross(row.arm_b, f);
      JudgeSlip<W, true>(work, row);
    }
  }
  FinishStiffCables(s, work, step_s);
  return result;
}

}  // namespace taut::sim
