/// How worlds of one experiment may differ: factors on the model, other starts.
#pragma once

#include <vector>

namespace taut {

/// A factor on a parameter of the model as compiled, for what is not known for sure.
struct ScaleSpec {
  enum class Quantity { kFriction, kMass, kStiffness, kDamping };
  Quantity quantity = Quantity::kFriction;
  std::vector<int> index;  ///< Bodies or cables; empty: all.
  double factor = 1.0;     ///< > 0.
};

/// How far the start is from what is described; drawn from the seed, evenly.
struct StartNoise {
  /// The whole robot by up to this along x and along y, either way, and as much upwards or
  /// downwards as the highest of what is below it; a goal goes along.
  double place_m = 0.0;
  double position_m = 0.0;   ///< Each body by up to this along x and y, and upwards.
  double heading_rad = 0.0;  ///< The whole robot about the vertical, by up to this either way.
  double goal_rad = 0.0;     ///< The goal about the vertical through W's origin, likewise.
  bool any_pose = false;     ///< The whole robot turned about its centre of mass, anyhow.
};

/// By how much worlds differ that are drawn, evenly.
struct VariationSpec {
  double friction = 0, mass = 0, stiffness = 0, damping = 0;  ///< Factors within 1 +- this.
  StartNoise start;
};

}  // namespace taut
