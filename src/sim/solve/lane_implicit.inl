/// Data transfer between islands of a lane with stiff cables and the implicit integration.
#pragma once

#include "sim/bodies/stage_bodies.inl"
#include "sim/contacts/prepare_contact.inl"
#include "sim/solve/gather_island.inl"
#include "sim/solve/implicit_island.inl"
#include "sim/solve/lane_solve.inl"
#include "sim/solve/position_projection.inl"

namespace taut::sim {

template <class W>
double LaneSolve<W>::SolveImplicit(SolverWork& work) noexcept {
  Island<L, StepPools<L>>& island = mem_.island;
  // If the matrix does not fit into memory, nothing is solved and the status bit is set.
  if (!island.has_matrix) return 1.0;
  ImplicitIsland<W> implicit(m_, s_, work_, island, Target{settings_.tolerance_m_per_s}, lane_,
                             h_[0], work);
  const auto number = [&](int b) { return Moves(b) ? Number(b) : -1; };
  for (int i = 0; i < work_.stiff_count; ++i) {
    if (!IsOn(work_.stiff[i]) || !IsImplicit(work_.stiff[i])) continue;
    const CableTable& cable = m_.cables[work_.stiff[i].cable];
    int body = m_.body_count;
    for (int k = 0; k < cable.attachment_count; ++k) {
      const int b = m_.attachments[cable.first_attachment + k].body;
      if (Moves(b)) body = b;
    }
    if (!Moves(body) || mem_.root[body] != island_root_) continue;
    implicit.AddCable(i, number);
  }
  for (int i = 0; i < m_.joint_count; ++i) {
    const bool is_here = mem_.root[m_.joints[i].moved_body()] == island_root_;
    if (IsImplicitJoint(i) && is_here) implicit.AddJoint(i, number);
  }
  const double residual = implicit.Solve();
  if (implicit.failed()) return SolveWithFixedDirections(work);
  Scatter();
  implicit.Finish([&](int body) { return Pending(body) + PendingOfTouches(body); });
  return residual;
}

/// Solves an island after a failure of its implicit integration, with fixed directions of its
/// cables in this step. The residual stays above the tolerance, so the status reports the step.
template <class W>
double LaneSolve<W>::SolveWithFixedDirections(SolverWork& work) noexcept {
  fixed_directions_ = true;
  Gather(island_root_);
  SolverWork own{0, settings_.max_linear_solves};
  const double residual = SolveGathered(own);
  Scatter();
  fixed_directions_ = false;
  work.linear_solves += own.linear_solves;
  const double least = 2 * settings_.tolerance_m_per_s;
  return residual > least || !(residual - residual == 0) ? residual : least;
}

/// Stores the final pose of a body from an implicit solve: displaced, and rotated by twice `half`.
template <class W>
void LaneSolve<W>::DisplaceEnd(int body, const V3<L>& dx, const V3<L>& half) noexcept {
  if (!(work_.implicit.ended[body][lane_] > 0)) return;
  V3<W>& pos = work_.implicit.end_pos[body];
  SetLane(pos, OfLane<L>(pos, lane_) + dx, lane_);
  Q4<L> q = OfLane<L>(work_.implicit.end_quat[body], lane_);
  TurnAbout(q, half);
  NormalizeQuat(q);
  SetLane(work_.implicit.end_quat[body], q, lane_);
}

/// Returns the angular momentum that contacts with other moving bodies will still add to a body in
/// this step.
template <class W>
V3<simd::Lane<W>> LaneSolve<W>::PendingOfTouches(int body) const noexcept {
  V3<L> sum{L::Splat(0.0), L::Splat(0.0), L::Splat(0.0)};
  for (int i = 0; i < work_.touch_count[lane_]; ++i) {
    const Contact<L, 2>& c = mem_.pairs[i];
    for (int k = 0; k < 2; ++k) {
      if (c.links[k].body != body) continue;
      const V3<L> turned = Cross(c.arm[k], ImpulseOf(c));
      sum += k == 0 ? turned : -turned;
    }
  }
  return sum;
}

}  // namespace taut::sim
