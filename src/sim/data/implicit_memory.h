/// Memory of the implicit integration of stiff cables (implicit_groups.inl, implicit_island.inl).
#pragma once

#include "sim/data/cable_groups.h"
#include "sim/data/scratch_memory.h"
#include "sim/data/view.h"
#include "simd/vec3.h"

namespace taut::sim {

/// State of a body during the implicit integration of its island.
template <class Num>
struct ImplicitBody {
  bool turns;           ///< Implicit cables act on the body; otherwise it keeps the explicit step.
  Num mass;             ///< Mass [kg].
  V3<Num> moments;      ///< Principal moments [kg m^2].
  V3<Num> inv_moments;  ///< Inverse principal moments.
  V3<Num> force, torque;  ///< All other impulses of the whole step [N s], [N m s].
  V3<Num> x, v, w, L;     ///< State at the start of the stage; w and L are in W.
  simd::Q4<Num> q;
  S3<Num> inertia;     ///< In W, at the start of the stage; at its middle if not `turns`.
  Num share;           ///< Fraction of `force` and `torque` that acts within the stage.
  Num ahead, behind;   ///< Velocity at the end = ahead * unknown + behind * velocity at the start.
  V3<Num> half;        ///< Cayley vector of half the rotation in the stage.
  Num scale;           ///< Factor 1 / (1 + half^2).
  simd::M3<Num> undo;  ///< (1 - [half])^-1, as a matrix.
  V3<Num> x1, y, L1;   ///< At the end of the stage; y: L1 before the rotation.
};

/// Attachment, and the part of the cable after it.
template <class Num>
struct ImplicitPoint {
  int body;  ///< Index in the island; -1: static.
  /// Position in the body frame; at the start, relative to the body's center and in W.
  V3<Num> p_P, arm0, p0;
  V3<Num> arm, arm1, p1;  ///< Lever arm of the force; position at the end, likewise.
  simd::M3<Num> turn;     ///< d arm1 / d spin.
  /// Vector to the next point at the start; force direction; unit vector at the end.
  V3<Num> d0, u, n;
  Num l0, l1;  ///< Lengths of the part at the start and at the end [m].
};

template <class Num>
struct ImplicitCable {
  int source;           ///< Index in Scratch::stiff.
  int first, count;     ///< Range of the cable's points.
  Num k, b, most;       ///< Stiffness [N/m], damping coefficient [N s/m], largest tension [N].
  Num stretch;          ///< Stretch at the start of the step [m].
  Num rest, rate;       ///< Rest length at the start of the stage [m]; its rate [m/s].
  Num l0;               ///< Length at the start of the stage [m].
  Num tension, slope;   ///< Tension [N]; its derivative by the final length [N/m].
  Num elastic;          ///< Spring part of the tension [N].
  Num impulse;          ///< Sum over the stages so far [N s].
  Num elastic_impulse;  ///< Spring part of `impulse` [N s].
};

/// Joint whose constrained rows are integrated together with stiff cables (implicit_joints.inl).
template <class Num>
struct ImplicitJoint {
  ImplicitPoint<Num> a, b;  ///< Joint points; d0, u, n, l0, l1 of `a` are from a to b.
  int first, count;         ///< Range of the joint's rows.
  bool is_distance;         ///< The only row of the joint constrains a distance.
  V3<Num> push;             ///< Impulse on the point of b [N s].
};

/// Effect of a row on one body, for velocities and angular velocities.
template <class Num>
struct ImplicitSides {
  V3<Num> v, w;
};

template <class Num>
struct ImplicitJointRow {
  int source;  ///< Index of the row in the model.
  /// The coordinate is the product of an axis of a and an axis of b; otherwise an offset.
  bool turns;
  V3<Num> along;     ///< Direction of an offset, in W.
  V3<Num> x_P, y_P;  ///< Axes in the frames of a and b.
  /// Axes in W: at the start, at the end, and where the torque acts.
  V3<Num> x0, y0, x1, y1, x, y;
  Num reach;                   ///< Radius that converts rotations to lengths [m].
  Num stiffness;               ///< Inverse of the compliance [kg].
  Num last_force, force;       ///< Force in the previous step, and in the previous stage [N].
  Num target, value;           ///< Coordinate before and after the stage [m].
  Num center, l, step, trial;  ///< Impulses: predicted, accepted, Newton step, evaluated [N s].
  Num impulse;                 ///< Sum over the stages so far [N s].
  ImplicitSides<Num> on_a, on_b, by_a, by_b;  ///< Forces on a and b; derivatives of the coordinate.
};

template <class W>
struct ImplicitMemory {
  using Num = simd::Lane<W>;
  static constexpr int64_t kMostRows = 192;  ///< Maximum number of active constraint rows.

  bool any = false;      ///< Whether any lane has implicit cables.
  Row<W> limit;          ///< Per cable: largest K of an explicit cable [1/s^2]; -1: implicit.
  Row<W> damped;         ///< Per cable: 1 in lanes whose group has the second stage.
  Row<W> bodies;         ///< Per body: 1 in lanes with implicit cables on it, 2 with dampers.
  Row<int> group, size;  ///< Groups of one lane (CableGroups).
  Row<uint8_t> kind;
  Row<W> ended;  ///< Per body: 1 in lanes whose final pose was computed.
  Row<V3<W>> end_pos;
  Row<simd::Q4<W>> end_quat;

  // Data of the island of one lane.
  Row<ImplicitBody<Num>> body;
  Row<ImplicitPoint<Num>> points;
  Row<ImplicitCable<Num>> list;
  Row<ImplicitJoint<Num>> joints;
  Row<ImplicitJointRow<Num>> joint_rows;
  Row<Num> U, trial, res, trial_res, step, back, ends;  ///< Vectors with 6 numbers per body.
  Row<Num> gap, bias, start, total, unit;               ///< Per row; start: warm-start impulses.
  Row<int> compact, active;                             ///< One number per row.
  Row<Num> x, w, k;                                     ///< One number per active row.
  Row<Num> l, u, y, f, best;
  int row_capacity;

  /// Allocates the memory; none for models without cables.
  void Take(const View& m, Room& room) noexcept {
    const int64_t c = m.cable_count, n = c > 0 ? m.body_count : 0;
    const int64_t all =
        3 * (m.slot_count + m.pair_capacity) + m.cable_count + m.joint_row_count + m.span_count;
    const int64_t rows = c > 0 ? all : 0, most = rows < kMostRows ? rows : kMostRows;
    row_capacity = static_cast<int>(most);
    limit = room.Take<W>(c), damped = room.Take<W>(c), bodies = room.Take<W>(n);
    group = room.Take<int>(n), size = room.Take<int>(n), kind = room.Take<uint8_t>(n);
    ended = room.Take<W>(n);
    end_pos = room.Take<V3<W>>(n);
    end_quat = room.Take<simd::Q4<W>>(n);
    body = room.Take<ImplicitBody<Num>>(n);
    points = room.Take<ImplicitPoint<Num>>(n > 0 ? m.attachment_count : 0);
    list = room.Take<ImplicitCable<Num>>(c);
    joints = room.Take<ImplicitJoint<Num>>(n > 0 ? m.joint_count : 0);
    joint_rows = room.Take<ImplicitJointRow<Num>>(n > 0 ? m.joint_row_count : 0);
    Row<Num>* const per_dof[] = {&U, &trial, &res, &trial_res, &step, &back, &ends};
    for (Row<Num>* numbers : per_dof) *numbers = room.Take<Num>(kDofs * n);
    Row<Num>* const per_row[] = {&gap, &bias, &start, &total, &unit};
    for (Row<Num>* numbers : per_row) *numbers = room.Take<Num>(rows);
    compact = room.Take<int>(rows), active = room.Take<int>(rows);
    x = room.Take<Num>(kDofs * n * most);
    w = room.Take<Num>(most * most), k = room.Take<Num>(most * most);
    Row<Num>* const per_active[] = {&l, &u, &y, &f, &best};
    for (Row<Num>* numbers : per_active) *numbers = room.Take<Num>(most);
  }
};

}  // namespace taut::sim
