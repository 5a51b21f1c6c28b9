/// Implicitly integrated cables in a step: selection of the cables, and final poses of their bodies
/// (cable_groups.h, docs/theory/cables.md, section 3).
#pragma once

#include "sim/cables/stiff_cables.inl"
#include "sim/data/rows.h"

namespace taut::sim {

template <class W>
[[gnu::noinline, gnu::cold]] void FindImplicitOf(const View& m, const Rows<W>& s,
                                                 ImplicitMemory<W>& x, double step_s,
                                                 int lane) noexcept {
  const auto moves = [&](int body) { return s.inv_mass[body][lane] > 0; };
  const CableGroups groups{x.group.data(), x.size.data(), x.kind.data()};
  FindGroups(
      m, step_s, moves, [&](int c) { return s.stiff_k[c][lane]; },
      [&](int c) { return s.damping[c][lane] > 0; }, groups);
  for (int b = 0; b < m.body_count; ++b) {
    const double kind = groups.HasDamper(b) ? 2.0 : 1.0;
    x.bodies[b].Set(lane, groups.IsImplicit(b) ? kind : 0.0);
  }
  for (int c = 0; c < m.cable_count; ++c) {
    bool on = false, damped = false;
    ForEachMoved(m, m.cables[c], moves, [&](int body) {
      on = groups.IsImplicit(body);
      damped = groups.HasSecondStage(body);
    });
    if (on) x.limit[c].Set(lane, -1.0);
    x.damped[c].Set(lane, damped ? 1.0 : 0.0);
    x.any = x.any || on;
  }
}

/// Returns whether FindImplicitOf has the same inputs for a lane as for the first one.
template <class W>
bool HasCablesOfFirst(const View& m, const Rows<W>& s, int lane) noexcept {
  bool same = true;
  for (int c = 0; c < m.cable_count; ++c) {
    same = same && s.stiff_k[c][lane] == s.stiff_k[c][0];
    same = same && (s.damping[c][lane] > 0) == (s.damping[c][0] > 0);
  }
  for (int b = 0; b < m.body_count; ++b) {
    same = same && (s.inv_mass[b][lane] > 0) == (s.inv_mass[b][0] > 0);
  }
  return same;
}
template <class W>
void TakeImplicitOfFirst(const View& m, ImplicitMemory<W>& x, int lane) noexcept {
  for (int b = 0; b < m.body_count; ++b) x.bodies[b].Set(lane, x.bodies[b][0]);
  for (int c = 0; c < m.cable_count; ++c) {
    x.limit[c].Set(lane, x.limit[c][0]);
    x.damped[c].Set(lane, x.damped[c][0]);
  }
}

/// Selects the implicit cables. The selection is valid for this step length until a parameter
/// changes.
template <class W>
void FindImplicit(const View& m, const Rows<W>& s, ImplicitMemory<W>& x, double step_s) noexcept {
  const W limit = SoftLimit(W::Splat(step_s));
  auto stiff = MaskOf<W>::Splat(false);
  for (int c = 0; c < m.cable_count; ++c) {
    stiff = stiff | (s.stiff_k[c] > limit);
    x.limit[c] = limit;
  }
  x.any = false;
  if (!Any(stiff)) return;
  FindImplicitOf(m, s, x, step_s, 0);
  for (int lane = 1; lane < W::kLanes; ++lane) {
    if (HasCablesOfFirst(m, s, lane)) {
      TakeImplicitOfFirst(m, x, lane);
    } else {
      FindImplicitOf(m, s, x, step_s, lane);
    }
  }
}

/// Resets the final poses before a solve. Returns the lanes with implicit cables. In these,
/// contacts do not follow the arcs of free bodies.
template <class W>
[[gnu::noinline, gnu::cold]] MaskOf<W> StartImplicit(const View& m, Scratch<W>& work) noexcept {
  const W zero = W::Splat(0.0);
  auto lanes = MaskOf<W>::Splat(false);
  for (int b = 0; b < m.body_count; ++b) {
    work.implicit.ended[b] = zero;
    lanes = lanes | (work.implicit.bodies[b] > zero);
  }
  return lanes;
}

/// Resolves deep penetrations of bodies on implicit cables by slow velocities. A position
/// correction would stretch the cables without any force against it. The speed is limited, so that
/// no body jumps up by its penetration depth. `on`: affected lanes.
inline constexpr double kLeavingShare = 0.025, kMostLeavingMPerS = 0.2;
template <class Num, int kLinks, class M>
TAUT_INLINE void LeaveSlowly(Contact<Num, kLinks>& c, M on, double step_s) noexcept {
  const Num zero = Num::Splat(0.0), per_s = Num::Splat(kLeavingShare / step_s);
  const auto inside = on & (c.gap < zero);
  c.bias[0] = Select(inside, Max(per_s * c.gap, Num::Splat(-kMostLeavingMPerS)), c.bias[0]);
  c.deep = Select(on, zero, c.deep);
}
template <class W>
[[gnu::noinline, gnu::cold]] void LeaveWorldSlowly(const View& m, Scratch<W>& work,
                                                   double step_s) noexcept {
  for (int b = 0; b < m.body_count; ++b) {
    const auto on = work.implicit.bodies[b] > W::Splat(0.0);
    for (int k = 0; k < work.contact_count[b]; ++k) {
      LeaveSlowly(work.contacts[m.first_slot[b] + k], on, step_s);
    }
  }
}

/// Sets the final poses of bodies in implicit islands, instead of the second half of the drift.
template <class W>
[[gnu::noinline, gnu::cold]] void PutImplicitEnds(const View& m, const Rows<W>& s,
                                                  const Scratch<W>& work) noexcept {
  const W zero = W::Splat(0.0);
  for (int b = 0; b < m.body_count; ++b) {
    const auto on = work.implicit.ended[b] > zero;
    if (!Any(on)) continue;
    s.pos[b] = Select3(on, work.implicit.end_pos[b], s.pos[b]);
    const Q4<W>&from = work.implicit.end_quat[b], &q = s.quat[b];
    s.quat[b] = {Select(on, from.w, q.w), Select(on, from.x, q.x), Select(on, from.y, q.y),
                 Select(on, from.z, q.z)};
  }
}

}  // namespace taut::sim
