/// Domain randomization: factors on model parameters, and noise of the start.
#pragma once

#include <vector>

namespace taut {

/// Factor on a parameter of the compiled model, for uncertain parameters.
struct ScaleSpec {
  enum class Quantity { kFriction, kMass, kStiffness, kDamping };
  Quantity quantity = Quantity::kFriction;
  std::vector<int> index;  ///< Bodies or cables; empty: all.
  double factor = 1.0;     ///< > 0.
};

/// Noise of the start, relative to the described start; uniform, drawn from the seed.
struct StartNoise {
  /// Displacement of the whole robot along x and along y, up to this in both directions [m]. Its
  /// height changes with the highest terrain below it; a goal moves with it.
  double place_m = 0.0;
  double position_m = 0.0;  ///< Displacement of each body, up to this along x, y and upward.
  /// Rotation of the whole robot about the vertical, up to this in both directions.
  double heading_rad = 0.0;
  double goal_rad = 0.0;  ///< Rotation of the goal about the vertical through W's origin, likewise.
  bool any_pose = false;  ///< Uniform random rotation of the whole robot about its center of mass.
};

/// Ranges of random worlds, uniform.
struct VariationSpec {
  double friction = 0, mass = 0, stiffness = 0, damping = 0;  ///< Factors within 1 +- this.
  StartNoise start;
};

}  // namespace taut
