/// Of what a cable, a bar or a rod is made, and what it bears: for `taut/analysis.h`.
#pragma once

namespace taut {

/// How a member's own mass counts where modes are worked out. Where it is stepped it is lumped.
enum class MemberMass {
  kLumped,      ///< Half of it at each end.
  kConsistent,  ///< Spread along it, which moves as its ends do.
};

/// A member's section and limits; 0: not known. The step looks at none of it: the stiffness and the
/// masses that follow from it stand where those of other members do.
struct MemberDef {
  double area_m2 = 0.0;            ///< Of its cross section, >= 0.
  double young_pa = 0.0;           ///< E, >= 0.
  double second_moment_m4 = 0.0;   ///< Least of its section, for Euler's load, >= 0.
  double buckling_length_m = 0.0;  ///< Between the points that cannot bend aside, >= 0.
  double yield_pa = 0.0;           ///< Stress that it bears either way, >= 0.
  double strength_n = 0.0;         ///< Tension at which it breaks, >= 0.
  double expansion_per_k = 0.0;    ///< Strain per degree.
  double mass_kg = 0.0;  ///< Of a cable or a bar: its own, which the bodies at its ends contain,
                         ///< half each. >= 0.
  MemberMass mass = MemberMass::kLumped;
  bool operator==(const MemberDef&) const = default;
};

}  // namespace taut
