/// Cross section, material and limits of a cable, bar or rod, for `taut/analysis.h`.
#pragma once

namespace taut {

/// Distribution of a member's mass in modal analysis. In a step it is always lumped.
enum class MemberMass {
  kLumped,      ///< Half at each end.
  kConsistent,  ///< Distributed along the member, which moves linearly between its ends.
};

/// Section and limits of a member; 0: not known. The step uses none of them: the stiffness and
/// masses that follow from them are stored with the other stiffnesses and masses of the model.
struct MemberDef {
  double area_m2 = 0.0;            ///< Of its cross section, >= 0.
  double young_pa = 0.0;           ///< E, >= 0.
  double second_moment_m4 = 0.0;   ///< Smallest second moment of area, for Euler's load, >= 0.
  double buckling_length_m = 0.0;  ///< Between points with lateral support, >= 0.
  double yield_pa = 0.0;           ///< Yield stress in tension and compression, >= 0.
  double strength_n = 0.0;         ///< Tension at which it breaks, >= 0.
  double expansion_per_k = 0.0;    ///< Coefficient of thermal expansion.
  /// Of a cable or bar: its mass, of which the bodies at its ends contain half each; >= 0.
  double mass_kg = 0.0;
  MemberMass mass = MemberMass::kLumped;
  bool operator==(const MemberDef&) const = default;
};

}  // namespace taut
