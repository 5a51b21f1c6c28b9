/// Struts (bodies that are one straight rod): axial forces, and reactions of anchored bodies, by
/// the laws of docs/theory/loads.md. For runs and descriptions.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "math/vec.h"
#include "taut/loads.h"

namespace taut::mechanics {

/// Uniform rod with at most a point mass at each end. The mass fractions stay the same if the mass
/// of the body is scaled.
struct Strut {
  int body = 0;
  Vec3 middle_arm_m;                ///< Relative to the center of mass, in W at t = 0.
  Vec3 along;                       ///< Unit vector from start to end, in W at t = 0.
  double length_m = 0.0;            ///< Length of the capsule's axis.
  double rod = 1.0;                 ///< Fraction of the mass that is distributed along the rod.
  double at_start = 0.0;            ///< Fraction of the mass at the start.
  double at_end = 0.0;              ///< Fraction of the mass at the end.
  double lower = 0.5, upper = 0.5;  ///< Fractions of the mass in both halves of the rod.
  double apart_m = 0.0;             ///< Distance between the centers of mass of the halves.
};

/// Returns the strut. Returns nothing if the body is not a strut or its inertia does not determine
/// its mass distribution.
std::optional<Strut> StrutOf(const ModelDef& def, int body);

/// Pose and angular velocity of a body.
struct BodyMoment {
  Vec3 position_m;                  ///< Position of the center of mass, in W.
  Quat orientation;                 ///< Rotation from the orientation at t = 0.
  Vec3 angular_velocity_rad_per_s;  ///< Angular velocity, in W.
};

/// Returns the axial force: eq. 4 in the middle, eq. 6 along the strut. `forces`: on all bodies,
/// without weights.
AxialForce AxialForceOf(const Strut& strut, double mass_kg, const BodyMoment& moment,
                        const std::vector<BodyForce>& forces);

/// Returns the forces of a joint on both bodies. The force on b acts at its joint point. The
/// opposite force on a acts at the same point, or for a distance joint at a's joint point. Points
/// are in the current pose.
inline std::array<BodyForce, 2> JointForces(const JointDef& joint, const JointLoad& on_b,
                                            const Vec3& from_m, const Vec3& to_m) {
  const Vec3 at_a = joint.kind == JointKind::kDistance ? from_m : to_m;
  return {{{joint.body_a, at_a, -1.0 * on_b.force_n, -1.0 * on_b.torque_n_m},
           {joint.body_b, to_m, on_b.force_n, on_b.torque_n_m}}};
}

/// Returns the reaction of an anchored body about `origin_m` (eq. 8): minus all loads on it,
/// including its weight.
Reaction ReactionOf(int body, const Vec3& origin_m, const Vec3& weight_n,
                    const std::vector<BodyForce>& forces);

}  // namespace taut::mechanics
