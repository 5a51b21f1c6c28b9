/// Solver for a world with joints whose bodies touch only static geometry: Newton's method in the
/// velocities of all bodies, in all lanes at once (docs/theory/contact.md, section 5).
///
/// The solver takes the same steps as the first stage of an island (plain_newton.inl), with one
/// sparse system for the whole world. The model determines the pattern of this system and its
/// elimination order (compile/world_system.cpp). Lanes with sliding contacts have an unsymmetric
/// matrix. If only some lanes have such a matrix, both factorizations are computed, so that no lane
/// depends on the others. Lanes with rebounds and lanes that do not converge are left to the
/// lane-by-lane solver.
#pragma once

#include "sim/data/rows.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/impacts.inl"
#include "sim/solve/plain_newton.inl"

namespace taut::sim {

template <class W>
class WorldPrimal {
  using M = MaskOf<W>;
  using Bodies = Island<W, Pools<JointRow<W>>>;
  static constexpr int kMaxIterations = 12;

 public:
  WorldPrimal(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept
      : m_(m),
        s_(s),
        work_(work),
        mem_(work.primal),
        matrix_(*m.world_pattern, work.primal.blocks) {}

  /// Solves `lanes`. Returns the lanes that are left to the lane-by-lane solver, which stay
  /// unchanged.
  M Solve(Target target, int most_solves, M lanes, W& residual, W& solves) noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0), tolerance = W::Splat(target.tolerance),
            goal = W::Splat(target.goal()), pays = W::Splat(Target::kPays);
    Gather();
    UpdateVelocities();
    const M asked = lanes;
    lanes = lanes & !ExpectsRebounds();
    W now = Residual();
    M busy = lanes;
    const int most = most_solves < kMaxIterations ? most_solves : kMaxIterations;
    for (int i = 0; i < most && Any(busy); ++i) {
      NewtonStep(busy);
      UpdateVelocities();
      solves += Select(busy, one, zero);
      const W before = now;
      now = Select(busy, Residual(), now);
      const auto done = (now < goal) | ((now < tolerance) & (now > pays * before));
      busy = busy & !done & (now - now == zero);
    }
    if (Clamp(lanes)) {
      UpdateVelocities();
      now = Residual();
    }
    const M solved = lanes & (now < tolerance);
    residual = Max(Select(solved, now, zero), residual);
    Finish(solved);
    return asked & !solved;
  }

 private:
  int count() const noexcept { return m_.world_pattern->count; }

  /// Calls f(law, branch, first row, first entry of its rows x rows matrix) for all constraints.
  template <class F>
  TAUT_INLINE void ForEach(F&& f) noexcept {
    int row = 0, cell = 0;
    ForEachJointRow([&](HeldRow<W>& law, int i) { f(law, mem_.joint_branches[i], row++, cell++); });
    ForEachOther(f, row, cell);
  }
  /// Calls f(row of a joint, its index in the model). Three rows of friction of a ball joint are
  /// one law and are omitted.
  template <class F>
  TAUT_INLINE void ForEachJointRow(F&& f) noexcept {
    for (int i = 0; i < m_.joint_row_count; ++i) {
      if (m_.joint_rows[i].role != JointRole::kTurnFriction) f(work_.joints[i], i);
    }
  }
  /// Like ForEach, for all constraints except rows of joints. `row`, `cell`: first row and entry.
  template <class F>
  TAUT_INLINE void ForEachOther(F&& f, int row, int cell) noexcept {
    for (int i = 0; i < m_.turn_friction_count; ++i, row += 3, cell += 9) {
      f(mem_.frictions[i], mem_.friction_branches[i], row, cell);
    }
    for (int i = 0; i < work_.stiff_count; ++i) {
      f(work_.stiff[i], mem_.cable_branches[i], row++, cell++);
    }
    for (int b = 0; b < m_.body_count; ++b) {
      for (int k = 0; k < work_.contact_count[b]; ++k, row += 3, cell += 9) {
        const int slot = m_.first_slot[b] + k;
        f(work_.contacts[slot], mem_.contact_branches[slot], row, cell);
      }
    }
  }
  int RowsOfJoints() const noexcept { return m_.joint_row_count - 3 * m_.turn_friction_count; }

  /// Returns the lanes in which a law acts. All lanes for cables and contacts, because their laws
  /// include the condition.
  template <class Law>
  TAUT_INLINE static M Acts(const Law& law) noexcept {
    if constexpr (requires { law.reach; }) {
      return law.live > W::Splat(0.0);
    } else {
      return M::Splat(true);
    }
  }

  /// Replaces the bodies of all links by `to[body]`: by their numbers in the system, or back.
  void Renumber(const int* to) noexcept {
    ForEach([&](auto& law, auto&, int, int) {
      for (int i = 0; i < law.link_count; ++i) law.links[i].body = to[law.links[i].body];
    });
  }

  void Gather() noexcept {
    GatherFrictions();
    Renumber(m_.world_number);
    for (int k = 0; k < count(); ++k) {
      const int b = m_.world_bodies[k];
      const BodyWork<W>& from = work_.bodies[b];
      Unknown<W>& to = mem_.bodies[k];
      to.body = b;
      to.size = kDofs;
      to.mass = s_.mass[b], to.inv_mass = s_.inv_mass[b];
      to.inertia = Congruence(from.R, s_.inertia[b]);
      to.free = {from.v, from.w};
    }
    ForEach([&](auto& law, auto&, int row, int) {
      using Law = LawOf<decltype(law)>;
      if constexpr (requires { law.l[0]; }) {
        for (int r = 0; r < Law::kRows; ++r) mem_.l[row + r] = law.l[r];
      }
    });
    EachFriction([&](int, int row, const HeldRow<W>* rows) {
      for (int r = 0; r < 3; ++r) mem_.l[row + r] = rows[r].l[0];
    });
  }
  /// Calls f(number, its first row, its three rows of the joint) for the friction of each ball
  /// joint.
  template <class F>
  TAUT_INLINE void EachFriction(F&& f) noexcept {
    for (int i = 0; i < m_.turn_friction_count; ++i) {
      f(i, RowsOfJoints() + 3 * i, work_.joints + mem_.friction_row[i]);
    }
  }
  void GatherFrictions() noexcept {
    int found = 0;
    for (int i = 0; i < m_.joint_row_count && found < m_.turn_friction_count; ++i) {
      if (m_.joint_rows[i].role != JointRole::kTurnFriction) continue;
      mem_.friction_row[found++] = i;
      i += 2;
    }
    EachFriction([&](int i, int, const HeldRow<W>* rows) {
      TurnFriction<W>& to = mem_.frictions[i];
      to.limit = rows->upper;
      to.link_count = rows->link_count;
      for (int k = 0; k < to.link_count; ++k) {
        Link<W, 3>& link = to.links[k];
        link.body = rows->links[k].body;
        link.inv_mass = rows->links[k].inv_mass;
        for (int r = 0; r < 3; ++r) {
          const Link<W, 1>& from = rows[r].links[k];
          link.lin[r] = from.lin[0], link.ang[r] = from.ang[0], link.turn[r] = from.turn[0];
        }
      }
      to.FinishMasses();
    });
  }

  /// Moves impulses slightly outside of their limits or cones to the boundary. Returns whether
  /// impulses have changed in any of `lanes`.
  bool Clamp(M lanes) noexcept {
    auto changed = M::Splat(false);
    ForEach([&](auto& law, auto&, int row, int) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      W l[R];
      for (int r = 0; r < R; ++r) l[r] = mem_.l[row + r];
      law.Clamp(l);
      for (int r = 0; r < R; ++r) {
        changed = changed | !(l[r] == mem_.l[row + r]);
        mem_.l[row + r] = l[r];
      }
    });
    return Any(lanes & changed);
  }

  /// Computes velocities v <- v_free + M^-1 J^T l and constraint velocities u <- J v.
  void UpdateVelocities() noexcept {
    for (int k = 0; k < count(); ++k) Bodies::Store(mem_.bodies[k].free, mem_.v + kDofs * k);
    ForEach([&](auto& law, auto&, int row, int) {
      for (int i = 0; i < law.link_count; ++i) {
        W* const at = mem_.v + kDofs * law.links[i].body;
        Twist<W> t = Bodies::Load(at);
        Push(law.links[i], mem_.l + row, t.v, t.w);
        Bodies::Store(t, at);
      }
    });
    ForEach([&](auto& law, auto&, int row, int) { RateBy(law, mem_.v, mem_.u + row); });
  }
  /// Computes the constraint velocities u <- J v of a law.
  template <class Law>
  TAUT_INLINE static void RateBy(const Law& law, const W* v, W* u) noexcept {
    for (int r = 0; r < Law::kRows; ++r) u[r] = W::Splat(0.0);
    for (int i = 0; i < law.link_count; ++i) {
      const Twist<W> t = Bodies::Load(v + kDofs * law.links[i].body);
      AddVelocity(law.links[i], t.v, t.w, u);
    }
  }

  /// Returns the lanes in which a contact or joint limit may rebound.
  M ExpectsRebounds() noexcept {
    auto any = M::Splat(false);
    ForEach([&](auto& law, auto&, int row, int) {
      if constexpr (kRebounds<decltype(law)>) {
        if (law.ExpectRebound(mem_.u[row])) {
          any = any | ((law.rebound > W::Splat(0.0)) & Acts(law));
        }
      }
    });
    return any;
  }

  /// Updates the branches of all laws and returns the largest residual [m/s].
  W Residual() noexcept {
    const W zero = W::Splat(0.0);
    W worst = zero;
    ForEach([&](auto& law, auto& branch, int row, int) {
      branch = law.BranchOf(mem_.u + row, mem_.l + row);
      const W own = law.Residual(branch, mem_.u + row, mem_.l + row);
      worst = Max(Select(Acts(law), own, zero), worst);
    });
    return worst;
  }

  /// Takes one step of Newton's method in `lanes`, from the current branches of the laws.
  void NewtonStep(M lanes) noexcept {
    const W zero = W::Splat(0.0), e = W::Splat(kNewtonCompliance);
    const int size = kDofs * count();
    for (int i = 0; i < size; ++i) mem_.force[i] = zero;
    auto symmetric = M::Splat(true);
    ForEach([&](auto& law, auto& branch, int row, int cell) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      W *const g = mem_.g + cell, *const f = mem_.f + row;
      const M acts = Acts(law);
      symmetric = symmetric & StepOf(law, branch, mem_.u + row, mem_.l + row, e, g, f);
      if constexpr (R == 1) g[0] = Select(acts, g[0], zero), f[0] = Select(acts, f[0], zero);
      for (int i = 0; i < law.link_count; ++i) Bodies::AddForce(law.links[i], f, mem_.force);
    });
    for (const bool is_symmetric : {true, false}) {
      const M mine = lanes & (is_symmetric ? symmetric : !symmetric);
      if (!Any(mine)) continue;
      for (int i = 0; i < size; ++i) mem_.x[i] = mem_.force[i];
      SolveSystem(is_symmetric);
      for (int i = 0; i < size; ++i) mem_.change[i] = Select(mine, mem_.x[i], mem_.change[i]);
    }
    ForEach([&](auto& law, auto&, int row, int cell) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      W du[R];
      RateBy(law, mem_.change, du);
      for (int i = 0; i < R; ++i) {
        W dl = mem_.f[row + i];
        for (int j = 0; j < R; ++j) dl -= mem_.g[cell + R * i + j] * du[j];
        mem_.l[row + i] = Select(lanes, mem_.l[row + i] + dl, mem_.l[row + i]);
      }
    });
  }

  /// Solves in place: x <- (M + J^T G J)^-1 x. A bad pivot spoils the result of its lane, which the
  /// residual shows.
  void SolveSystem(bool symmetric) noexcept {
    matrix_.Start(mem_.bodies, symmetric);
    int row = 0;
    for (int i = 0; i < m_.joint_count; ++i) {
      const JointTable& j = m_.joints[i];
      int own = 0;
      for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
        if (m_.joint_rows[r].role == JointRole::kTurnFriction) {
          Flush(r - own, own, row);
        } else {
          ++own;
        }
      }
      Flush(j.first_row + j.row_count - own, own, row);
    }
    ForEachOther([&](auto& law, auto&, int, int cell) { matrix_.Add(law, mem_.g + cell); },
                 RowsOfJoints(), RowsOfJoints());
    matrix_.Factor();
    matrix_.Solve(mem_.x);
  }
  /// Adds `own` rows of a joint from row `first` of the model, whose first number is `row`.
  TAUT_INLINE void Flush(int first, int& own, int& row) noexcept {
    if (own > 0) matrix_.AddTogether(work_.joints + first, own, mem_.g + row);
    row += own;
    own = 0;
  }

  /// Copies the results to the laws and bodies in the lanes `solved`, and restores the links.
  void Finish(M solved) noexcept {
    ForEach([&](auto& law, auto&, int row, int) {
      using Law = LawOf<decltype(law)>;
      if constexpr (requires { law.l[0]; }) {
        for (int r = 0; r < Law::kRows; ++r) {
          law.l[r] = Select(solved, mem_.l[row + r], law.l[r]);
        }
      }
    });
    EachFriction([&](int, int row, HeldRow<W>* rows) {
      for (int r = 0; r < 3; ++r) rows[r].l[0] = Select(solved, mem_.l[row + r], rows[r].l[0]);
    });
    Renumber(m_.world_bodies);
    for (int k = 0; k < count(); ++k) {
      BodyWork<W>& body = work_.bodies[m_.world_bodies[k]];
      const Twist<W> t = Bodies::Load(mem_.v + kDofs * k);
      body.v = Select3(solved, t.v, body.v);
      body.w = Select3(solved, t.w, body.w);
    }
  }

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  PrimalMemory<W>& mem_;
  BodyMatrix<W> matrix_;
};

}  // namespace taut::sim
