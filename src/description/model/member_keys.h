/// Keys of members: section, material, strength and mass; and keys of bars.
#pragma once

#include "description/model/model_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

enum class MemberOf { kRod, kCable, kBar };

/// Requires a stiffness, or a section from which it follows.
inline constexpr const char* kStiffnessRule =
    R"("anyOf": [{"required": ["stiffness_n_per_m"]}, {"required": ["young_pa", "area_m2"]}])";

/// Keys of a member. All of them default to 0, which means unknown.
template <class Io>
void MemberKeys(Io& io, Like<MemberDef> auto& m, MemberOf of) {
  const bool bends = of != MemberOf::kCable, has_own_mass = of != MemberOf::kRod;
  io("area_m2", m.area_m2, kInherited, LaterThan{0.0}, Bound::kPositive,
     "Area of the cross section.");
  io("young_pa", m.young_pa, kInherited, LaterThan{0.0}, Bound::kPositive, "Young's modulus E.");
  if (bends) {
    io("second_moment_m4", m.second_moment_m4, kInherited, LaterThan{0.0}, Bound::kPositive,
       "Smallest second moment of area of the cross section, for Euler's buckling load. Requires "
       "`young_pa`.");
    io("buckling_length_m", m.buckling_length_m, kInherited, LaterThan{0.0}, Bound::kPositive,
       "Effective length for Euler's buckling load, between points with lateral support. Default: "
       "the "
       "member's length.");
  }
  io("yield_pa", m.yield_pa, kInherited, LaterThan{0.0}, Bound::kPositive,
     "Yield stress, in tension and in compression. Requires `area_m2`.");
  io("strength_n", m.strength_n, kInherited, LaterThan{0.0}, Bound::kPositive, "Breaking tension.");
  if (!has_own_mass) return;
  io("expansion_per_k", m.expansion_per_k, LaterThan{0.0}, Bound::kAny,
     "Thermal strain per kelvin, for load cases with a change of temperature.");
  io("mass_kg", m.mass_kg, LaterThan{0.0}, Bound::kNonNegative,
     "Mass of the member. Half of this mass is added to the body at each end, at the node.");
  io("mass", m.mass, kMemberMasses, kLater,
     "Mass in modal analysis. `lumped`: half at each end, as in the simulation. `consistent`: "
     "distributed along the member, moving with its ends.");
}

template <class Io>
void DensityKey(Io& io, Like<std::optional<double>> auto& density_kg_per_m3) {
  io("density_kg_per_m3", density_kg_per_m3, Bound::kNonNegative,
     "Density, instead of `mass_kg`. The mass is the density times `area_m2` times the unstressed "
     "length.");
}

template <class Io>
void Keys(Io& io, Like<BarText> auto& b) {
  io.Map(
      "bar", "builder.bar",
      "Elastic bar along a pair: tension or compression k (l - L) + b dl/dt along the line between "
      "its nodes, with the unstressed length L; no contact. A node with bars and cables only is a "
      "point mass with half the mass of each of these bars and cables. At most one of "
      "`prestress_n`, "
      "`rest_length_m` and "
      "`rest_length_ratio` sets L. Default: unstressed in the described pose.",
      R"({"young_pa": 70e9, "area_m2": 1e-4, "density_kg_per_m3": 2700})");
  io.Rule(kStiffnessRule);
  io("stiffness_n_per_m", b.stiffness_n_per_m, Bound::kPositive,
     "Stiffness k. Default: E A / L, from `young_pa`, `area_m2` and the unstressed length L.");
  io("damping_n_s_per_m", b.damping_n_s_per_m, Bound::kNonNegative, "Damping coefficient b.");
  io("rest_length_m", b.rest_length_m, Bound::kPositive, "Unstressed length L.");
  io("rest_length_ratio", b.rest_length_ratio, Bound::kPositive,
     "Unstressed length divided by the length in the described pose.");
  io("prestress_n", b.prestress_n, Bound::kAny,
     "Force at rest in the described pose: positive in tension, negative in compression.");
  MemberKeys(io, b.member, MemberOf::kBar);
  DensityKey(io, b.density_kg_per_m3);
}
void Check(const MapReader& map, BarText& bar);

/// Reports a member without stiffness.
void CheckStiffness(const MapReader& map);
/// Report conflicting keys of the section, or of the member's mass.
void CheckSection(const MapReader& map, MemberOf of);
void CheckOwnMass(const MapReader& map, const MemberDef& member,
                  const std::optional<double>& density_kg_per_m3);

}  // namespace taut::description
