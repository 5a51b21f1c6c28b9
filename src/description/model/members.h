/// Stiffness, rest length and mass of members from their sections.
#pragma once

#include "description/model/build.h"

namespace taut::description {

/// Numbers of a bar or a cable; NaN if one of their inputs had an error.
struct Elastic {
  double stiffness_n_per_m, rest_length_m, mass_kg;
};
/// Computes the numbers of a member whose length in the described pose is `length_m`. With the
/// axial rigidity E A of the section, the stiffness is E A / L with the unstressed length L, so
/// that a force T in the described pose gives L = l / (1 + T / (E A)).
Elastic ElasticOf(const BarText& bar, double length_m);
Elastic ElasticOf(const CableText& cable, double length_m);

/// Fills `lump_kg` of `assignment`: half of each member's mass at each end.
void LumpMembers(const ModelText& model, const Assembly& assembly, Assignment& assignment);

}  // namespace taut::description
