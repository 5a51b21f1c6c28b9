/// Interface for custom friction laws: a class that returns the friction coefficient of each
/// contact, once per step.
#pragma once

#include "taut/world_batch.h"

namespace taut {

/// Contact before a step solves it. SI units, frame W.
struct FrictionContact {
  int world = 0;
  double time_s = 0;                ///< Start of the step.
  int body_a = 0, body_b = kWorld;  ///< A moves.
  ShapeRef surface_a, surface_b;    ///< Touching surfaces: names and materials are in `ModelDef`.
  Vec3 point_m;                     ///< Contact point at the middle of the step.
  Vec3 normal;                      ///< Unit vector from B to A.
  /// Tangential velocity of A's point relative to B's: mean over the step, extrapolated from the
  /// previous step.
  Vec3 slip_m_per_s;
  double normal_force_n = 0;  ///< In the last step; 0 in a new contact.
  // Coefficients of these surfaces by the model's law at this slip, in the direction in which they
  // are largest.
  double static_friction = 0;
  double kinetic_friction = 0;
};

/// Base class of custom friction laws. Pass an instance as `WorldBatchOptions::friction` or
/// `RunOptions::friction`. A step evaluates it once per contact, before the solve
/// (docs/theory/friction.md, section 4), so the coefficient is constant during the solve; a law
/// that changes much within a step needs a shorter step.
///
/// Threads: all threads of a batch call it concurrently, and so does every batch that shares it.
/// Results are bit-identical in any lane and on any number of threads if the return value depends
/// only on the argument and on data that are constant while the batch steps.
class ContactFriction {
 public:
  virtual ~ContactFriction() = default;
  /// Returns the coefficient of the contact, sticking or sliding. Negative values count as 0; a
  /// value that is not finite halts the world (`kStatusNonFinite`). On surfaces with
  /// `FrictionDirections` it is the coefficient of the direction in which friction is largest.
  /// `Parameter::kFrictionScale` multiplies it.
  virtual double Coefficient(const FrictionContact& contact) const noexcept = 0;
};

}  // namespace taut
