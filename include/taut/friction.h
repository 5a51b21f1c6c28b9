/// A friction law of one's own: a class that says the coefficient of each contact, once a step.
#pragma once

#include "taut/batch.h"

namespace taut {

/// A contact as a step is about to solve it. SI units, frame W.
struct FrictionContact {
  int world = 0;
  double time_s = 0;                ///< Of the step's start.
  int body_a = 0, body_b = kWorld;  ///< A moves.
  ShapeRef surface_a, surface_b;    ///< Whose surfaces touch: names and materials in `ModelDef`.
  Vec3 point_m;                     ///< Where, at the middle of the step.
  Vec3 normal;                      ///< Unit vector from B to A.
  Vec3 slip_m_per_s;  ///< Velocity of A's point against B's along the surface: expected mean over
                      ///< the step, as the last one went on.
  double normal_force_n = 0;    ///< That pressed A and B together in the last step; 0 in a new
                                ///< contact.
  double static_friction = 0;   ///< What the model's law says of these two surfaces at this slip,
  double kinetic_friction = 0;  ///< in the direction in which it is most.
};

/// Derive from it and give it to `BatchOptions::friction` or `RunOptions::friction`. A step asks
/// once for each contact, before it solves (docs/theory/friction.md, section 4): while a contact is
/// solved its coefficient is a constant, so a law that changes much within a step needs a shorter
/// one.
///
/// Threads: those of the batch call it, several at once; so does every batch that it is given to.
/// A world gives the same bits every time, in any lane and on any number of threads, if what is
/// returned depends on nothing but the argument and on what stays as it is while the batch steps.
class ContactFriction {
 public:
  virtual ~ContactFriction() = default;
  /// The coefficient of the contact, sticking or sliding. Below 0 counts as 0. What is not finite
  /// halts the world (`kStatusNonFinite`). Where surfaces have `FrictionDirections`, it is that of
  /// the direction in which it is most; `Parameter::kFrictionScale` multiplies it.
  virtual double Coefficient(const FrictionContact& contact) const noexcept = 0;
};

}  // namespace taut
