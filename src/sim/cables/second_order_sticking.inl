/// Second-order velocity biases for sticking contacts with the world (docs/theory/contact.md, eq.
/// 12a).
///
/// A contact row constrains the velocity of a point at the middle of the step, but a sticking point
/// moves along an arc until the middle of the next step. The biases compensate for this difference.
/// The biases follow from the two half drifts of the shape's skeleton, with the momentum under the
/// torques of contacts and stiff cables from the previous step.
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

/// Adds the biases to the contacts of one body.
template <class W, class M>
void FollowArcs(const Rows<W>& s, const BodyWork<W>& body, int b, Contact<W, 1>* contacts,
                int count, M lanes, W h) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const W half_h = W::Splat(0.5) * h, sixth_h2 = W::Splat(1.0 / 6.0) * h * h;
  W number = zero;
  V3<W> c{zero, zero, zero};  // mean of the skeleton points
  for (int k = 0; k < count; ++k) {
    number += contacts[k].live;
    c += contacts[k].live * (contacts[k].arm[0] + contacts[k].radius * contacts[k].links[0].lin[0]);
  }
  c = (one / Max(number, one)) * c;
  // Free rotation of the body: w, its derivatives w1 and w2, and the derivatives c1 to c3 of the
  // mean point.
  const S3<W>& inverse = body.inv_inertia;
  const V3<W> L = s.mom[b] + h * s.held_torque[b];
  const V3<W> w = inverse * L;
  const V3<W> torque = Cross(L, w), w1 = inverse * torque, bend = Cross(w, w1);
  const V3<W> w2 = bend + inverse * (Cross(L, w1) - Cross(w, torque));
  const V3<W> c1 = Cross(w, c), c2 = Cross(w1, c) + Cross(w, c1);
  const V3<W> twice = Cross(w1, c1);
  const V3<W> c3 = Cross(w2, c) + (twice + twice) + Cross(w, c2);
  // Until the middle of the next step, the mean point moves by h (w x c + ahead) and the body
  // rotates by h (w + spin). The series fail for rotations of about a radian per step, where `good`
  // is small.
  const W w_w = Dot(w, w), radians4 = (h * h * w_w) * (h * h * w_w);
  const W good = Select(lanes, one / (one + radians4), zero);
  const V3<W> spin = good * (half_h * w1 + sixth_h2 * (w2 - W::Splat(0.5) * bend - w_w * w));
  const V3<W> ahead = good * (half_h * c2 + sixth_h2 * c3) - Cross(spin, c);
  const V3<W> faster = (good * half_h) * w1;
  for (int k = 0; k < count; ++k) {
    Contact<W, 1>& contact = contacts[k];
    const V3<W>* const d = contact.links[0].lin;
    const V3<W> skin = contact.radius * d[0];  // from the surface to the skeleton
    const V3<W> arc = ahead + Cross(spin, contact.arm[0] + skin) - Cross(faster, skin);
    for (int r = 0; r < 3; ++r) {
      if (r == 2 && contact.one_direction) continue;
      contact.bias[r] += Dot(d[r], arc);
    }
  }
}

}  // namespace taut::sim
