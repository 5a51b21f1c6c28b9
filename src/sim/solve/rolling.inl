/// Rolling on a kinematic body or a body with joints (View::Rolls; docs/theory/motion.md,
/// eq. 4a): the tangential velocity is zero at the contact point at the end of the step.
///
/// This contact point depends on the unknown velocities. Therefore fixed-point rounds solve the
/// island with biases from the last velocities and a warm start, until the biases converge. Each
/// round reduces the error to a fraction h |w| / 2, where w is the angular velocity of the motion.
#pragma once

#include "simd/vec3.h"

namespace taut::sim {

using simd::V3;

/// Body of a rolling contact.
template <class L>
struct RollingSide {
  V3<L> x_end;     ///< Origin at the end of the step.
  V3<L> v, w;      ///< Velocities at the end of the step.
  V3<L> arm;       ///< Vector from the origin to the contact point, at the middle of the step.
  V3<L> skeleton;  ///< Vector from the origin to the center of curvature of a round shape.
  L radius;        ///< Distance from the center of curvature to the contact point.
  bool is_round;

  /// Rotates a body-fixed vector to the end of the step.
  V3<L> Turned(const V3<L>& a, L half_h) const noexcept {
    const V3<L> once = half_h * Cross(w, a);
    return a + once + L::Splat(0.5) * half_h * Cross(w, once);
  }
  V3<L> SkeletonAtEnd(L half_h) const noexcept { return x_end + Turned(skeleton, half_h); }
};

/// Returns the contact point at the end of the step, relative to a's origin at its middle.
/// `b_from_a`: b's origin at the middle; `normal`: from b to a.
template <class L>
V3<L> PointAtEnd(const RollingSide<L>& a, const RollingSide<L>& b, const V3<L>& b_from_a,
                 const V3<L>& normal, L half_h) noexcept {
  if (a.is_round && b.is_round) {
    const L share = a.radius / (a.radius + b.radius);
    return (L::Splat(1.0) - share) * a.SkeletonAtEnd(half_h) +
           share * (b_from_a + b.SkeletonAtEnd(half_h));
  }
  // The other side is flat, and its normal rotates with it.
  return a.is_round ? a.SkeletonAtEnd(half_h) - a.radius * b.Turned(normal, half_h)
                    : b_from_a + b.SkeletonAtEnd(half_h) + b.radius * a.Turned(normal, half_h);
}

}  // namespace taut::sim
