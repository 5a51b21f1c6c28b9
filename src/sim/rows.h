/// Typed access to a group's rows, and what a step keeps only while it runs.
#pragma once

#include "base/assert.h"
#include "sim/group.h"
#include "simd/vec3.h"

namespace taut::sim {

using simd::M3;
using simd::Q4;
using simd::S3;
using simd::V3;

/// Elements of one type, one behind the other: a pointer that in builds with assertions knows its
/// end.
template <class T>
class Row {
 public:
  Row() = default;
  TAUT_INLINE Row(T* first, [[maybe_unused]] int count) noexcept : first_(first) {
#ifdef TAUT_ASSERTS
    count_ = count;
#endif
  }
  TAUT_INLINE T& operator[](int i) const noexcept {
#ifdef TAUT_ASSERTS
    TAUT_ASSERT(0 <= i && i < count_);
#endif
    return first_[i];
  }
  TAUT_INLINE T* data() const noexcept { return first_; }

 private:
  T* first_;
#ifdef TAUT_ASSERTS
  int count_;
#endif
};

/// A group's rows as wide numbers: row `pos` of body b is pos[b] (state_rows.h).
template <class W>
struct Rows {
  using Number = W;
  using V3 = simd::V3<W>;
  using Q4 = simd::Q4<W>;

#define TAUT_ROW(name, type, ...) Row<type> name;
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW

  Rows(const View& m, const Layout& l, const Group& g) noexcept {
    W* const base = reinterpret_cast<W*>(g.rows);
    const int contacts = m.ContactCapacity(W::kLanes);
#define TAUT_ROW(name, type, per, ...) \
  name = Row<type>(reinterpret_cast<type*>(base + l.name), m.Count(Per::per, contacts));
    TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
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

/// The Jacobian of a contact's three directions for one body.
template <class W>
struct Lever {
  V3<W> n, t1, t2;  ///< arm x direction [m].
};

/// A contact while a step runs (docs/theory/contact.md). Force on body a, opposite on b.
template <class W>
struct ContactRow {
  int a, b;
  uint32_t id;
  bool breaks_away;  ///< Static friction exceeds kinetic: it matters whether the contact slides.
  bool rebounds;
  V3<W> n, t1, t2;
  W frame;  ///< Contacts with equal numbers have the same directions.
  V3<W> arm_a, arm_b;
  Lever<W> ja, jb;                 ///< arm x direction.
  Lever<W> ga, gb;                 ///< inverse inertia times that.
  W im_a, im_b;                    ///< Inverse masses.
  W live;                          ///< 1 in lanes that have this contact, else 0.
  W gap;                           ///< At the middle of the step [m].
  W wnn, w1n, w2n, w11, w12, w22;  ///< Inverse effective mass, 3x3 [1/kg].
  W inv_nn, p11, p12, p22;         ///< 1 / wnn; inverse of the tangential 2x2.
  W rho1, rho2;                    ///< Step lengths of the sliding iteration [kg].
  W bias;                          ///< Normal velocity to reach is -bias or more [m/s].
  W static_friction, kinetic_friction;
  W mu;      ///< Coefficient of this step.
  W slip;    ///< 1 if it slides, 0 if it sticks.
  W bounce;  ///< Rebound speed due in the next step [m/s], 0: none.
  W restitution;
  W ln, l1, l2;  ///< Impulses [N s].
};

/// An attachment while its cable's force is worked out; its velocity is the expected one.
template <class W>
struct AttachmentWork {
  V3<W> p, v, arm;
  V3<W> u;  ///< Unit vector from the attachment before.
};

/// What a cable does to one body: pulls with tension T as T F at the centre, T Q about it.
template <class W>
struct CableLink {
  int body;
  V3<W> F, Q;  ///< Sum of directions [1], of arm x direction [m].
  V3<W> GQ;    ///< Inverse inertia times Q.
  W im;
};

/// A cable whose tension is found together with the contacts (docs/theory/cables.md, eq. 8-11):
///   T = base + gain dl,  dl: rate after the step
template <class W>
struct StiffCable {
  int cable, first_link, link_count;
  W on;          ///< 1 in lanes in which this cable is stiff.
  W A;           ///< Inverse effective mass along the cable [1/kg].
  W base, gain;  ///< Impulse at dl = 0 [N s], and per dl [kg].
  W inverse;     ///< 1 / (1 + gain A).
  W upper;       ///< Largest impulse [N s].
  W across;      ///< Share of the largest stable tension, per tension [1/N] (eq. 12).
  W lambda;      ///< Impulse [N s].
};

/// The sum of a row's velocities over its bodies: lin . v + ang . w each.
struct NewtonLink {
  int body;
  double lin[3], ang[3];  ///< The row's direction; its lever [m].
  double g[3];            ///< Inverse inertia times lever.
  double im;              ///< Inverse mass [1/kg].
};

/// One unknown: the impulse of a contact's normal or tangent, or of a stiff cable.
struct NewtonRow {
  int first_link, link_count;
};

struct NewtonMemory {
  double *w, *a;  ///< Delassus matrix; that of the linear system. Row by row.
  double *u, *lambda, *delta;
  double *start, *best, *center, *center_u;  ///< Impulses and velocities kept for later.
  NewtonLink* links;
  NewtonRow* rows;
  int* contacts;  ///< Numbers of the lane's contacts,
  int* cables;    ///< and of its stiff cables.
  int capacity;   ///< Rows.
};

/// More unknowns than this (80 contacts) are left to the sweeps.
inline constexpr size_t kMaxNewtonRows = 240;

template <class W>
struct Scratch {
  BodyWork<W>* bodies;
  AttachmentWork<W>* attachments;
  ContactRow<W>* contacts;
  W* start;  ///< Rows that go back to the start of the step in worlds that turn non-finite.
  StiffCable<W>* stiff;
  CableLink<W>* links;  ///< Of all stiff cables.
  NewtonMemory newton;
  int contact_count;
  int plane_count;   ///< Contacts with planes come first,
  int single_count;  ///< then those with other things of the world.
  int stiff_count, link_count;

  /// Overwrites all that the pointers point to.
  void Fill(unsigned char byte) noexcept { __builtin_memset(memory_, byte, used_); }

  static size_t Bytes(const View& m) noexcept { return Scratch(m, nullptr).used_; }

  Scratch(const View& m, void* memory) noexcept : memory_(static_cast<char*>(memory)) {
    const size_t bodies_count = static_cast<size_t>(m.body_count) + 1;
    const size_t cables_count = static_cast<size_t>(m.cable_count);
    const size_t contacts_count = static_cast<size_t>(m.ContactCapacity(W::kLanes));
    bodies = Take<BodyWork<W>>(bodies_count);
    attachments = Take<AttachmentWork<W>>(static_cast<size_t>(m.max_attachments));
    contacts = Take<ContactRow<W>>(contacts_count);
    size_t start_rows = 0;
    for (const RowInfo& row : kStateRows) {
      if (row.halted != Halted::kGoesBack) continue;
      start_rows += static_cast<size_t>(row.width * m.Count(row.per, 0));
    }
    start = Take<W>(start_rows);
    stiff = Take<StiffCable<W>>(cables_count);
    links = Take<CableLink<W>>(static_cast<size_t>(m.attachment_count));
    TakeNewton(3 * contacts_count + cables_count, static_cast<size_t>(m.attachment_count));
    contact_count = plane_count = single_count = stiff_count = link_count = 0;
  }

 private:
  void TakeNewton(size_t wanted, size_t attachments_count) noexcept {
    const size_t rows = wanted < kMaxNewtonRows ? wanted : kMaxNewtonRows;
    newton.capacity = static_cast<int>(rows);
    newton.w = Take<double>(rows * rows);
    newton.a = Take<double>(rows * rows);
    newton.u = Take<double>(rows);
    newton.lambda = Take<double>(rows);
    newton.delta = Take<double>(rows);
    newton.start = Take<double>(rows);
    newton.best = Take<double>(rows);
    newton.center = Take<double>(rows);
    newton.center_u = Take<double>(rows);
    newton.links = Take<NewtonLink>(2 * rows + attachments_count);
    newton.rows = Take<NewtonRow>(rows);
    newton.contacts = Take<int>(rows);
    newton.cables = Take<int>(rows);
  }
  template <class T>
  T* Take(size_t count) noexcept {
    // Without memory only the sizes count: adding to a null pointer would be undefined.
    T* const first = memory_ == nullptr ? nullptr : reinterpret_cast<T*>(memory_ + used_);
    used_ += (count * sizeof(T) + 63) / 64 * 64;
    return first;
  }
  char* memory_;
  size_t used_ = 0;
};

}  // namespace taut::sim
