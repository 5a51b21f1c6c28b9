/// Struts: bodies that are one straight rod, their axial forces, and reactions of anchored bodies,
/// by the laws of docs/theory/loads.md, for runs and descriptions.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "math/vec.h"
#include "taut/loads.h"

namespace taut::mechanics {

/// A uniform rod with at most a point mass at each end. Shares of the mass do not change when the
/// body's mass is scaled.
struct Strut {
  int body = 0;
  Vec3 middle_arm_m;                ///< From the center of mass, in W at t = 0.
  Vec3 along;                       ///< Unit vector from start to end, in W at t = 0.
  double length_m = 0.0;            ///< Of the capsule's axis.
  double rod = 1.0;                 ///< Share of the mass distributed along it.
  double at_start = 0.0;            ///< Share at its start,
  double at_end = 0.0;              ///< and at its end.
  double lower = 0.5, upper = 0.5;  ///< Shares of the halves, split at the rod's middle.
  double apart_m = 0.0;             ///< Distance between the centers of mass of the halves.
};

/// Returns the strut, or nothing if the body is not a strut or its inertia does not determine its
/// mass distribution.
std::optional<Strut> StrutOf(const ModelDef& def, int body);

/// Pose and rotation of a body.
struct BodyMoment {
  Vec3 position_m;                  ///< Of the center of mass, in W.
  Quat orientation;                 ///< From the orientation at t = 0.
  Vec3 angular_velocity_rad_per_s;  ///< In W.
};

/// Returns the axial force: eq. 4 in the middle, eq. 6 along the strut. `forces`: on all bodies,
/// without weights.
AxialForce AxialForceOf(const Strut& strut, double mass_kg, const BodyMoment& moment,
                        const std::vector<BodyForce>& forces);

/// Returns the forces of a joint on its bodies: on b at its point, on a the opposite, at a's point
/// for a distance joint, else at b's. The points are in the current pose.
inline std::array<BodyForce, 2> JointForces(const JointDef& joint, const JointLoad& on_b,
                                            const Vec3& from_m, const Vec3& to_m) {
  const Vec3 at_a = joint.kind == JointKind::kDistance ? from_m : to_m;
  return {{{joint.body_a, at_a, -1.0 * on_b.force_n, -1.0 * on_b.torque_n_m},
           {joint.body_b, to_m, on_b.force_n, on_b.torque_n_m}}};
}

/// Returns the reaction of an anchored body (eq. 8): minus all loads on it, its weight included;
/// about `origin_m`.
Reaction ReactionOf(int body, const Vec3& origin_m, const Vec3& weight_n,
                    const std::vector<BodyForce>& forces);

}  // namespace taut::mechanics
