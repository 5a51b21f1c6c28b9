/// Stiffness, rest length and mass of members from their sections.
#pragma once

#include "description/model/build.h"

namespace taut::description {

/// Elastic properties of a bar or a cable; NaN if an input had an error.
struct Elastic {
  double stiffness_n_per_m, rest_length_m, mass_kg;
};
/// Computes the elastic properties of a member with length `length_m` in the described pose. If the
/// section has the axial rigidity E A, the stiffness is E A / L with the rest length L. For a
/// tension T in the described pose, L = l / (1 + T / (E A)).
Elastic ElasticOf(const BarText& bar, double length_m);
Elastic ElasticOf(const CableText& cable, double length_m);

/// Computes `lump_kg` of `assignment`: half of each member's mass at each of its ends.
void LumpMembers(const ModelText& model, const Assembly& assembly, Assignment& assignment);

}  // namespace taut::description
