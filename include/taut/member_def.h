/// Cross section, material and limits of a cable, bar or rod, for `taut/analysis.h`.
#pragma once

namespace taut {

/// Mass distribution of a member in modal analysis. In simulations, the mass is always lumped.
enum class MemberMass {
  kLumped,      ///< Half the mass at each end.
  kConsistent,  ///< Distributed along the member, with linear displacements between its ends.
};

/// Cross section and limits of a member; 0: unknown. Simulations do not use these values; they use
/// the stiffnesses and masses that the model stores elsewhere.
struct MemberDef {
  double area_m2 = 0.0;            ///< Cross-sectional area, >= 0.
  double young_pa = 0.0;           ///< Young's modulus E, >= 0.
  double second_moment_m4 = 0.0;   ///< Smallest second moment of area, for the Euler load, >= 0.
  double buckling_length_m = 0.0;  ///< Distance between points with lateral support, >= 0.
  double yield_pa = 0.0;           ///< Yield stress in tension and compression, >= 0.
  double strength_n = 0.0;         ///< Breaking force in tension, >= 0.
  double expansion_per_k = 0.0;    ///< Coefficient of thermal expansion.
  /// Mass of a cable or bar, >= 0. Each of the bodies at its two ends includes half of this mass.
  double mass_kg = 0.0;
  MemberMass mass = MemberMass::kLumped;
  bool operator==(const MemberDef&) const = default;
};

}  // namespace taut
