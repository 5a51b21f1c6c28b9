/// Bodies that are a single straight rod and the force along them, and what holds anchored bodies:
/// the laws of docs/theory/loads.md, for moments of a run and for a description.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "math/vec.h"
#include "taut/loads.h"

namespace taut::mechanics {

/// A uniform rod with at most a mass at either end. Shares of the mass, so that a factor on the
/// body's mass changes nothing here.
struct Strut {
  int body = 0;
  Vec3 middle_arm_m;                ///< From the centre of mass, in W at t = 0.
  Vec3 along;                       ///< Unit vector from start to end, in W at t = 0.
  double length_m = 0.0;            ///< Of the capsule's axis.
  double rod = 1.0;                 ///< Share of the mass that is spread along it.
  double at_start = 0.0;            ///< That is at its start,
  double at_end = 0.0;              ///< and at its end.
  double lower = 0.5, upper = 0.5;  ///< In the halves: from the start to the middle, and beyond.
  double apart_m = 0.0;             ///< Between the centres of mass of the halves.
};

/// Nothing if the body is no strut, or its mass cannot be told from its inertia.
std::optional<Strut> StrutOf(const ModelDef& def, int body);

/// Where a body is and how it turns.
struct BodyMoment {
  Vec3 position_m;                  ///< Of the centre of mass, in W.
  Quat orientation;                 ///< From that at t = 0.
  Vec3 angular_velocity_rad_per_s;  ///< In W.
};

/// Eq. 4 in the middle, eq. 6 along all of it. `forces`: on all bodies, without weights.
AxialForce AxialForceOf(const Strut& strut, double mass_kg, const BodyMoment& moment,
                        const std::vector<BodyForce>& forces);

/// What a joint does to its bodies: on b at its point, on a the opposite, at a's point if it is a
/// distance, else where b's is. The points are those of the moment.
inline std::array<BodyForce, 2> JointForces(const JointDef& joint, const JointLoad& on_b,
                                            const Vec3& from_m, const Vec3& to_m) {
  const Vec3 at_a = joint.kind == JointKind::kDistance ? from_m : to_m;
  return {{{joint.body_a, at_a, -1.0 * on_b.force_n, -1.0 * on_b.torque_n_m},
           {joint.body_b, to_m, on_b.force_n, on_b.torque_n_m}}};
}

/// Eq. 8: minus what acts on an anchored body, its weight included; about `origin_m`.
Reaction ReactionOf(int body, const Vec3& origin_m, const Vec3& weight_n,
                    const std::vector<BodyForce>& forces);

}  // namespace taut::mechanics
