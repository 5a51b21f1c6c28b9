#include "rollout/vary.h"

#include <utility>

namespace taut::rollout {

void Vary(const VariationSpec& by, math::Random random, RolloutWorld& world) {
  world.start_noise.place_m += by.start.place_m;
  world.start_noise.position_m += by.start.position_m;
  world.start_noise.heading_rad += by.start.heading_rad;
  world.start_noise.goal_rad += by.start.goal_rad;
  world.start_noise.any_pose |= by.start.any_pose;
  using Quantity = ScaleSpec::Quantity;
  for (const auto& [quantity, share] :
       {std::pair{Quantity::kFriction, by.friction}, std::pair{Quantity::kMass, by.mass},
        std::pair{Quantity::kStiffness, by.stiffness}, std::pair{Quantity::kDamping, by.damping}}) {
    const double factor = random.Uniform(1.0 - share, 1.0 + share);
    if (share > 0) world.scales.push_back({quantity, {}, factor});
  }
}

}  // namespace taut::rollout
