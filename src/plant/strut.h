/// Bodies that are a single straight rod, and the force along them (docs/theory/loads.md).
#pragma once

#include <optional>
#include <vector>

#include "plant/body_forces.h"

namespace taut::plant {

/// A uniform rod with at most a mass at either end, cut in its middle: the lower half, from the
/// capsule's start to the middle, and the upper one. Shares of the mass, so that a factor on the
/// body's mass changes nothing here.
struct Strut {
  int body = 0;
  BodyPoint middle;
  Vec3 along;            ///< Unit vector from start to end, in W at t = 0.
  double lower = 0.5;    ///< Share of the mass that is in the lower half.
  double upper = 0.5;    ///< In the upper one.
  double apart_m = 0.0;  ///< Between the centres of mass of the halves.
};

/// Nothing if the body is no strut, or its mass cannot be told from its inertia.
std::optional<Strut> StrutOf(const ModelDef& def, int body);

/// Eq. 4: the force in the middle [N], positive in tension. `forces`: on all bodies.
double AxialForce(const Strut& strut, double mass_kg, const BodyState& state,
                  const std::vector<BodyForce>& forces);

}  // namespace taut::plant
