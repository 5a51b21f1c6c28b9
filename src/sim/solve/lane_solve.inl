/// Lane-by-lane solve of islands in which lanes differ too much to be solved together: contacts of
/// moving bodies, many contacts, and islands that the solvers in lanes left unsolved. Each island
/// is copied to one-lane numbers, solved (island_solver.inl), and copied back.
#pragma once

#include "sim/cables/lane_spans.inl"
#include "sim/data/rows.h"
#include "sim/solve/island_solver.inl"
#include "sim/solve/rolling.inl"

namespace taut::sim {

/// Result of solving one lane.
struct LaneResult {
  double residual = 0, relaxation = 0;
  int linear_solves = 0;
  int body = kWorld;  ///< A body of the island with the largest residual.
};

template <class W>
class LaneSolve {
  using L = simd::Lane<W>;

 public:
  LaneSolve(const View& m, const Rows<W>& s, Scratch<W>& work, const StepSettings& settings,
            int lane, double step_s) noexcept
      : m_(m),
        s_(s),
        work_(work),
        mem_(work.lane),
        settings_(settings),
        lane_(lane),
        h_(L::Splat(step_s)) {}

  /// Solves the islands of the lane with contacts of moving bodies, or with bodies marked as
  /// unsolved. Call PrepareTouches before.
  LaneResult Solve() noexcept {
    LaneResult result;
    FindIslands([&](int body) { return work_.unsolved[body][lane_] > 0; });
    for (int body = 0; body < m_.body_count; ++body) {
      if (mem_.root[body] != body || !Gather(body)) continue;
      SolverWork work{0, settings_.max_linear_solves};
      double residual = 0;
      if (work_.implicit.any && IsImplicit() && IsFinite()) {
        residual = SolveImplicit(work);
      } else {
        residual = SolveGathered(work);
        Scatter();
      }
      result.linear_solves += work.linear_solves;
      if (work.relaxation > result.relaxation) result.relaxation = work.relaxation;
      if (residual > result.residual || !(residual - residual == 0)) {
        result.residual = residual;
        result.body = body;
      }
    }
    return result;
  }

  /// Position projection (position_projection.inl). Returns the number of linear systems.
  int PushOut() noexcept;

 private:
  /// Solves the copied island. Rolling on a rotating body needs fixed-point rounds (rolling.inl).
  double SolveGathered(SolverWork& work) noexcept {
    constexpr int kMostRounds = 8;
    const Target target{settings_.tolerance_m_per_s};
    if (!FindRolling()) return SolveIsland(mem_.island, target, work);
    ExpectVelocities();
    FollowRolling();
    double residual = SolveIsland(mem_.island, target, work);
    for (int round = 0; round < kMostRounds && work.linear_solves < work.limit; ++round) {
      if (!(FollowRolling() > target.tolerance)) break;
      residual = SolveIsland(mem_.island, target, work);
    }
    KeepRolling();
    return residual;
  }
  template <class F>
  void EachRolling(const F& f) noexcept;
  bool FindRolling() noexcept;
  void ExpectVelocities() noexcept;
  double FollowRolling() noexcept;
  void KeepRolling() noexcept;
  RollingSide<L> SideOf(const Contact<L, 2>& c, int k, const Shape& shape) const noexcept;
  bool IsDeep(int body) const noexcept;
  bool IsAlone() const noexcept;
  V3<L> Pending(int body) const noexcept;
  V3<L> Displace(int number) noexcept;
  void KeepMomentum(const V3<L>& gained) noexcept;
  int Body(const ContactPoint<L, 2>& c, int k) const noexcept {
    return mem_.island.bodies[c.links[k].body].body;
  }

  /// Returns whether impulses move the body.
  bool Moves(int body) const noexcept {
    return body < m_.body_count && s_.inv_mass[body][lane_] > 0;
  }
  int Root(int body) const noexcept {
    while (mem_.root[body] != body) body = mem_.root[body] = mem_.root[mem_.root[body]];
    return body;
  }
  void Join(int a, int b) noexcept {
    a = Root(a), b = Root(b);
    if (a < b) mem_.root[b] = a;
    if (b < a) mem_.root[a] = b;
  }
  bool IsOn(const StiffCable<W>& cable) const noexcept {
    return !displaces_ && cable.live[lane_] > 0;
  }
  /// Returns whether a link acts in this lane. A cable with wrapping has links for the contacts of
  /// all lanes, but the result of a lane must not depend on other lanes.
  bool IsOn(const StiffCable<W>& cable, int link) const noexcept {
    return m_.cables[cable.cable].touch < 0 || Acts(cable.links[link], lane_);
  }

  /// Returns whether the group of a cable is integrated implicitly (implicit_groups.inl).
  bool IsImplicit(const StiffCable<W>& cable) const noexcept {
    return work_.implicit.any && !fixed_directions_ && work_.implicit.limit[cable.cable][lane_] < 0;
  }
  /// Returns whether joint `i` is integrated implicitly, together with the cables of its group.
  bool IsImplicitJoint(int i) const noexcept {
    if (!work_.implicit.any || fixed_directions_ || displaces_) return false;
    return work_.implicit.bodies[m_.joints[i].moved_body()][lane_] > 0;
  }
  /// Returns whether the copied island is integrated implicitly.
  bool IsImplicit() const noexcept {
    bool any = false;
    for (int k = 0; k < count_ && !displaces_; ++k) {
      any = any || work_.implicit.bodies[mem_.bodies[k]][lane_] > 0;
    }
    return any;
  }
  /// Returns whether the bodies of the island have finite velocities without constraints. Otherwise
  /// it is not solved, and the world gets the status kStatusNonFinite.
  bool IsFinite() const noexcept {
    const L zero = L::Splat(0.0);
    L sum = zero;
    for (int k = 0; k < count_; ++k) {
      const Twist<L>& t = mem_.island.bodies[k].free;
      sum += zero * (t.v.x + t.v.y + t.v.z + t.w.x + t.w.y + t.w.z);
    }
    return sum[0] == 0.0;
  }
  double SolveImplicit(SolverWork& work) noexcept;
  double SolveWithFixedDirections(SolverWork& work) noexcept;
  void DisplaceEnd(int body, const V3<L>& dx, const V3<L>& half) noexcept;
  V3<L> PendingOfTouches(int body) const noexcept;

  template <class F>
  void EachChain(const F& f) const noexcept;

  /// Sets root[b] to the lowest body in the island of b, for islands with a body for which `asks`
  /// is true; otherwise to -1.
  template <class Asks>
  void FindIslands(const Asks& asks) noexcept {
    for (int b = 0; b < m_.body_count; ++b) mem_.root[b] = b;
    for (int i = 0; i < work_.touch_count[lane_]; ++i) {
      const ContactPoint<L, 2>& c = mem_.pairs[i];
      if (Moves(c.links[1].body)) Join(c.links[0].body, c.links[1].body);
    }
    for (int i = 0; i < work_.stiff_count; ++i) {
      const StiffCable<W>& cable = work_.stiff[i];
      int first = -1;
      for (int k = 0; IsOn(cable) && k < cable.link_count; ++k) {
        const int body = cable.links[k].body;
        if (!Moves(body) || !IsOn(cable, k)) continue;
        if (first >= 0) Join(first, body);
        first = body;
      }
    }
    EachChain([&](int, int a, int b) { Join(a, b); });
    for (int i = 0; i < m_.joint_count; ++i) {
      const JointTable& j = m_.joints[i];
      if (j.a_moves && j.b_moves) Join(j.a, j.b);
    }
    for (int b = 0; b < m_.body_count; ++b) mem_.local[b] = 0;
    for (int b = 0; b < m_.body_count; ++b) {
      if (Moves(b) && asks(b)) mem_.local[Root(b)] = 1;  // excludes kinematic bodies
    }
    for (int b = 0; b < m_.body_count; ++b) mem_.root[b] = Root(b);
    for (int b = 0; b < m_.body_count; ++b) {
      if (mem_.local[mem_.root[b]] == 0) mem_.root[b] = -1;
    }
  }

  /// Computes the elimination order: place[local number]. If the blocks do not fit into memory, the
  /// solver uses only Gauss-Seidel sweeps, without linear systems.
  void Order() noexcept {
    BodyGraph& graph = mem_.graph;
    graph.count = count_;
    graph.words = BodyGraph::WordsFor(count_);
    graph.Clear();
    for (int i = 0; i < work_.touch_count[lane_]; ++i) {
      const ContactPoint<L, 2>& c = mem_.pairs[i];
      if (mem_.root[c.links[0].body] != island_root_ || !Moves(c.links[1].body)) continue;
      graph.Join(mem_.local[c.links[0].body], mem_.local[c.links[1].body]);
    }
    for (int i = 0; i < work_.stiff_count; ++i) {
      const StiffCable<W>& cable = work_.stiff[i];
      for (int k = 0; IsOn(cable) && k < cable.link_count; ++k) {
        const int a = cable.links[k].body;
        if (!Moves(a) || mem_.root[a] != island_root_ || !IsOn(cable, k)) continue;
        for (int j = 0; j < k; ++j) {
          const int b = cable.links[j].body;
          if (Moves(b) && IsOn(cable, j)) graph.Join(mem_.local[a], mem_.local[b]);
        }
      }
    }
    EachChain([&](int, int a, int b) {
      if (mem_.root[a] == island_root_) graph.Join(mem_.local[a], mem_.local[b]);
    });
    for (int i = 0; i < m_.joint_count; ++i) {
      const JointTable& j = m_.joints[i];
      if (!j.a_moves || !j.b_moves || mem_.root[j.a] != island_root_) continue;
      graph.Join(mem_.local[j.a], mem_.local[j.b]);
    }
    if (IsKept(graph)) return;
    const bool fits =
        Eliminate(graph, mem_.block_capacity, mem_.order, mem_.place, mem_.island.pattern);
    mem_.island.has_matrix = fits;
    const BlockPattern& pattern = mem_.island.pattern;
    mem_.kept[0] = {fits ? count_ : 0, pattern.lower_count, pattern.block_count};
  }
  /// Returns whether the memory still contains the order and pattern of this graph; otherwise keeps
  /// a copy of the graph. The order depends on the graph only, so the bits are the same.
  bool IsKept(const BodyGraph& graph) noexcept {
    const KeptPattern& kept = mem_.kept[0];
    bool same = kept.count == count_;
    for (int64_t i = 0; i < static_cast<int64_t>(graph.count) * graph.words; ++i) {
      same = same && mem_.kept_bits[i] == graph.bits[i];
      mem_.kept_bits[i] = graph.bits[i];
    }
    if (!same) return false;
    mem_.island.pattern.count = count_;
    mem_.island.pattern.lower_count = kept.lower_count;
    mem_.island.pattern.block_count = kept.block_count;
    mem_.island.has_matrix = true;
    return true;
  }
  int Number(int body) const noexcept { return mem_.place[mem_.local[body]]; }

  /// Sets the law of a displacement: outward, or inward up to contact.
  void Displacing(ContactPoint<L, 2>& c, double deep, double gap) const noexcept;

  // Copies between the lanes and the memory of the solver (gather_island.inl).
  /// Copies the island of `root`. Returns false if no constraint acts on it.
  bool Gather(int root) noexcept;
  void GatherBody(int body, Unknown<L>& out) const noexcept;
  /// `first`: first row in `to`.
  template <int R, int S>
  void GatherLink(const Link<W, R>& from, Link<L, S>& to, int first = 0) const noexcept;
  void GatherMasses(const Contact<W, 1>& from, ContactPoint<L, 2>& to) const noexcept;
  void GatherContacts(Pool<ContactPoint<L, 2>>& pool) noexcept;
  void GatherCables(Pool<CableRow<L>>& pool) noexcept;
  void GatherJoints(Pool<JointRow<L>>& pool, Pool<TurnFriction<L>>& frictions) noexcept;
  void GatherFrictions(Pool<TurnFriction<L>>& pool) noexcept;
  void GatherChains(Pool<CableChain<L>>& pool) noexcept;
  /// Copies the impulses for the warm start.
  void GatherImpulses() noexcept;
  /// Copies impulses and velocities back to the lane.
  void Scatter() noexcept;

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  LaneMemory<L>& mem_;
  const StepSettings& settings_;
  int lane_;
  L h_;
  bool displaces_ = false, fixed_directions_ = false;
  int count_ = 0, island_root_ = 0;
  Row<int> cable_source_, joint_source_, friction_source_, chain_source_;
};

}  // namespace taut::sim

#include "sim/solve/gather_island.inl"
#include "sim/solve/lane_chains.inl"
#include "sim/solve/lane_implicit.inl"
#include "sim/solve/lane_rolling.inl"
#include "sim/solve/position_projection.inl"
