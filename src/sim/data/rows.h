/// Typed access to a group's rows, and scratch memory of a step.
#pragma once

#include "math/cable_wheel.h"
#include "sim/constraint/cable_row.h"
#include "sim/constraint/joint_row.h"
#include "sim/data/contacts.h"
#include "sim/data/group.h"
#include "sim/data/implicit_memory.h"
#include "sim/data/motion_at.h"
#include "sim/data/of_lane.h"
#include "sim/data/room.h"
#include "sim/data/scratch_memory.h"
#include "simd/vec3.h"
#include "simd/wide_angle.h"

namespace taut::sim {

using simd::M3;
using simd::Q4;
using simd::S3;
using simd::V3;

/// A group's rows as wide numbers: row `pos` of body b is pos[b] (state_rows.h).
template <class W>
struct Rows {
  using Number = W;
  using V3 = simd::V3<W>;
  using Q4 = simd::Q4<W>;
  using Motor = MotorNumbers<W>;
  using Orders = MotorOrders<W>;
  using WrapPoint = WrapPointNumbers<W>;

#define TAUT_ROW(name, type, ...) Row<type> name;
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW

  Rows(const View& m, const Layout& l, const Group& g) noexcept {
    W* const base = reinterpret_cast<W*>(g.rows);
#define TAUT_ROW(name, type, per, ...) \
  name = Row<type>(reinterpret_cast<type*>(base + l.name), m.Count(Per::per));
    TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
  }
};

/// Data of a body during a step. The world has one, too: identity, zero.
template <class W>
struct BodyWork {
  M3<W> R;              ///< R_WP at the middle of the step.
  S3<W> inv_inertia;    ///< In W [1/(kg m^2)].
  V3<W> v, w;           ///< Current velocities [m/s], [rad/s].
  V3<W> v0, w0;         ///< Before this step's forces.
  V3<W> v_mid, w_mid;   ///< Means over the step, from the velocities known so far: for dampers.
  V3<W> force, torque;  ///< Of cables, gravity and nodes [N], [N m].
  V3<W> mom_free;       ///< Angular momentum without contacts and stiff cables.
  W landed;             ///< 1 where a contact of the body landed in this step.
  W turns;              ///< Bound of the travel of points by rotation in this step [m],
  W turned;             ///< and since the middle of the previous step.
};

/// A distinct point of a body to which cables are attached.
template <class W>
struct Spot {
  V3<W> p, arm;  ///< In W; from the body's center of mass [m].
};

/// An attachment while its cable's force is computed; its velocity is the expected one.
template <class W>
using AttachmentWork = PathPoint<V3<W>>;

/// Deviation of a bend from the straight line on its edge or rod (cable_across.inl).
template <class W>
struct AcrossWork {
  W aside;  ///< Pull along the axis per tension, positive along the axis [1].
  W drift;  ///< Displacement along the axis per slip along the cable [1].
  W far;    ///< Distance along the axis to the place where it would be straight [m].
  W lean;   ///< See Lean::apart [1].
};

/// Center and axis of a rod in W.
template <class W>
struct RodLine {
  V3<W> center, axis;
};

/// Data of a cable while the tensions of soft cables are computed. Members from `links` on: only in
/// worlds with dampers or stiff cables.
template <class W>
struct CableWork {
  MaskOf<W> soft;         ///< Lanes in which the cable is soft.
  W spring;               ///< Spring part of the tension [N].
  W stretch;              ///< At the middle of the step [m].
  Row<Link<W, 1>> links;  ///< Used: the first link_count; capacity shared by all cables.
  int link_count;
  W A;  ///< Inverse effective mass along the cable [1/kg].
  MaskOf<W> damped;
  W damping;  ///< [N s/m]
  W share;    ///< Part of the error that corrects the tension (integrator.md, eq. I8).
  W upper;    ///< Largest tension [N].
  W tension;  ///< Latest value [N].
};

/// A stiff cable, whose tension is solved together with the contacts.
template <class W>
struct StiffCable : CableRow<W> {
  int cable;
  W across;  ///< Share of the largest stable tension, per tension [1/N] (cables.md, eq. 12).
};

/// A row of a joint, with its direction in W on the joint's body b.
template <class W>
struct HeldRow : JointRow<W> {
  int joint;
  V3<W> lin, turn;
  W held;   ///< Stops: 1 where held, because it pressed in the previous step (joints.md, eq. 4).
  W reach;  ///< Stops: largest approach of the bodies in a step [m].
};

/// Motion of a kinematic body in this step: velocities at the start and the middle, and the end.
template <class W>
struct MotionWork {
  V3<W> v0, w0, v_mid, w_mid;
  Motion<W> end;
};

/// Data of a motor while its cable's tension T is computed: its mean speed over the step is `mean`
/// - `slows` T.
template <class W>
struct MotorWork {
  W direction;         ///< 1 winding in, -1 out, 0: friction holds it.
  W mean, slows;       ///< [rad/s], [rad/(s N)]
  W end, end_slows;    ///< The same for the speed at the end of the step.
  W share;             ///< Share of the cable's law within this step (motor.md, eq. M.9).
  W duty, duty_falls;  ///< The duty is `duty` - `duty_falls` times the mean speed. [1], [s/rad]
  W resistance;        ///< Of winding and driver [ohm].
  W conducts;          ///< 1, or 0 where the driver is off.
  W length;            ///< Of its cable at the middle of the step [m].
};

template <class W>
struct Scratch {
  BodyWork<W>* bodies;
  Spot<W>* spots;
  AttachmentWork<W>* attachments;
  Wheel<V3<W>>* wheels;       ///< Of one cable.
  Row<RodLine<W>> rod_lines;  ///< Rods that one cable may touch,
  Row<W> rod_sides;           ///< and its new side of each (cable_rods.inl).
  Contact<W, 1>* contacts;    ///< Slots of all bodies; body b: from View::first_slot[b] on.
  int* contact_count;         ///< Used slots, per body.
  TouchingPair* touches;      ///< List of a lane: from lane * pair_capacity on.
  int touch_count[W::kLanes];
  int bends_used = 0;  ///< By the last cable that was measured (cable_bends.inl).
  /// Bit mask of the lanes in which a cable exceeds kMostBends, and that cable.
  uint32_t no_room = 0;
  int crowded_cable[W::kLanes];
  /// Bit mask of the lanes in which a turning rod carries a bend too far in a step; the cable.
  uint32_t walked_far = 0;
  int walked_cable[W::kLanes];
  void WalkedFar(int cable, int in_lane) noexcept {
    walked_far |= 1u << in_lane;
    walked_cable[in_lane] = cable;
  }
  V3<W>* start_spots;  ///< Spots at the start of the step [m], if start_known.
  W* start;  ///< Rows that return to the start of the step in worlds that become non-finite.
  CableWork<W>* cables;
  StiffCable<W>* stiff;
  Row<Link<W, 1>> links;    ///< Of all cables.
  ChainSpan<W>* spans;      ///< Of all cables with friction.
  AcrossWork<W>* across;    ///< Of all their slip places.
  RowLink<W>* chain_links;  ///< Links of a cable: from its first_link on,
  int* chain_link_count;    ///< and their number; per cable.
  HeldRow<W>* joints;       ///< Rows of all joints.
  JointMemory<W> joint_memory;
  MotionWork<W>* motions;
  MotorWork<W>* motors;
  W* supplies;        ///< Voltage under load, per supply [V].
  uint64_t* near;     ///< One bit for each of the world's shapes, if they are in a BVH.
  uint32_t* touched;  ///< Per point: bit mask of lanes where its shape is near ground.
  W* unsolved;        ///< Per body: 1 in lanes left to the lane-by-lane solve.
  LaneMemory<simd::Lane<W>> lane;
  DualMemory<W> dual;
  ImplicitMemory<W> implicit;
  int stiff_count = 0, link_count = 0;
  bool start_known = false;

  /// Overwrites all memory that the pointers refer to.
  void Fill(const View& m, unsigned char byte) noexcept {
    room_.Fill(byte);
    Scratch(m, room_.memory);
  }

  static size_t Bytes(const View& m) noexcept { return Scratch(m, nullptr).room_.used; }

  Scratch(const View& m, void* memory) noexcept : room_{static_cast<char*>(memory), 0} {
    const int bodies_count = m.body_count + 1;
    bodies = room_.Take<BodyWork<W>>(bodies_count);
    spots = room_.Take<Spot<W>>(m.spot_count);
    start_spots = room_.Take<V3<W>>(m.spot_count);
    attachments = room_.Take<AttachmentWork<W>>(m.max_attachments);
    wheels = room_.Take<Wheel<V3<W>>>(m.max_wheels);
    rod_lines = room_.Take<RodLine<W>>(m.MostTouchRods());
    rod_sides = room_.Take<W>(m.MostTouchRods());
    contacts = room_.Take<Contact<W, 1>>(m.slot_count);
    contact_count = room_.Take<int>(bodies_count);
    touches = room_.Take<TouchingPair>(W::kLanes * m.pair_capacity);
    int start_rows = 0;
    for (const RowInfo& row : kStateRows) {
      if (row.halted == Halted::kGoesBack) start_rows += row.width * m.Count(row.per);
    }
    start = room_.Take<W>(start_rows);
    cables = room_.Take<CableWork<W>>(m.cable_count);
    stiff = room_.Take<StiffCable<W>>(m.cable_count);
    links = room_.Take<Link<W, 1>>(m.CableLinkCapacity(W::kLanes));
    spans = room_.Take<ChainSpan<W>>(m.span_count);
    across = room_.Take<AcrossWork<W>>(m.slip_count);
    chain_links = room_.Take<RowLink<W>>(m.chain_link_count);
    chain_link_count = room_.Take<int>(m.chain_count > 0 ? m.cable_count : 0);
    joints = room_.Take<HeldRow<W>>(m.joint_row_count);
    joint_memory.Take(m, room_);
    motions = room_.Take<MotionWork<W>>(m.motion_count);
    motors = room_.Take<MotorWork<W>>(m.motor_count);
    supplies = room_.Take<W>(m.supply_count);
    touched = room_.Take<uint32_t>(m.has_ground ? m.first_point[m.body_count] : 0);
    unsolved = room_.Take<W>(bodies_count);
    near = room_.Take<uint64_t>((m.tree_shapes + 63) / 64);
    lane.Take(m, room_);
    dual.Take(m, room_);
    implicit.Take(m, room_);
  }

  /// Returns false if the lane's list is full.
  bool AddTouch(const View& m, int lane_number, int pair, const TouchPoint& point) noexcept {
    int& count = touch_count[lane_number];
    if (count == m.pair_capacity) return false;
    touches[lane_number * m.pair_capacity + count++] = {pair, point};
    return true;
  }

 private:
  Room room_;
};

}  // namespace taut::sim
