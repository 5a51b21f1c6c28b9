/// What follows from a member's section: stiffness and mass.
#pragma once

#include "description/model/build.h"

namespace taut::description {

/// A bar's or a cable's numbers; NaN where something that they need was complained about.
struct Elastic {
  double stiffness_n_per_m, rest_length_m, mass_kg;
};
/// `length_m`: as described. With E A of the section the stiffness is E A / L, L the length without
/// stress, so that a force T as described makes L = l / (1 + T / (E A)).
Elastic ElasticOf(const BarText& bar, double length_m);
Elastic ElasticOf(const CableText& cable, double length_m);

/// Fills `lump_kg` of `assignment`.
void LumpMembers(const ModelText& model, const Assembly& assembly, Assignment& assignment);

}  // namespace taut::description
