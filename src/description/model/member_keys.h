/// The keys of what members are made of and bear, and those of a bar.
#pragma once

#include "description/model/model_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

enum class MemberOf { kRod, kCable, kBar };

/// Where a stiffness follows from the section.
inline constexpr const char* kStiffnessRule =
    R"("anyOf": [{"required": ["stiffness_n_per_m"]}, {"required": ["young_pa", "area_m2"]}])";

/// In the map of the member; 0, as all of them are where nothing is said: not known.
template <class Io>
void MemberKeys(Io& io, Like<MemberDef> auto& m, MemberOf of) {
  const bool bends = of != MemberOf::kCable, has_own_mass = of != MemberOf::kRod;
  io("area_m2", m.area_m2, kInherited, LaterThan{0.0}, Bound::kPositive,
     "Area of its cross section.");
  io("young_pa", m.young_pa, kInherited, LaterThan{0.0}, Bound::kPositive, "Young's modulus E.");
  if (bends) {
    io("second_moment_m4", m.second_moment_m4, kInherited, LaterThan{0.0}, Bound::kPositive,
       "Least second moment of its cross section, for Euler's load. Needs `young_pa`.");
    io("buckling_length_m", m.buckling_length_m, kInherited, LaterThan{0.0}, Bound::kPositive,
       "Length between the points that cannot bend aside, for Euler's load. If absent, its "
       "length.");
  }
  io("yield_pa", m.yield_pa, kInherited, LaterThan{0.0}, Bound::kPositive,
     "Stress that it bears, in tension and in compression. Needs `area_m2`.");
  io("strength_n", m.strength_n, kInherited, LaterThan{0.0}, Bound::kPositive,
     "Tension at which it breaks.");
  if (!has_own_mass) return;
  io("expansion_per_k", m.expansion_per_k, LaterThan{0.0}, Bound::kAny,
     "Strain per kelvin, for load cases with a change of temperature.");
  io("mass_kg", m.mass_kg, LaterThan{0.0}, Bound::kNonNegative,
     "Its own mass. The bodies at its two ends get half of it each, at the node.");
  io("mass", m.mass, kMemberMasses, kLater,
     "How modes count its own mass. `lumped`: half of it at each end, as the simulation has it. "
     "`consistent`: spread along it, which moves as its ends do.");
}

template <class Io>
void DensityKey(Io& io, Like<std::optional<double>> auto& density_kg_per_m3) {
  io("density_kg_per_m3", density_kg_per_m3, Bound::kNonNegative,
     "Instead of `mass_kg`: its density. The mass is that times `area_m2` times the length without "
     "stress.");
}

template <class Io>
void Keys(Io& io, Like<BarText> auto& b) {
  io.Map("bar", "builder.bar",
         "An elastic bar along a pair: it pulls and pushes along the line between its nodes with k "
         "(l - L) + b dl/dt, where L is its length without stress, and it touches nothing. A node "
         "where bars and cables alone end is a point that weighs half of each of them. One of "
         "`prestress_n`, `rest_length_m` and `rest_length_ratio` may say L; if none does, it is "
         "without stress as described.",
         R"({"young_pa": 70e9, "area_m2": 1e-4, "density_kg_per_m3": 2700})");
  io.Rule(kStiffnessRule);
  io("stiffness_n_per_m", b.stiffness_n_per_m, Bound::kPositive,
     "k. If absent, E A / L, of `young_pa` and `area_m2` and the length L without stress.");
  io("damping_n_s_per_m", b.damping_n_s_per_m, Bound::kNonNegative, "b.");
  io("rest_length_m", b.rest_length_m, Bound::kPositive, "Its length without stress.");
  io("rest_length_ratio", b.rest_length_ratio, Bound::kPositive,
     "Its length without stress over its length as described.");
  io("prestress_n", b.prestress_n, Bound::kAny,
     "Its force as described, at rest: positive where it pulls, negative where it pushes.");
  MemberKeys(io, b.member, MemberOf::kBar);
  DensityKey(io, b.density_kg_per_m3);
}
void Check(const MapReader& map, BarText& bar);

/// Complains about a member of which nobody knows how stiff it is.
void CheckStiffness(const MapReader& map);
/// Complains about what does not go together: of the section, and of its own mass.
void CheckSection(const MapReader& map, MemberOf of);
void CheckOwnMass(const MapReader& map, const MemberDef& member,
                  const std::optional<double>& density_kg_per_m3);

}  // namespace taut::description
