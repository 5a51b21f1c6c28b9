/// Collection of the cables and joints of an implicitly integrated island.
#pragma once

#include "sim/data/implicit_memory.h"
#include "sim/data/of_lane.h"
#include "sim/solve/implicit_island.inl"
#include "simd/vec3.h"

namespace taut::sim {

template <class W>
void ImplicitIsland<W>::SetPoint(int body, int number, const double* own_P,
                                 ImplicitPoint<Num>& p) noexcept {
  p.body = number;
  p.p_P = p.p0 = simd::Splat3<Num>(own_P);
  if (number < 0 && body < m_.body_count) {
    p.p0 = StartPosition(body) + RotationOf(StartRotation(body)) * p.p_P;
  }
}

template <class W>
template <class Number>
void ImplicitIsland<W>::AddCable(int row, const Number& number) noexcept {
  const StiffCable<W>& from = work_.stiff[row];
  const CableTable& table = m_.cables[from.cable];
  ImplicitCable<Num>& c = mem_.list[cables_.cable_count++];
  const Num h = Num::Splat(step_s_), two = Num::Splat(2.0), half = Num::Splat(0.5);
  c.source = row;
  c.first = cables_.point_count, c.count = table.attachment_count;
  c.k = Num::Splat(4.0 / (step_s_ * step_s_)) * OfLane<Num>(from.spring, lane_);
  c.b = (two / h) * OfLane<Num>(from.damper, lane_);
  c.most = OfLane<Num>(from.upper, lane_) / h;
  c.rate = half * OfLane<Num>(from.winding, lane_);
  c.stretch = half * h * OfLane<Num>(from.start, lane_);
  damped_ = damped_ || work_.implicit.damped[from.cable][lane_] > 0;
  for (int i = 0; i < c.count; ++i) {
    const AttachmentTable& at = m_.attachments[table.first_attachment + i];
    SetPoint(at.body, number(at.body), at.p_P, mem_.points[cables_.point_count++]);
  }
}

template <class W>
template <class Number>
void ImplicitIsland<W>::AddJoint(int i, const Number& number) noexcept {
  const JointTable& table = m_.joints[i];
  const Num zero = Num::Splat(0.0);
  ImplicitJoint<Num>& j = mem_.joints[joints_.joint_count++];
  const auto axis = [&](int body, const double* axis_P) {
    const V3<Num> own = simd::Splat3<Num>(axis_P);
    const bool is_outside = body < m_.body_count && number(body) < 0;
    return is_outside ? RotationOf(StartRotation(body)) * own : own;
  };
  SetPoint(table.a, number(table.a), table.own_a_P, j.a);
  SetPoint(table.b, number(table.b), table.own_b_P, j.b);
  j.first = joints_.row_count, j.count = table.row_count;
  j.is_distance = m_.joint_rows[table.first_row].measure == JointMeasure::kDistance;
  for (int r = table.first_row; r < table.first_row + table.row_count; ++r) {
    const HeldRow<W>& from = work_.joints[r];
    ImplicitJointRow<Num>& row = mem_.joint_rows[joints_.row_count++];
    row.source = r;
    row.along = OfLane<Num>(from.lin, lane_);
    row.reach = Num::Splat(table.reach_m);
    // The mean of eq. 3 over the step has half the compliance of eq. 3.
    row.stiffness = Num::Splat(2.0) / (Num::Splat(kHeldCompliance) * OfLane<Num>(from.A, lane_));
    row.last_force = OfLane<Num>(s_.joint_load[r], lane_);
    const MeasuredAxes axes = AxesOf(m_.joint_rows[r].measure);
    row.turns = axes.of_a >= 0;
    row.x_P = row.y_P = {zero, zero, zero};
    if (!row.turns) continue;
    row.x_P = axis(table.a, table.axes_a_P + 3 * axes.of_a);
    row.y_P = axis(table.b, table.axes_b_P + 3 * axes.of_b);
  }
}

}  // namespace taut::sim
