/// Domain randomization: factors on model parameters, and start noise.
#pragma once

#include <vector>

namespace taut {

/// Factor on an uncertain parameter of the compiled model.
struct ScaleSpec {
  enum class Quantity { kFriction, kMass, kStiffness, kDamping };
  Quantity quantity = Quantity::kFriction;
  std::vector<int> index;  ///< Indices of bodies or cables; empty: all.
  double factor = 1.0;     ///< Factor on the quantity, > 0.
};

/// Noise of the start: uniform random deviations from the described start, drawn from the seed.
struct StartNoise {
  /// Largest displacement of the whole robot along +-x and +-y [m]. The height of the robot follows
  /// the highest terrain below it, and a goal moves with the robot.
  double place_m = 0.0;
  double position_m = 0.0;  ///< Largest displacement of each body along +-x, +-y and upward.
  /// Largest rotation of the whole robot about the vertical, in both directions.
  double heading_rad = 0.0;
  /// Largest rotation of the goal about the vertical through the origin of W, in both directions.
  double goal_rad = 0.0;
  /// Random orientation of the whole robot about its center of mass, uniform over all orientations.
  bool any_pose = false;
};

/// Uniform ranges of random worlds.
struct VariationSpec {
  double friction = 0, mass = 0, stiffness = 0, damping = 0;  ///< Factors: 1 +- this value.
  StartNoise start;
};

}  // namespace taut
