/// Member sizing: the lightest rods and cables for given forces (docs/theory/inverse_statics.md,
/// section 6).
///
/// SI units. Invalid tasks are reported as errors. Threads: all functions are pure; any number may
/// run at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/member_def.h"

namespace taut {

struct SizingMaterial {
  double young_pa = 0.0;           ///< E, > 0; not used for cables.
  double yield_pa = 0.0;           ///< > 0.
  double density_kg_per_m3 = 0.0;  ///< > 0.
};

/// A member and its requirements.
struct SizingTask {
  std::string name;
  SizingMaterial material;
  double length_m = 0.0;            ///< > 0.
  std::vector<double> force_n;      ///< Per load case, tension > 0; of a cable >= 0.
  double yield_factor = 1.0;        ///< Least ratio of yield stress to stress, > 0.
  double buckling_factor = 1.0;     ///< Least ratio of Euler's load to compression, > 0.
  double buckling_length_m = 0.0;   ///< 0: `length_m`, as for a rod with hinged ends.
  double inner_radius_share = 0.0;  ///< Of a tube: inner over outer radius, >= 0 and < 1.
  /// Greatest ratio of buckling length to radius of gyration, > 0.
  std::optional<double> slenderness;
};

/// Requirement that determines a member's radius.
enum class SizingLimit { kNothing, kYield, kBuckling, kSlenderness };

struct SizedMember {
  double radius_m = 0.0;  ///< Outer radius.
  double mass_kg = 0.0;
  /// Section for a model: area, second moment, E, yield stress, buckling length, mass.
  MemberDef member;
  SizingLimit limit = SizingLimit::kNothing;
};

/// Returns the lightest round rod or tube. Returns nothing, with errors, if the task is invalid.
std::optional<SizedMember> LightestRod(const SizingTask& task, Diagnostics& out);

/// Returns the lightest round cable, for tension only: buckling and slenderness in its task are
/// ignored. Returns nothing, with errors, if the task is invalid.
std::optional<SizedMember> LightestCable(const SizingTask& task, Diagnostics& out);

}  // namespace taut
