/// Constrained joint rows in an implicit stage with stiff cables: constraint forces that do no work
/// over a step of any length (docs/theory/cables.md, eq. 12g, 12h).
///
/// The rows are discrete gradients of their coordinates: mean lever arms, mean axes, and for a
/// distance the mean direction. With the Cayley rotation, their product with the mean velocities is
/// exactly the change of the coordinate. Therefore joints neither create energy nor drift apart,
/// and linear and angular momentum are conserved.
#pragma once

#include "sim/data/implicit_memory.h"
#include "sim/data/island.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/implicit_cables.inl"

namespace taut::sim {

template <class W>
class ImplicitJoints {
 public:
  using Num = simd::Lane<W>;

  explicit ImplicitJoints(ImplicitMemory<W>& mem) noexcept : mem_(mem) {}

  int joint_count = 0, row_count = 0;

  /// Returns whether a joint connects one of the bodies to the world.
  bool HasSupport() const noexcept {
    bool any = false;
    for (int i = 0; i < joint_count; ++i) {
      any = any || mem_.joints[i].a.body < 0 || mem_.joints[i].b.body < 0;
    }
    return any;
  }

  /// Returns the largest row force in the last evaluation [N]; torques are divided by the radius.
  Num MostForce(const ImplicitStage<Num>& stage) const noexcept {
    Num most = Num::Splat(0.0);
    for (int r = 0; r < row_count; ++r) most = Max(Abs(mem_.joint_rows[r].trial), most);
    return most / stage.h;
  }

  /// Restores the loads of the previous step.
  void Restart() noexcept {
    for (int r = 0; r < row_count; ++r) {
      ImplicitJointRow<Num>& row = mem_.joint_rows[r];
      row.force = row.last_force;
      row.impulse = Num::Splat(0.0);
    }
  }

  /// Computes arms, axes and coordinates at the start of a stage. `goes_on`: coordinate changes
  /// count from the final values of the previous stage, otherwise from the values at this start.
  void Begin(const ImplicitStage<Num>& stage, bool goes_on) noexcept {
    for (int i = 0; i < joint_count; ++i) {
      ImplicitJoint<Num>& j = mem_.joints[i];
      Place(j.a), Place(j.b);
      j.a.d0 = j.b.p0 - j.a.p0;
      j.a.l0 = Sqrt(Dot(j.a.d0, j.a.d0));
      for (int r = j.first; r < j.first + j.count; ++r) {
        ImplicitJointRow<Num>& row = mem_.joint_rows[r];
        row.l = row.trial = row.center = stage.h * row.force;
        row.step = Num::Splat(0.0);
        row.x0 = Axis(j.a.body, row.x_P), row.y0 = Axis(j.b.body, row.y_P);
        if (!goes_on) row.target = Value(j, row, j.a.d0, j.a.l0, row.x0, row.y0);
      }
    }
  }

  /// Call it after ImplicitCables::Evaluate at the same velocities. Subtracts the joint impulses
  /// from the residual: l + `way` times their last Newton step.
  void Evaluate(const ImplicitStage<Num>& stage, double way, Num* res) noexcept {
    const Num zero = Num::Splat(0.0), half = Num::Splat(0.5), one = Num::Splat(1.0);
    for (int i = 0; i < joint_count; ++i) {
      ImplicitJoint<Num>& j = mem_.joints[i];
      ImplicitPoint<Num>&a = j.a, &b = j.b;
      Move(stage, a), Move(stage, b);
      const V3<Num> d1 = b.p1 - a.p1;
      a.l1 = Sqrt(Dot(d1, d1));
      if (j.is_distance) {
        a.n = (one / a.l1) * d1;
        a.u = stage.at_end ? a.n : (one / (a.l0 + a.l1)) * (a.d0 + d1);
      }
      j.push = {zero, zero, zero};
      V3<Num> turn{zero, zero, zero};
      for (int r = j.first; r < j.first + j.count; ++r) {
        ImplicitJointRow<Num>& row = mem_.joint_rows[r];
        row.trial = row.l + Num::Splat(way) * row.step;
        row.x1 = Turned(a.body, row.x0), row.y1 = Turned(b.body, row.y0);
        row.x = stage.at_end ? row.x1 : half * (row.x0 + row.x1);
        row.y = stage.at_end ? row.y1 : half * (row.y0 + row.y1);
        row.value = Value(j, row, d1, a.l1, row.x1, row.y1);
        if (row.turns) {
          turn += row.trial * Twisting(row);
        } else {
          j.push += row.trial * Pushing(j, row);
        }
      }
      Add(b, -j.push, -turn, res);
      Add(a, j.push, turn, res);
    }
  }

  /// Adds the differences between the impulses of the row laws (12h) and the present impulses, with
  /// the directions of the last AddTo.
  void AddGaps(const ImplicitStage<Num>& stage, Num* f) noexcept {
    for (int i = 0; i < joint_count; ++i) {
      const ImplicitJoint<Num>& j = mem_.joints[i];
      for (int r = j.first; r < j.first + j.count; ++r) {
        const ImplicitJointRow<Num>& row = mem_.joint_rows[r];
        const Num more = Excess(stage, row);
        AddTimes(more, row.on_a, j.a.body, f), AddTimes(more, row.on_b, j.b.body, f);
      }
    }
  }

  /// Computes the Newton steps of the impulses from the step of the velocities.
  void TakeStep(const ImplicitStage<Num>& stage, const Num* d) noexcept {
    for (int i = 0; i < joint_count; ++i) {
      const ImplicitJoint<Num>& j = mem_.joints[i];
      for (int r = j.first; r < j.first + j.count; ++r) {
        ImplicitJointRow<Num>& row = mem_.joint_rows[r];
        const Num change = Times(row.by_a, j.a.body, d) + Times(row.by_b, j.b.body, d);
        row.step = Excess(stage, row) - (row.stiffness / stage.h) * change;
      }
    }
  }

  void Accept() noexcept {
    for (int r = 0; r < row_count; ++r) mem_.joint_rows[r].l = mem_.joint_rows[r].trial;
  }

  /// Call it after ImplicitCables::AddTo. Adds the derivative of the last Evaluate with eliminated
  /// impulses.
  void AddTo(const ImplicitStage<Num>& stage, BodyMatrix<Num>& matrix) noexcept {
    const Num share = Num::Splat(stage.at_end ? 1.0 : 0.5);
    for (int i = 0; i < joint_count; ++i) {
      ImplicitJoint<Num>& j = mem_.joints[i];
      ImplicitPoint<Num>&a = j.a, &b = j.b;
      SetTurn(stage, a), SetTurn(stage, b);
      // Adds the derivative of a rotating lever arm.
      const auto on_arm = [&](const ImplicitPoint<Num>& p, const V3<Num>& push) {
        if (p.body < 0) return;
        matrix.AddSpins(p.body, p.body, CrossTimes(share * push, p.turn));
      };
      on_arm(b, j.push), on_arm(a, -j.push);
      if (j.is_distance) {
        const Num length = stage.at_end ? a.l1 : a.l0 + a.l1;
        const M3<Num> D = Across(-mem_.joint_rows[j.first].trial / length, a.u, a.n);
        AddPart(stage, a, b, D, matrix);
      }
      for (int r = j.first; r < j.first + j.count; ++r) {
        ImplicitJointRow<Num>& row = mem_.joint_rows[r];
        if (row.turns) AddTwist(stage, share, j, row, matrix);
        // C G B / h, C: forces, B: derivative of the coordinate.
        row.on_a = ForceOn(j, row, false), row.on_b = ForceOn(j, row, true);
        row.by_a = ChangeBy(stage, j, row, false), row.by_b = ChangeBy(stage, j, row, true);
        const Num g = row.stiffness / stage.h;
        AddOuterBlock(g, b.body, row.on_b, b.body, row.by_b, matrix);
        AddOuterBlock(g, b.body, row.on_b, a.body, row.by_a, matrix);
        AddOuterBlock(g, a.body, row.on_a, b.body, row.by_b, matrix);
        AddOuterBlock(g, a.body, row.on_a, a.body, row.by_a, matrix);
      }
    }
  }

  /// Ends a stage that acts for `passed` times its length.
  void EndStage(const ImplicitStage<Num>& stage, double passed) noexcept {
    for (int r = 0; r < row_count; ++r) {
      ImplicitJointRow<Num>& row = mem_.joint_rows[r];
      row.force = row.l / stage.h;
      row.impulse += Num::Splat(passed) * row.l;
      row.target = row.value;
    }
  }

 private:
  using Sides = ImplicitSides<Num>;

  void Place(ImplicitPoint<Num>& p) noexcept {
    if (p.body < 0) return;
    p.arm0 = RotationOf(mem_.body[p.body].q) * p.p_P;
    p.p0 = mem_.body[p.body].x + p.arm0;
  }
  V3<Num> Axis(int body, const V3<Num>& axis_P) const noexcept {
    return body < 0 ? axis_P : RotationOf(mem_.body[body].q) * axis_P;
  }
  V3<Num> Turned(int body, const V3<Num>& axis) const noexcept {
    return body < 0 ? axis : CayleyTurn(mem_.body[body].half, mem_.body[body].scale, axis);
  }
  void Move(const ImplicitStage<Num>& stage, ImplicitPoint<Num>& p) noexcept {
    p.p1 = p.p0;
    if (p.body >= 0) MovePoint(stage, mem_.body[p.body], p);
  }
  void SetTurn(const ImplicitStage<Num>& stage, ImplicitPoint<Num>& p) noexcept {
    if (p.body >= 0) p.turn = TurnOf(stage, mem_.body[p.body], p.arm0, p.arm1);
  }

  /// Returns the coordinate of a row: an offset along a fixed direction, a length, or r times the
  /// product of an axis of a and an axis of b.
  static Num Value(const ImplicitJoint<Num>& j, const ImplicitJointRow<Num>& row, const V3<Num>& d,
                   Num length, const V3<Num>& x, const V3<Num>& y) noexcept {
    if (row.turns) return row.reach * Dot(x, y);
    return j.is_distance ? length : Dot(row.along, d);
  }
  static V3<Num> Pushing(const ImplicitJoint<Num>& j, const ImplicitJointRow<Num>& row) noexcept {
    return j.is_distance ? j.a.u : row.along;
  }
  static V3<Num> Twisting(const ImplicitJointRow<Num>& row) noexcept {
    return row.reach * Cross(row.y, row.x);
  }
  /// Returns the impulse of the row's law minus the present impulse.
  Num Excess(const ImplicitStage<Num>& stage, const ImplicitJointRow<Num>& row) const noexcept {
    return row.center - row.stiffness * ((row.value - row.target) / stage.h) - row.trial;
  }

  static void Add(const ImplicitPoint<Num>& p, const V3<Num>& push, const V3<Num>& turn,
                  Num* to) noexcept {
    if (p.body < 0) return;
    const V3<Num> w = Cross(p.arm, push) + turn;
    Num* const f = to + kDofs * p.body;
    f[0] += push.x, f[1] += push.y, f[2] += push.z;
    f[3] += w.x, f[4] += w.y, f[5] += w.z;
  }

  static void AddTimes(Num by, const Sides& of, int body, Num* to) noexcept {
    if (body < 0) return;
    Num* const f = to + kDofs * body;
    f[0] += by * of.v.x, f[1] += by * of.v.y, f[2] += by * of.v.z;
    f[3] += by * of.w.x, f[4] += by * of.w.y, f[5] += by * of.w.z;
  }
  static Num Times(const Sides& of, int body, const Num* d) noexcept {
    if (body < 0) return Num::Splat(0.0);
    const Num* const t = d + kDofs * body;
    return Dot(of.v, V3<Num>{t[0], t[1], t[2]}) + Dot(of.w, V3<Num>{t[3], t[4], t[5]});
  }

  /// Returns the force of a unit impulse on b or a.
  static Sides ForceOn(const ImplicitJoint<Num>& j, const ImplicitJointRow<Num>& row,
                       bool on_b) noexcept {
    const Num zero = Num::Splat(0.0);
    Sides s{{zero, zero, zero}, Twisting(row)};
    if (!row.turns) {
      s.v = Pushing(j, row);
      s.w = Cross(on_b ? j.b.arm : j.a.arm, s.v);
    }
    return on_b ? s : Sides{-s.v, -s.w};
  }
  /// Returns the derivative of the row's value with respect to the velocities of b or a.
  Sides ChangeBy(const ImplicitStage<Num>& stage, const ImplicitJoint<Num>& j,
                 const ImplicitJointRow<Num>& row, bool by_b) const noexcept {
    const Num zero = Num::Splat(0.0);
    Sides s{{zero, zero, zero}, {zero, zero, zero}};
    const ImplicitPoint<Num>& p = by_b ? j.b : j.a;
    if (p.body < 0) return s;
    if (row.turns) {
      const ImplicitBody<Num>& body = mem_.body[p.body];
      s.w = row.reach * (by_b ? TransposeTimes(TurnOf(stage, body, row.y0, row.y1), row.x1)
                              : TransposeTimes(TurnOf(stage, body, row.x0, row.x1), row.y1));
      return s;
    }
    const V3<Num> along = j.is_distance ? j.a.n : row.along;
    s.v = stage.h * along, s.w = TransposeTimes(p.turn, along);
    return by_b ? s : Sides{-s.v, -s.w};
  }

  /// Adds the derivative of the torque l r (y x x) with respect to the rotations of its axes.
  void AddTwist(const ImplicitStage<Num>& stage, Num share, const ImplicitJoint<Num>& j,
                const ImplicitJointRow<Num>& row, BodyMatrix<Num>& matrix) noexcept {
    const Num f = share * row.trial * row.reach;
    const int a = j.a.body, b = j.b.body;
    const auto add = [&](int on, int by, const M3<Num>& ww) {
      if (on >= 0) matrix.AddSpins(on, by, ww);
    };
    if (b >= 0) {
      const M3<Num> Y = TurnOf(stage, mem_.body[b], row.y0, row.y1);
      add(b, b, CrossTimes(f * row.x, Y)), add(a, b, CrossTimes(-f * row.x, Y));
    }
    if (a >= 0) {
      const M3<Num> X = TurnOf(stage, mem_.body[a], row.x0, row.x1);
      add(b, a, CrossTimes(-f * row.y, X)), add(a, a, CrossTimes(f * row.y, X));
    }
  }

  static void AddOuterBlock(Num g, int on, const Sides& force, int by, const Sides& change,
                            BodyMatrix<Num>& matrix) noexcept {
    if (on < 0 || by < 0) return;
    const auto outer = [&](const V3<Num>& x, const V3<Num>& y) {
      return M3<Num>{(g * x.x) * y, (g * x.y) * y, (g * x.z) * y};
    };
    matrix.AddBlock(on, by, outer(force.v, change.v), outer(force.v, change.w),
                    outer(force.w, change.v), outer(force.w, change.w));
  }

  ImplicitMemory<W>& mem_;
};

}  // namespace taut::sim
