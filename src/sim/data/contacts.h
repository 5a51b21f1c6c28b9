/// Contacts during a step, and their memory for the next one: key, force and slip, for warm starts
/// (docs/theory/contact.md, section 7).
///
/// A contact of a body with static geometry occupies one of the body's slots: slot k of a lane is
/// the lane's k-th contact of the body, independent of the other lanes. Contacts of two moving
/// bodies form a separate list for each lane.
#pragma once

#include "sim/constraint/contact_point.h"
#include "sim/data/group.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

template <class Num, int kLinks>
struct Contact : ContactPoint<Num, kLinks> {
  Num key;     ///< Key of a contact (pair and feature): finds its memory in the next step.
  Num frame;   ///< Contacts with equal numbers have the same directions.
  Num gap;     ///< At the middle of the step [m].
  Num deep;    ///< Depth that remains for position projection (contact.md, eq. 7), < 0 [m]; or 0.
  Num lands;   ///< 1 if it closes faster than this step's forces explain.
  Num radius;  ///< From the shape's skeleton to its surface [m].
  bool directed;        ///< In some lane, tangent lengths differ from 1 (friction.inl).
  bool upright;         ///< Its directions are z, x and y, in all lanes.
  V3<Num> arm[kLinks];  ///< From the center of mass [m].
  Num static_friction, kinetic_friction;
  Num patch;  ///< Its patch (contact manifold) while biases are fitted.
  Num slip;   ///< 1 if it slides, 0 if it sticks.
};

/// Data of a contact that the next step uses: warm start of its force, and whether it slid.
template <class Num>
struct ContactMemory {
  V3<Num> force;  ///< [N]; 0 if there was none.
  Num slip;

  static ContactMemory None() noexcept {
    const Num zero = Num::Splat(0.0);
    return {{zero, zero, zero}, Num::Splat(kSlipUnknown)};
  }
};

/// Contact of two moving shapes in one lane.
struct TouchingPair {
  int pair;  ///< Index in View::shape_pairs.
  TouchPoint point;
};

}  // namespace taut::sim
