/// Contacts during a step, and their memory for the next one: key, force and slip, for warm starts
/// (docs/theory/contact.md, section 7).
///
/// A contact of a body with static geometry occupies a slot of the body. In each lane, slot k
/// contains the k-th contact of the body, independent of other lanes. Contacts between moving
/// bodies form a separate list per lane.
#pragma once

#include "sim/constraint/contact_point.h"
#include "sim/data/group.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

template <class Num, int kLinks>
struct Contact : ContactPoint<Num, kLinks> {
  Num key;    ///< Key of the contact (pair and feature); identifies its memory in the next step.
  Num frame;  ///< Contacts with equal numbers have equal directions.
  Num gap;    ///< Gap at the middle of the step [m].
  Num deep;  ///< Penetration depth left for position projection (contact.md, eq. 7), < 0 [m]; or 0.
  Num lands;            ///< 1 if the contact closes faster than the forces of this step explain.
  Num radius;           ///< Distance from the skeleton of the shape to its surface [m].
  bool directed;        ///< In some lane, tangents have other lengths than 1 (friction.inl).
  bool upright;         ///< The directions are z, x and y in all lanes.
  V3<Num> arm[kLinks];  ///< Lever arm from the center of mass [m].
  Num static_friction, kinetic_friction;
  Num patch;  ///< Patch (contact manifold) during the fit of biases.
  Num slip;   ///< 1 if the contact slides, 0 if it sticks.
};

/// Data of a contact for the next step: force for the warm start, and whether it slid.
template <class Num>
struct ContactMemory {
  V3<Num> force;  ///< Contact force [N]; 0 if there is none.
  Num slip;

  static ContactMemory None() noexcept {
    const Num zero = Num::Splat(0.0);
    return {{zero, zero, zero}, Num::Splat(kSlipUnknown)};
  }
};

/// Contact of two moving shapes in one lane.
struct TouchingPair {
  int a, b;           ///< Indices of the shapes.
  std::uint32_t key;  ///< Key of the first possible contact of the two shapes.
  TouchPoint point;
};

}  // namespace taut::sim
