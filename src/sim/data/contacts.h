/// Contacts while a step runs, and what they remember from step to step (docs/theory/contact.md,
/// section 7).
///
/// A contact of a body with what does not move lies in one of the body's slots: slot k of a lane is
/// that lane's k-th contact of the body, whatever the other lanes touch. Contacts of two moving
/// bodies are a list of each lane's own.
#pragma once

#include "sim/constraint/contact_point.h"
#include "sim/data/group.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

template <class Num, int kLinks>
struct Contact : ContactPoint<Num, kLinks> {
  Num key;              ///< Pair and feature: finds the memory again.
  Num frame;            ///< Contacts with equal numbers have the same directions.
  Num gap;              ///< At the middle of the step [m].
  Num deep;             ///< What velocities leave of it for displacements, below 0 [m]; or 0.
  Num lands;            ///< 1 if it closes faster than this step's forces make it.
  Num radius;           ///< From the shape's skeleton to its surface [m].
  bool directed;        ///< In some lane its tangents are not of length 1 (friction.inl).
  bool upright;         ///< Its directions are z, x and y, in all lanes.
  V3<Num> arm[kLinks];  ///< From the centre of mass [m].
  Num static_friction, kinetic_friction;
  Num patch;  ///< While biases are fitted: in which state it is.
  Num slip;   ///< 1 if it slides, 0 if it sticks.
};

/// What a contact remembers of the step before.
template <class Num>
struct ContactMemory {
  V3<Num> force;  ///< [N]; 0 if there was none.
  Num slip;

  static ContactMemory None() noexcept {
    const Num zero = Num::Splat(0.0);
    return {{zero, zero, zero}, Num::Splat(kSlipUnknown)};
  }
};

/// Two moving shapes that touch in one lane.
struct TouchingPair {
  int pair;  ///< ShapePairTable.
  TouchPoint point;
};

}  // namespace taut::sim
