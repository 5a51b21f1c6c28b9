/// Memory of the implicit integration of stiff cables (implicit_groups.inl, implicit_island.inl).
#pragma once

#include "sim/cable_groups.h"
#include "sim/solve/memory.h"
#include "sim/tables.h"
#include "simd/vec3.h"

namespace taut::sim {

/// A body while an island with stiff cables is integrated.
template <class Num>
struct ImplicitBody {
  bool turns;             ///< Cables of this scheme act on it; else it keeps the explicit step.
  Num mass;               ///< [kg]
  V3<Num> moments;        ///< Principal [kg m^2],
  V3<Num> inv_moments;    ///< and 1 / them.
  V3<Num> force, torque;  ///< Impulses of all else over the whole step [N s], [N m s].
  V3<Num> x, v, w, L;     ///< State at the start of the stage; w, L: in W.
  simd::Q4<Num> q;
  S3<Num> inertia;     ///< In W, at the start of the stage; at the middle unless it turns.
  Num share;           ///< Of `force` and `torque` that acts within the stage.
  Num ahead, behind;   ///< Velocity at the end = ahead * unknown + behind * start.
  V3<Num> half;        ///< Half the turn of the stage, as a Cayley vector.
  Num scale;           ///< 1 / (1 + half^2)
  simd::M3<Num> undo;  ///< (1 - [half])^-1, of the matrix.
  V3<Num> x1, y, L1;   ///< At the end; y: L1 before the turn.
};

/// An attachment, and the part of the cable that follows it.
template <class Num>
struct ImplicitPoint {
  int body;               ///< Its number in the island, or -1: it does not move.
  V3<Num> p_P, arm0, p0;  ///< In the body; from its center and in W, at the start.
  V3<Num> arm, arm1, p1;  ///< Arm of the force; at the end.
  simd::M3<Num> turn;     ///< d arm1 / d spin.
  V3<Num> d0, u, n;       ///< To the next one: at the start; direction of force, of the end.
  Num l0, l1;             ///< [m]
};

template <class Num>
struct ImplicitCable {
  int source;           ///< Its number in Scratch::stiff.
  int first, count;     ///< Of its points.
  Num k, b, most;       ///< [N/m], [N s/m]; largest tension [N].
  Num stretch;          ///< At the start of the step [m].
  Num rest, rate;       ///< At the start of the stage [m]; its change [m/s].
  Num l0;               ///< Length at the start of the stage [m].
  Num tension, slope;   ///< [N]; per length at the end [N/m].
  Num elastic;          ///< The spring's part of the tension [N].
  Num impulse;          ///< Of the stages so far [N s],
  Num elastic_impulse;  ///< and the springs' part.
};

template <class W>
struct ImplicitMemory {
  using Num = simd::Lane<W>;
  static constexpr int64_t kMostRows = 192;  ///< Rows of laws that act at once.

  bool any = false;  ///< In some lane some cables are integrated so,
  W* cables;         ///< per cable: 1 in lanes in which it is,
  W* damped;         ///< and in which its group has the second stage.
  W* bodies;         ///< Per body: 1 in lanes in which such cables act on it.
  CableGroups groups;
  W* ended;  ///< Per body: 1 in lanes in which this step's end is known:
  V3<W>* end_pos;
  simd::Q4<W>* end_quat;

  // Of one lane's island.
  ImplicitBody<Num>* body;
  ImplicitPoint<Num>* points;
  ImplicitCable<Num>* list;
  Num *U, *trial, *res, *trial_res, *step, *back, *ends;  ///< 6 a body.
  Num *gap, *bias, *start, *total, *unit;  ///< Per row; start: impulses to begin from.
  int *compact, *active;                   ///< Per row.
  Num *x, *w, *k;                          ///< Of the rows that act.
  Num *l, *u, *y, *f, *best;
  int row_capacity;

  void Take(const View& m, Room& room) noexcept {
    const int64_t n = m.body_count, c = m.cable_count;
    const int64_t rows =
        3 * (m.slot_count + m.pair_capacity) + m.cable_count + m.joint_row_count + m.span_count;
    const int64_t most = rows < kMostRows ? rows : kMostRows;
    row_capacity = static_cast<int>(most);
    cables = room.Take<W>(c), damped = room.Take<W>(c), bodies = room.Take<W>(n);
    groups.group = room.Take<int>(n), groups.size = room.Take<int>(n);
    groups.kind = room.Take<uint8_t>(n);
    ended = room.Take<W>(n);
    end_pos = room.Take<V3<W>>(n);
    end_quat = room.Take<simd::Q4<W>>(n);
    body = room.Take<ImplicitBody<Num>>(n);
    points = room.Take<ImplicitPoint<Num>>(m.attachment_count);
    list = room.Take<ImplicitCable<Num>>(c);
    Num** const per_dof[] = {&U, &trial, &res, &trial_res, &step, &back, &ends};
    for (Num** x6 : per_dof) *x6 = room.Take<Num>(kDofs * n);
    Num** const per_row[] = {&gap, &bias, &start, &total, &unit};
    for (Num** row : per_row) *row = room.Take<Num>(rows);
    compact = room.Take<int>(rows), active = room.Take<int>(rows);
    x = room.Take<Num>(kDofs * n * most);
    w = room.Take<Num>(most * most), k = room.Take<Num>(most * most);
    Num** const per_active[] = {&l, &u, &y, &f, &best};
    for (Num** row : per_active) *row = room.Take<Num>(most);
  }
};

}  // namespace taut::sim
