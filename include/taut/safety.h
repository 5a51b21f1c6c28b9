/// Safety factors of members against buckling, yield and breaking, and load factors for slack
/// cables (docs/theory/loads.md, section 4).
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/loads.h"
#include "taut/model_def.h"

namespace taut {

enum class MemberKind {
  kCable,
  kBar,  ///< Joint that is an elastic bar (`IsBar`).
  kRod,  ///< Body that is one straight rod (`StrutForces`).
};

/// Load limits of a member. A limit is absent if the model lacks a value for it.
struct MemberLimits {
  std::optional<double> buckling_n;  ///< Euler load of bars and rods: pi^2 E I / Lb^2.
  std::optional<double> yield_n;     ///< Yield stress times area, in tension and compression.
  std::optional<double> strength_n;  ///< Breaking force in tension.
};
/// Returns the load limits of a member. `length_m`: buckling length of a bar or rod without one in
/// the model.
MemberLimits LimitsOf(const MemberDef& member, MemberKind kind, double length_m);

/// Forces of members, tension positive.
struct MemberForces {
  std::vector<double> cable_tension_n;  ///< One per cable.
  std::vector<double> bar_force_n;      ///< One per joint; 0 for joints that are not bars.
  std::vector<StrutForce> struts;
};

/// Safety factors of a member: limit / force. Below 1, the member fails. A factor is absent if its
/// limit is unknown or the member has no such force.
struct MemberLoad {
  MemberKind kind = MemberKind::kCable;
  int index = 0;  ///< Index of the cable, joint or body.
  std::string name;
  double least_n = 0, greatest_n = 0;  ///< Extremes along a rod; equal for other members.
  bool slack = false;                  ///< The cable has no tension.
  /// Euler load / compression. The buckling length is the member length if the model has none.
  std::optional<double> buckling;
  std::optional<double> yield;     ///< Yield stress * area / largest force magnitude.
  std::optional<double> strength;  ///< Safety factor: strength / tension.
  /// Load factor at which the cable goes slack, if its tension decreases linearly with the load.
  /// Only for cables with less tension than in the unloaded structure.
  std::optional<double> slackening;
  /// Return the smallest safety factor (buckling, yield, strength) and its name; nothing if there
  /// is none. A slack cable does not count as failed; see `slackening`.
  std::optional<double> Least() const;
  std::string LeastOf() const;
};

/// Returns the safety factors of all members: cables, bars, rods. `def`: model in the pose under
/// load. `unloaded`: forces of the same members without the load, if known.
std::vector<MemberLoad> MemberLoads(const ModelDef& def, const MemberForces& now,
                                    const MemberForces* unloaded = nullptr);

/// Kinds of load limits.
enum class MemberLimit {
  kStrength,  ///< Breaking force in tension.
  kYield,     ///< Force at the yield stress, in tension or compression.
  kBuckling,  ///< Euler load in compression.
};

/// Member that exceeded a limit during a run. The simulation continues with the member intact.
struct Overload {
  MemberKind kind = MemberKind::kCable;
  std::string name;
  MemberLimit limit = MemberLimit::kStrength;
  double bears_n = 0;       ///< Limit, > 0.
  double carried_n = 0;     ///< Largest force, > 0; with kBuckling, the largest compression.
  double first_time_s = 0;  ///< Time at which the limit was first exceeded.
};

/// Returns "cable", "bar" or "rod".
const char* NameOf(MemberKind kind) noexcept;
/// Returns "strength", "yield" or "buckling".
const char* NameOf(MemberLimit limit) noexcept;

/// Describes an overload in a sentence without a period, for example "cable a carried 17.14 N, more
/// than its strength of 0.5 N, first at t = 0.12 s".
std::string Describe(const Overload& overload);
/// Describes the first overload and the number of others. Empty without overloads.
std::string Describe(const std::vector<Overload>& overloads);

}  // namespace taut
