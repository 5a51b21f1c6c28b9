/// Member sizing: lightest rods and cables for given forces (docs/theory/inverse_statics.md,
/// section 6).
///
/// SI units. Errors describe invalid tasks. Threads: all functions are pure and thread safe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/member_def.h"

namespace taut {

struct SizingMaterial {
  double young_pa = 0.0;           ///< Young's modulus E, > 0; not used for cables.
  double yield_pa = 0.0;           ///< Yield stress, > 0.
  double density_kg_per_m3 = 0.0;  ///< Density, > 0.
};

/// Member to size, with its requirements.
struct SizingTask {
  std::string name;
  SizingMaterial material;
  double length_m = 0.0;            ///< Member length, > 0.
  std::vector<double> force_n;      ///< One per load case; tension > 0; for cables >= 0.
  double yield_factor = 1.0;        ///< Smallest allowed ratio of yield stress to stress, > 0.
  double buckling_factor = 1.0;     ///< Smallest allowed ratio of Euler load to compression, > 0.
  double buckling_length_m = 0.0;   ///< Buckling length; 0: `length_m` (hinged ends).
  double inner_radius_share = 0.0;  ///< Inner / outer radius of a tube, 0 <= ratio < 1; 0: solid.
  /// Largest allowed ratio of buckling length to radius of gyration, > 0.
  std::optional<double> slenderness;
};

/// Requirement that determines the radius of a member.
enum class SizingLimit { kNothing, kYield, kBuckling, kSlenderness };

struct SizedMember {
  double radius_m = 0.0;  ///< Outer radius.
  double mass_kg = 0.0;
  /// Section data for a model: area, second moment, E, yield stress, buckling length, mass.
  MemberDef member;
  SizingLimit limit = SizingLimit::kNothing;
};

/// Returns the lightest round rod or tube. If the task is invalid, returns nothing and adds errors.
std::optional<SizedMember> LightestRod(const SizingTask& task, Diagnostics& out);

/// Returns the lightest round cable for its tension, ignoring buckling and slenderness. If the task
/// is invalid, returns nothing and adds errors.
std::optional<SizedMember> LightestCable(const SizingTask& task, Diagnostics& out);

}  // namespace taut
