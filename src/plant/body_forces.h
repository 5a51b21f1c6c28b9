/// Forces on the bodies of a simulated plant, without weights, and their points of application.
#pragma once

#include <vector>

#include "math/cable_path.h"
#include "math/vec.h"
#include "mechanics/strut.h"
#include "taut/loads.h"
#include "taut/plant.h"

namespace taut::plant {

/// Point of a body or of the world. `arm_m`: vector from the center of mass at t = 0, in W; for the
/// world, the position.
struct BodyPoint {
  int body = kWorld;
  Vec3 arm_m;
};
inline Vec3 PlaceOf(const BodyPoint& point, const BodyState& state) {
  return state.position_m + Rotate(state.orientation, point.arm_m);
}

inline mechanics::BodyMoment MomentOf(const World& world, int body, int lane = 0) {
  const BodyState now = world.Body(lane, body);
  return {now.position_m, now.orientation, now.angular_velocity_rad_per_s};
}

/// Returns the joints of a model with `from_m` and `to_m` relative to the centers of mass.
std::vector<JointDef> JointsByArms(const ModelDef& def);

/// Gathers the forces on the bodies of a lane. Cable forces are computed from tension readings
/// (docs/theory/loads.md, eq. 1). Forces of contacts and joints and at nodes are means over the
/// last step.
class BodyForces {
 public:
  explicit BodyForces(const ModelDef& def);

  /// Returns the forces in a fixed order. The result is valid until the next call.
  const std::vector<BodyForce>& Gather(const Observation& exact, const World& world, int lane = 0);

 private:
  /// Points of each cable; empty for cables whose path is read from the world (wheels, friction,
  /// wrapping).
  std::vector<std::vector<BodyPoint>> cables_;
  std::vector<int> bodies_of_nodes_;
  std::vector<JointDef> joints_;  ///< Result of `JointsByArms`.
  std::size_t body_count_;
  std::vector<BodyState> states_;
  std::vector<PathPoint<Vec3>> path_;
  std::vector<BodyForce> forces_;
};

}  // namespace taut::plant
