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

/// A group's rows as SIMD numbers: row `pos` of body b is pos[b] (state_rows.h).
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

/// Data of a body during a step. The world has such data, too: identity and zeros.
template <class W>
struct BodyWork {
  M3<W> R;              ///< Rotation R_WP from frame P to W at the middle of the step.
  S3<W> inv_inertia;    ///< Inverse inertia in W [1/(kg m^2)].
  V3<W> v, w;           ///< Current velocities [m/s], [rad/s].
  V3<W> v0, w0;         ///< Velocities before the forces of this step.
  V3<W> v_mid, w_mid;   ///< Means over the step from the latest velocities, for dampers.
  V3<W> force, torque;  ///< Forces of cables, gravity and nodes [N], [N m].
  V3<W> mom_free;       ///< Angular momentum without the impulses of contacts and stiff cables.
  W landed;             ///< 1 where a contact of the body landed in this step.
  W turns;              ///< Bound of the displacement of body points by rotation in this step [m].
  W turned;             ///< Bound of this displacement since the middle of the previous step [m].
};

/// Point of a body to which one or more cables are attached.
template <class W>
struct Spot {
  V3<W> p, arm;  ///< Position in W; vector from the body's center of mass [m].
};

/// Attachment during the computation of its cable's force, with its expected velocity.
template <class W>
using AttachmentWork = PathPoint<V3<W>>;

/// Position of a bend relative to the straight line on its edge or rod (cable_across.inl).
template <class W>
struct AcrossWork {
  W aside;  ///< Axial force per tension, positive along the axis [1].
  W drift;  ///< Axial displacement per slip along the cable [1].
  W far;    ///< Axial distance to the straight position [m].
  W lean;   ///< See Lean::apart [1].
};

/// Center and axis of a rod in W.
template <class W>
struct RodLine {
  V3<W> center, axis;
};

/// Data of a cable during the computation of soft tensions. Members from `links` are used only in
/// worlds with dampers or stiff cables.
template <class W>
struct CableWork {
  MaskOf<W> soft;         ///< Lanes in which the cable is soft.
  W spring;               ///< Spring part of the tension [N].
  W stretch;              ///< Stretch at the middle of the step [m].
  Row<Link<W, 1>> links;  ///< The first `link_count` are used; all cables share the capacity.
  int link_count;
  W A;  ///< Inverse effective mass along the cable [1/kg].
  MaskOf<W> damped;
  W damping;  ///< Damping coefficient [N s/m].
  W share;    ///< Fraction of the error by which the tension is corrected (integrator.md, eq. I8).
  W upper;    ///< Upper limit of the tension [N].
  W tension;  ///< Latest tension [N].
};

/// Stiff cable, solved together with the contacts.
template <class W>
struct StiffCable : CableRow<W> {
  int cable;
  W across;  ///< 1 / (largest stable tension) [1/N] (cables.md, eq. 12).
};

/// Row of a joint. The direction of the row is in W, on body b of the joint.
template <class W>
struct HeldRow : JointRow<W> {
  int joint;
  V3<W> lin, turn;
  /// Joint limits: 1 if the limit is closed, because it had a force in the previous step
  /// (joints.md, eq. 4).
  W held;
  W reach;  ///< Joint limits: largest approach of the bodies in a step [m].
};

/// Motion of a kinematic body in this step: velocities at the start and the middle, pose and
/// velocity at the end.
template <class W>
struct MotionWork {
  V3<W> v0, w0, v_mid, w_mid;
  Motion<W> end;
};

/// Data of a motor during the computation of its cable's tension T. The mean speed over the step is
/// `mean` - `slows` T.
template <class W>
struct MotorWork {
  W direction;       ///< 1: winds in; -1: unwinds; 0: friction holds the rotor.
  W mean, slows;     ///< Coefficients [rad/s], [rad/(s N)].
  W end, end_slows;  ///< The speed at the end of the step is `end` - `end_slows` T.
  W share;  ///< Factor on stiffness and damping of the cable within this step (motor.md, eq. M.9).
  W duty, duty_falls;  ///< The duty is `duty` - `duty_falls` * mean speed. [1], [s/rad]
  W resistance;        ///< Resistance of winding and driver [ohm].
  W conducts;          ///< 1, or 0 where the driver is off.
  W length;            ///< Length of the cable at the middle of the step [m].
};

template <class W>
struct Scratch {
  BodyWork<W>* bodies;
  Spot<W>* spots;
  AttachmentWork<W>* attachments;
  Wheel<V3<W>>* wheels;       ///< Wheels of one cable.
  Row<RodLine<W>> rod_lines;  ///< Rods around which one cable may wrap.
  Row<W> rod_sides;           ///< Side of the cable on each of these rods (cable_rods.inl).
  Contact<W, 1>* contacts;  ///< Slots of all bodies; those of body b start at View::first_slot[b].
  int* contact_count;       ///< Number of used slots per body.
  TouchingPair* touches;    ///< Lists of all lanes; each starts at lane * pair_capacity.
  int touch_count[W::kLanes];
  int bends_used = 0;  ///< Number of bends of the last measured cable (cable_wrapping.inl).
  /// Bit mask of the lanes in which a cable exceeds kMostBends; index of this cable.
  uint32_t no_room = 0;
  int crowded_cable[W::kLanes];
  /// Bit mask of the lanes in which a rotating rod moves a bend too far in a step; index of the
  /// cable.
  uint32_t walked_far = 0;
  int walked_cable[W::kLanes];
  void WalkedFar(int cable, int in_lane) noexcept {
    walked_far |= 1u << in_lane;
    walked_cable[in_lane] = cable;
  }
  V3<W>* start_spots;  ///< Attachment points at the start of the step [m], if start_known.
  W* start;            ///< Rows at the start of the step, to restore worlds that become non-finite.
  CableWork<W>* cables;
  StiffCable<W>* stiff;
  Row<Link<W, 1>> links;    ///< Links of all cables.
  ChainSpan<W>* spans;      ///< Spans of all cables with friction.
  AcrossWork<W>* across;    ///< Data of all slip points of cables.
  RowLink<W>* chain_links;  ///< Links of spans; those of a cable start at its first_link.
  int* chain_link_count;    ///< Number of links of spans per cable.
  HeldRow<W>* joints;       ///< Rows of all joints.
  JointMemory<W> joint_memory;
  MotionWork<W>* motions;
  MotorWork<W>* motors;
  W* supplies;                        ///< Loaded voltage per supply [V].
  uint64_t* near;                     ///< One bit per static shape, if the shapes are in a BVH.
  TreeNode *near_leaves, *near_tree;  ///< BVH of the bodies in each lane (near_bodies.inl).
  uint64_t* near_marks;               ///< One bit per body.
  uint32_t* touched;  ///< Per point: bit mask of lanes where its shape is near a surface.
  W* unsolved;        ///< Per body: 1 in lanes that the lane-by-lane solver must solve.
  LaneMemory<simd::Lane<W>> lane;
  DualMemory<W> dual;
  PrimalMemory<W> primal;
  ImplicitMemory<W> implicit;
  const MovingPair* moving_pairs = nullptr;  ///< Pairs in the order of their clearances.
  int moving_count = 0;
  int stiff_count = 0, link_count = 0;
  bool start_known = false;

  /// Overwrites all memory to which the pointers refer.
  void Fill(const View& m, unsigned char byte) noexcept {
    room_.Fill(byte);
    Scratch(m, room_.memory);
  }

  /// Returns the size of memory for a Scratch and all arrays to which its pointers refer.
  static size_t Bytes(const View& m) noexcept { return Own() + Scratch(m, nullptr).room_.used; }
  /// Divides this memory. It stays divided for all steps of the model: the layout would take a
  /// tenth of a step of a small robot.
  static void LayOut(const View& m, void* memory) noexcept {
    static_assert(__is_trivially_copyable(Scratch));
    *static_cast<Scratch*>(memory) = Scratch(m, static_cast<char*>(memory) + Own());
  }
  /// Returns the Scratch in divided memory, as at the start of a step.
  static Scratch& In(void* memory) noexcept {
    Scratch& work = *static_cast<Scratch*>(memory);
    work.no_room = work.walked_far = 0;
    work.bends_used = work.moving_count = work.stiff_count = work.link_count = 0;
    work.moving_pairs = nullptr;
    work.start_known = false;
    return work;
  }

  /// Adds a contact to the list of a lane. Returns false if the list is full.
  bool AddTouch(const View& m, int lane_number, const ShapePairTable& pair,
                const TouchPoint& point) noexcept {
    int& count = touch_count[lane_number];
    if (count == m.pair_capacity) return false;
    touches[lane_number * m.pair_capacity + count++] = {pair.a, pair.b, pair.id, point};
    return true;
  }

 private:
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
    const int bodies_near = m.near_capacity > 0 ? m.collider_count : 0;
    near_leaves = room_.Take<TreeNode>(bodies_near);
    near_tree = room_.Take<TreeNode>(2 * W::kLanes * bodies_near);
    near_marks = room_.Take<uint64_t>((bodies_near + 63) / 64);
    lane.Take(m, room_);
    dual.Take(m, room_);
    primal.Take(m, room_);
    implicit.Take(m, room_);
  }

  /// Returns the bytes for the object itself.
  static size_t Own() noexcept { return (sizeof(Scratch) + 63) / 64 * 64; }
  Room room_;
};

}  // namespace taut::sim
