/// The lightest rods and cables that bear given forces (docs/theory/inverse_statics.md, section 6).
///
/// SI units. Wrong tasks are complaints. Threads: all functions are pure; any number may run at
/// once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/member_def.h"

namespace taut {

struct SizingMaterial {
  double young_pa = 0.0;           ///< E, > 0; of cables not asked for.
  double yield_pa = 0.0;           ///< > 0.
  double density_kg_per_m3 = 0.0;  ///< > 0.
};

/// A member and what it is to bear.
struct SizingTask {
  std::string name;
  SizingMaterial material;
  double length_m = 0.0;              ///< > 0.
  std::vector<double> force_n;        ///< Per load case, tension > 0; of a cable >= 0.
  double yield_factor = 1.0;          ///< Yield stress over stress, at least; > 0.
  double buckling_factor = 1.0;       ///< Euler's load over the compression, at least; > 0.
  double buckling_length_m = 0.0;     ///< 0: `length_m`, that of a rod with joints at its ends.
  double inner_radius_share = 0.0;    ///< Of a tube, of the outer radius, 0..1, not 1.
  std::optional<double> slenderness;  ///< Buckling length over radius of gyration, at most; > 0.
};

/// What makes a member as thick as it is.
enum class SizingLimit { kNothing, kYield, kBuckling, kSlenderness };

struct SizedMember {
  double radius_m = 0.0;  ///< The outer one.
  double mass_kg = 0.0;
  /// Its section, for a model: area, second moment, E, yield stress, buckling length, mass.
  MemberDef member;
  SizingLimit limit = SizingLimit::kNothing;
};

/// A round rod or tube. Nothing if the task is wrong.
std::optional<SizedMember> LightestRod(const SizingTask& task, Diagnostics& out);

/// A round cable, which bears tension only; of its task buckling and slenderness are not looked at.
std::optional<SizedMember> LightestCable(const SizingTask& task, Diagnostics& out);

}  // namespace taut
