/// Cables with capstan friction in the islands of a lane (lane_solve.inl).
#pragma once

#include "sim/cables/cable_chains.inl"
#include "sim/cables/lane_spans.inl"
#include "sim/solve/gather_island.inl"
#include "sim/solve/lane_solve.inl"

namespace taut::sim {

/// Calls f(cable, a, b) for all pairs of moving bodies that a cable with friction connects.
template <class W>
template <class F>
void LaneSolve<W>::EachChain(const F& f) const noexcept {
  if (m_.chain_count == 0 || displaces_) return;
  for (int c = 0; c < m_.cable_count; ++c) {
    const CableTable& cable = m_.cables[c];
    if (cable.span_count > 0 && cable.touch >= 0) {
      const RowLink<W>* const links = work_.chain_links + cable.first_link;
      for (int i = 0; i < work_.chain_link_count[c]; ++i) {
        if (!Moves(links[i].body) || !Pulls(links[i], lane_)) continue;
        for (int k = 0; k < i; ++k) {
          if (Moves(links[k].body) && Pulls(links[k], lane_)) f(c, links[i].body, links[k].body);
        }
      }
      continue;
    }
    const AttachmentTable* const at = m_.attachments + cable.first_attachment;
    for (int i = 0; cable.span_count > 0 && i < cable.attachment_count; ++i) {
      for (int k = 0; k < i; ++k) {
        if (Moves(at[i].body) && Moves(at[k].body)) f(c, at[i].body, at[k].body);
      }
    }
  }
}

/// Collects the cables that pull at bodies of the island.
template <class W>
void LaneSolve<W>::GatherChains(Pool<CableChain<L>>& pool) noexcept {
  pool.count = 0;
  for (int c = 0; m_.chain_count > 0 && !displaces_ && c < m_.cable_count; ++c) {
    const CableTable& cable = m_.cables[c];
    if (cable.span_count == 0) continue;
    const RowLink<W>* const from = work_.chain_links + cable.first_link;
    const Row<RowLink<L>> links = mem_.chain_links.From(cable.first_link);
    CableChain<L>& to = pool.items[pool.count];
    to = ChainOfLane<L>(m_, s_, cable, work_, mem_.spans + cable.first_span, lane_, h_);
    to.links = links;
    bool pulls = false;
    for (int k = 0; k < work_.chain_link_count[c]; ++k) {
      const bool mine = Moves(from[k].body) && mem_.root[from[k].body] == island_root_;
      if (!mine && !m_.HasMotion(from[k].body)) continue;
      if (cable.touch >= 0 && !Pulls(from[k], lane_)) continue;
      pulls = pulls || mine;
      GatherLink(from[k], links[to.link_count]);
      links[to.link_count++].row = from[k].row;
    }
    if (!pulls) continue;
    chain_source_[pool.count++] = c;
    to.FinishMasses();
  }
}

}  // namespace taut::sim
