/// Interface for custom friction laws: classes that compute the friction coefficient of each
/// contact once per step.
#pragma once

#include "taut/world_batch.h"

namespace taut {

/// Contact before the solve of a step. SI units, world frame W.
struct FrictionContact {
  int world = 0;
  double time_s = 0;                ///< Time at the start of the step.
  int body_a = 0, body_b = kWorld;  ///< A is a moving body.
  /// Touching surfaces; `ModelDef` contains their names and materials.
  ShapeRef surface_a, surface_b;
  Vec3 point_m;  ///< Contact point in the middle of the step.
  Vec3 normal;   ///< Unit vector from B to A.
  /// Tangential velocity of A relative to B at the contact point: mean over the step, extrapolated
  /// from the previous step.
  Vec3 slip_m_per_s;
  double normal_force_n = 0;  ///< Force in the previous step; 0 for a new contact.
  // Coefficients of these surfaces according to the model's law at this slip velocity, in the
  // direction of largest friction.
  double static_friction = 0;
  double kinetic_friction = 0;
};

/// Base class of custom friction laws. Pass an instance as `WorldBatchOptions::friction` or
/// `RunOptions::friction`. A step evaluates it once per contact before the solve
/// (docs/theory/friction.md, section 4), so the coefficient is constant during the solve. If the
/// coefficient changes much within a step, shorten the step.
/// Threads: all threads of all batches that share an instance call it concurrently. The results are
/// independent of lanes and threads if the coefficient depends only on the argument and on data
/// that stay constant during steps.
class ContactFriction {
 public:
  virtual ~ContactFriction() = default;
  /// Returns the friction coefficient of the contact, sticking or sliding. Negative values count as
  /// 0; a value that is not finite halts the world (`kStatusNonFinite`). On surfaces with
  /// `FrictionDirections`, it applies to the direction of largest friction.
  /// `Parameter::kFrictionScale` multiplies it.
  virtual double Coefficient(const FrictionContact& contact) const noexcept = 0;
};

}  // namespace taut
