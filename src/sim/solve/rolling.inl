/// Rolling on a kinematic or jointed body (ShapePairTable::rolls; docs/theory/motion.md, eq. 4a):
/// the tangential velocity is zero at the final contact point of the step.
///
/// The final contact point depends on the unknown velocities. So fixed-point rounds solve the
/// island with the biases of the last velocities and a warm start until the biases converge: each
/// round leaves a share h |w| / 2 of the error, w the motion's angular velocity.
#pragma once

#include "simd/vec3.h"

namespace taut::sim {

using simd::V3;

/// One body of a rolling contact.
template <class L>
struct RollingSide {
  V3<L> x_end;     ///< Origin at the end of the step.
  V3<L> v, w;      ///< Velocities there.
  V3<L> arm;       ///< From the origin to the contact point, at the middle of the step.
  V3<L> skeleton;  ///< From the origin to the center of curvature of a round shape.
  L radius;        ///< From the center of curvature to the contact point.
  bool is_round;

  /// Rotates a body-fixed vector to the end of the step.
  V3<L> Turned(const V3<L>& a, L half_h) const noexcept {
    const V3<L> once = half_h * Cross(w, a);
    return a + once + L::Splat(0.5) * half_h * Cross(w, once);
  }
  V3<L> SkeletonAtEnd(L half_h) const noexcept { return x_end + Turned(skeleton, half_h); }
};

/// Returns the contact point at the end of the step, from a's origin at its middle. `b_from_a`: b's
/// origin at the middle; `normal`: from b to a.
template <class L>
V3<L> PointAtEnd(const RollingSide<L>& a, const RollingSide<L>& b, const V3<L>& b_from_a,
                 const V3<L>& normal, L half_h) noexcept {
  if (a.is_round && b.is_round) {
    const L share = a.radius / (a.radius + b.radius);
    return (L::Splat(1.0) - share) * a.SkeletonAtEnd(half_h) +
           share * (b_from_a + b.SkeletonAtEnd(half_h));
  }
  // The other side is flat; its normal rotates with it.
  return a.is_round ? a.SkeletonAtEnd(half_h) - a.radius * b.Turned(normal, half_h)
                    : b_from_a + b.SkeletonAtEnd(half_h) + b.radius * a.Turned(normal, half_h);
}

}  // namespace taut::sim
