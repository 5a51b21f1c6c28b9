/// Typed access to a group's rows, and what a step keeps only while it runs.
#pragma once

#include "sim/contacts.h"
#include "sim/constraint/cable_row.h"
#include "math/cable_path.h"
#include "sim/group.h"
#include "sim/solve/memory.h"
#include "simd/vec3.h"

namespace taut::sim {

using simd::M3;
using simd::Q4;
using simd::S3;
using simd::V3;

/// A group's rows as wide numbers (names as in Layout).
template <class W>
struct Rows {
  W *time, *last_step, *rest, *rest_rate, *target, *mass, *inv_mass, *stiffness, *damping,
      *friction_scale, *tension, *stiff_k, *stiff_b, *halted, *contact_key, *contact_slip,
      *contact_bounce, *contact_gap, *clearance, *residual, *linear_solves, *sense_length, *sense_rate,
      *sense_tension, *sense_elastic;
  V3<W>*pos, *vel, *mom, *old_vel, *old_spin, *node_force, *inertia, *inv_inertia, *gravity,
      *contact_force, *contact_arm, *contact_normal;
  Q4<W>* quat;

  Rows(const Layout& l, const Group& g) noexcept {
    W* const base = reinterpret_cast<W*>(g.rows);
    const auto v3 = [base](int row) { return reinterpret_cast<V3<W>*>(base + row); };
    time = base + l.time;
    last_step = base + l.last_step;
    pos = v3(l.pos);
    quat = reinterpret_cast<Q4<W>*>(base + l.quat);
    vel = v3(l.vel);
    mom = v3(l.mom);
    old_vel = v3(l.old_vel);
    old_spin = v3(l.old_spin);
    rest = base + l.rest;
    rest_rate = base + l.rest_rate;
    target = base + l.target;
    tension = base + l.tension;
    stiff_k = base + l.stiff_k;
    stiff_b = base + l.stiff_b;
    node_force = v3(l.node_force);
    mass = base + l.mass;
    inv_mass = base + l.inv_mass;
    inertia = v3(l.inertia);
    inv_inertia = v3(l.inv_inertia);
    stiffness = base + l.stiffness;
    damping = base + l.damping;
    friction_scale = base + l.friction_scale;
    gravity = v3(l.gravity);
    halted = base + l.halted;
    contact_key = base + l.contact_key;
    contact_force = v3(l.contact_force);
    contact_slip = base + l.contact_slip;
    contact_bounce = base + l.contact_bounce;
    contact_arm = v3(l.contact_arm);
    contact_normal = v3(l.contact_normal);
    contact_gap = base + l.contact_gap;
    clearance = base + l.clearance;
    residual = base + l.residual;
    linear_solves = base + l.linear_solves;
    sense_length = base + l.sense_length;
    sense_rate = base + l.sense_rate;
    sense_tension = base + l.sense_tension;
    sense_elastic = base + l.sense_elastic;
  }
};

/// A body while a step runs. The world has one, too: identity, zero.
template <class W>
struct BodyWork {
  M3<W> R;              ///< R_WP at the middle of the step.
  S3<W> inv_inertia;    ///< In W [1/(kg m^2)].
  V3<W> v, w;           ///< Current velocities [m/s], [rad/s].
  V3<W> v0, w0;         ///< Before this step's forces.
  V3<W> v_mid, w_mid;   ///< Expected at the middle of the step, for dampers.
  V3<W> force, torque;  ///< Of cables, gravity and nodes [N], [N m].
};

/// An attachment while its cable's force is worked out; its velocity is the expected one.
template <class W>
using AttachmentWork = PathPoint<V3<W>>;

/// A cable whose tension is found together with the contacts.
template <class W>
struct StiffCable : CableRow<W> {
  int cable;
  W across;  ///< Share of the largest stable tension, per tension [1/N] (cables.md, eq. 12).
};

template <class W>
struct Scratch {
  BodyWork<W>* bodies;
  AttachmentWork<W>* attachments;
  Contact<W, 1>* contacts;  ///< Slots of all bodies: those of body b from View::first_slot[b] on.
  int* contact_count;       ///< Used slots, per body.
  TouchingPair* touches;           ///< Those of a lane from lane * pair_capacity on.
  int touch_count[W::kLanes];
  V3<W>* saved_pos;  ///< Start of the step, for worlds that turn non-finite.
  Q4<W>* saved_quat;
  V3<W>* saved_vel;
  V3<W>* saved_mom;
  W* saved_rest;
  W* saved_rest_rate;
  StiffCable<W>* stiff;
  Link<W, 1>* links;  ///< Of all stiff cables.
  W* unsolved;        ///< Per body: 1 in lanes in which it is left to the lane's own solve.
  LaneMemory<simd::Lane<W>> lane;
  DualMemory<W> dual;
  int stiff_count = 0, link_count = 0;

  /// Overwrites all that the pointers point to.
  void Fill(unsigned char byte) noexcept { __builtin_memset(room_.memory, byte, room_.used); }

  static size_t Bytes(const View& m) noexcept { return Scratch(m, nullptr).room_.used; }

  Scratch(const View& m, void* memory) noexcept : room_{static_cast<char*>(memory), 0} {
    const int bodies_count = m.body_count + 1;
    bodies = room_.Take<BodyWork<W>>(bodies_count);
    attachments = room_.Take<AttachmentWork<W>>(m.max_attachments);
    contacts = room_.Take<Contact<W, 1>>(m.slot_count);
    contact_count = room_.Take<int>(bodies_count);
    touches = room_.Take<TouchingPair>(W::kLanes * m.pair_capacity);
    saved_pos = room_.Take<V3<W>>(bodies_count);
    saved_quat = room_.Take<Q4<W>>(bodies_count);
    saved_vel = room_.Take<V3<W>>(bodies_count);
    saved_mom = room_.Take<V3<W>>(bodies_count);
    saved_rest = room_.Take<W>(m.cable_count);
    saved_rest_rate = room_.Take<W>(m.cable_count);
    stiff = room_.Take<StiffCable<W>>(m.cable_count);
    links = room_.Take<Link<W, 1>>(m.attachment_count);
    unsolved = room_.Take<W>(bodies_count);
    lane.Take(m, room_);
    dual.Take(m, room_);
  }

  /// False if the lane's list is full.
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
