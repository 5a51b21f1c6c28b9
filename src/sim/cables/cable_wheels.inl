/// Cable wrapping around wheels (math/cable_wheel.h, docs/theory/cables.md, section 4).
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

/// Sets the wheels of a cable from positions `place(spot)` and the angles of the previous step.
template <class W, class Place>
TAUT_INLINE void SetWheels(const View& m, const Rows<W>& s, const CableTable& cable,
                           Wheel<V3<W>>* wheels, const Place& place) noexcept {
  for (int k = 0; k < cable.wheel_count; ++k) {
    const WheelTable& table = m.wheels[cable.first_wheel + k];
    Wheel<V3<W>>& wheel = wheels[k];
    wheel.center = place(table.center_spot);
    wheel.axis = place(table.axis_spot) - wheel.center;
    wheel.radius = W::Splat(table.radius_m);
    wheel.before = s.wheel_angle[cable.first_wheel + k];
    wheel.at = table.at;
  }
}

/// Computes the path points on wheels from the positions of the attachments. Each path point has
/// the velocity of a point fixed to the body of its wheel.
template <class W>
[[gnu::noinline]] void PutOnWheels(const View& m, const Rows<W>& s, const CableTable& cable,
                                   Scratch<W>& work, const Spot<W>* spots,
                                   AttachmentWork<W>* ends) noexcept {
  SetWheels(m, s, cable, work.wheels, [&](int spot) { return spots[spot].p; });
  LayOnWheels(ends, cable.wheel_count, work.wheels);
  for (int k = 0; k < cable.wheel_count; ++k) {
    const WheelTable& table = m.wheels[cable.first_wheel + k];
    const Spot<W>& center = spots[table.center_spot];
    const BodyWork<W>& body = work.bodies[m.spots[table.center_spot].body];
    for (int i = table.at; i < table.at + 2; ++i) {
      ends[i].arm = ends[i].p - (center.p - center.arm);
      ends[i].v = body.v_mid + Cross(body.w_mid, ends[i].arm);
    }
  }
}

/// Stores the wrap angles for the next step.
template <class W>
TAUT_INLINE void KeepWheels(const Rows<W>& s, const CableTable& cable,
                            const Scratch<W>& work) noexcept {
  for (int k = 0; k < cable.wheel_count; ++k) {
    s.wheel_angle[cable.first_wheel + k] = work.wheels[k].angle;
  }
}

/// Returns the length at the start of the step from the attachment positions at that time.
template <class W>
[[gnu::noinline]] W StartLengthOnWheels(const View& m, const Rows<W>& s, Scratch<W>& work,
                                        const CableTable& cable) noexcept {
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  for (int i = 0; i < cable.attachment_count; ++i) {
    work.attachments[i].p = work.start_spots[tables[i].spot];
    work.attachments[i].v = work.attachments[i].p;  // unused
  }
  SetWheels(m, s, cable, work.wheels, [&](int spot) { return work.start_spots[spot]; });
  LayOnWheels(work.attachments, cable.wheel_count, work.wheels);
  return MeasurePath(cable.attachment_count, work.attachments, cable.wheel_count, work.wheels).l;
}

}  // namespace taut::sim
