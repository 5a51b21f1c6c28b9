/// Linear system of all constrained joint rows over the bodies with joints, in all lanes: the
/// smallest mass-weighted change that brings the rows to their targets (docs/theory/joints.md, eq.
/// 7).
///
/// The model determines bodies, rows and blocks. Redundant rows share their load: each row has a
/// compliance proportional to its inverse effective mass. A second pass removes the remaining
/// error.
#pragma once

#include "sim/data/rows.h"
#include "sim/joints/joints.inl"
#include "sim/solve/body_matrix.inl"

namespace taut::sim {

template <class W>
class JointSystem {
  static constexpr int kPasses = 2;

 public:
  JointSystem(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept
      : m_(m),
        s_(s),
        work_(work),
        mem_(work.joint_memory),
        matrix_(*m.joint_pattern, mem_.blocks) {}

  /// Adds joint limits with contact forces to the constrained rows: closed limits, or all that are
  /// closed at the end.
  void IncludeHeldStops() noexcept { held_stops_ = true; }
  void IncludeStops() noexcept { held_stops_ = passed_stops_ = true; }

  /// Assembles the system at the current poses.
  void Assemble() noexcept {
    for (int k = 0; k < m_.joint_body_count; ++k) {
      const int b = m_.joint_bodies[k];
      Unknown<W>& body = mem_.bodies[k];
      body.body = b, body.size = kDofs;
      body.mass = s_.mass[b], body.inv_mass = s_.inv_mass[b];
      body.inertia = Congruence(work_.bodies[b].R, s_.inertia[b]);
    }
    matrix_.Start(mem_.bodies, true);
    rows_ = 0;
    for (int i = 0; i < m_.joint_count; ++i) {
      const JointTable& j = m_.joints[i];
      const JointPlace<W> p = PlaceOf(m_, s_, work_, j);
      for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
        const JointRowTable& table = m_.joint_rows[r];
        if (table.role != JointRole::kHold) break;
        const JointDirection<W> d = DirectionOf(j, table.measure, p, W::Splat(0.0));
        Add(r, j, p, d, MissOf(table.measure, j, d.value),
            [](W A) { return W::Splat(1.0) / (W::Splat(kHeldCompliance) * A); });
      }
    }
    if (held_stops_) AddStops();
    matrix_.Factor();
  }

  int rows() const noexcept { return rows_; }
  const JointRow<W>& row(int r) const noexcept { return mem_.rows[r]; }
  int number(int r) const noexcept { return mem_.number[r]; }  ///< Number among the model's rows.
  W gap(int r) const noexcept { return mem_.gap[r]; }

  /// Solves for the impulses that cancel the row velocities `miss(row)`, or for the displacements
  /// that cancel gaps. Results: impulse(row), and the velocity changes change(k) of body k.
  template <class F>
  void Solve(const F& miss) noexcept {
    const W zero = W::Splat(0.0);
    const int size = kDofs * m_.joint_body_count;
    for (int i = 0; i < size; ++i) mem_.change[i] = zero;
    for (int r = 0; r < rows_; ++r) mem_.miss[r] = miss(r), mem_.l[r] = zero;
    for (int pass = 0; pass < kPasses; ++pass) {
      for (int i = 0; i < size + kDofs * m_.motion_count; ++i) mem_.rhs[i] = zero;
      for (int r = 0; r < rows_; ++r) {
        const W push = zero - mem_.G[r] * mem_.miss[r];
        for (int k = 0; k < mem_.rows[r].link_count; ++k) {
          if (mem_.rows[r].links[k].body >= m_.joint_body_count) continue;
          Island<W, Pools<JointRow<W>>>::AddForce(mem_.rows[r].links[k], &push, mem_.rhs);
        }
      }
      matrix_.Solve(mem_.rhs);
      for (int r = 0; r < rows_; ++r) {
        mem_.miss[r] += RateBy(mem_.rows[r], mem_.rhs);
        mem_.l[r] -= mem_.G[r] * mem_.miss[r];
      }
      for (int i = 0; i < size; ++i) mem_.change[i] += mem_.rhs[i];
    }
  }
  W impulse(int r) const noexcept { return mem_.l[r]; }

  /// Computes the response to generalized forces `x` (6 per body) with all constrained rows fixed.
  void GiveWay(W* x) const noexcept { matrix_.Solve(x); }

  Twist<W> change(int k) const noexcept {
    return Island<W, Pools<JointRow<W>>>::Load(mem_.change + kDofs * k);
  }

 private:
  /// Adds row `r` of the model. `stiffness(A)`: stiffness for the inverse effective mass A.
  template <class F>
  void Add(int r, const JointTable& j, const JointPlace<W>& p, const JointDirection<W>& d, W gap,
           const F& stiffness) noexcept {
    JointRow<W>& row = mem_.rows[rows_];
    SetJointLinks(s_, work_, j, p, d, row);
    for (int k = 0; k < row.link_count; ++k) {
      row.links[k].body = m_.joint_number[row.links[k].body];
    }
    mem_.G[rows_] = stiffness(row.A);
    mem_.number[rows_] = r;
    mem_.gap[rows_] = gap;
    matrix_.Add(row, &mem_.G[rows_]);
    ++rows_;
  }
  /// Appends joint limits to the constrained rows. In lanes with an open limit, its row has zero
  /// weight.
  void AddStops() noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0), least = W::Splat(1e-300);
    for (int r = 0; r < m_.joint_row_count; ++r) {
      const JointRowTable& table = m_.joint_rows[r];
      if (!IsStop(table.role)) continue;
      const int i = work_.joints[r].joint;
      const JointTable& j = m_.joints[i];
      const JointPlace<W> p = PlaceOf(m_, s_, work_, j);
      const JointDirection<W> d = DirectionOf(j, table, p, AngleAt(j, p, s_.joint_angle[i]));
      auto closed = IsClosedAtEnd(work_.joints[r], d.value);
      if (!passed_stops_) closed = closed & (work_.joints[r].held > zero);
      if (!Any(closed)) continue;
      Add(r, j, p, d, Select(closed, d.value, zero), [&](W A) {
        return Select(closed, one / Max(W::Splat(kHeldCompliance) * A, least), zero);
      });
    }
  }

  static W RateBy(const JointRow<W>& row, const W* x) noexcept {
    W u = W::Splat(0.0);
    for (int k = 0; k < row.link_count; ++k) {
      const Twist<W> t = Island<W, Pools<JointRow<W>>>::Load(x + kDofs * row.links[k].body);
      AddVelocity(row.links[k], t.v, t.w, &u);
    }
    return u;
  }

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  JointMemory<W>& mem_;
  BodyMatrix<W> matrix_;
  int rows_ = 0;
  bool held_stops_ = false, passed_stops_ = false;
};

}  // namespace taut::sim
