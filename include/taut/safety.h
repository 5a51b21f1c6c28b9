/// Safety factors of members against buckling, yield and breaking, and slackening of cables
/// (docs/theory/loads.md, section 4).
///
/// Threads: any number may call these functions at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/loads.h"
#include "taut/model_def.h"

namespace taut {

enum class MemberKind {
  kCable,
  kBar,  ///< A joint that is an elastic bar (`IsBar`).
  kRod,  ///< A body that is one straight rod (`StrutForces`).
};

/// Load limits of a member. Empty where the model has no value.
struct MemberLimits {
  std::optional<double> buckling_n;  ///< Euler's load, of bars and rods: pi^2 E I / Lb^2.
  std::optional<double> yield_n;     ///< Yield stress times area, in tension and compression.
  std::optional<double> strength_n;  ///< Tension at which it breaks.
};
/// Returns the load limits of a member. `length_m`: buckling length of a bar or rod if its model
/// has none.
MemberLimits LimitsOf(const MemberDef& member, MemberKind kind, double length_m);

/// Forces of members, tension positive.
struct MemberForces {
  std::vector<double> cable_tension_n;  ///< Per cable.
  std::vector<double> bar_force_n;      ///< Per joint; 0 for joints that are not bars.
  std::vector<StrutForce> struts;
};

/// Safety factors of a member: limit divided by force; it fails below 1. Empty if the limit is not
/// known or the member carries no such force.
struct MemberLoad {
  MemberKind kind = MemberKind::kCable;
  int index = 0;  ///< Of the cable, joint or body.
  std::string name;
  double least_n = 0, greatest_n = 0;  ///< Along a rod; else equal.
  bool slack = false;                  ///< Cable without tension.
  /// pi^2 E I / Lb^2 over compression; Lb: its length if the model has none.
  std::optional<double> buckling;
  std::optional<double> yield;     ///< Yield stress times area over the larger force.
  std::optional<double> strength;  ///< Strength over tension.
  /// For a cable with less tension than without the load: factor on the load at which it goes
  /// slack, if tension decreases linearly with the load.
  std::optional<double> slackening;
  /// Return the smallest safety factor (buckling, yield, strength) and its name; nothing if there
  /// is none. Slack cables have not failed and do not count: see `slackening`.
  std::optional<double> Least() const;
  std::string LeastOf() const;
};

/// Returns the safety factors of all members: cables, then bars, then rods. `def`: in the pose
/// under these forces. `unloaded`: forces of the same members without the load, if known.
std::vector<MemberLoad> MemberLoads(const ModelDef& def, const MemberForces& now,
                                    const MemberForces* unloaded = nullptr);

/// Kinds of load limits.
enum class MemberLimit {
  kStrength,  ///< Tension at which it breaks.
  kYield,     ///< Force at its yield stress, in tension or compression.
  kBuckling,  ///< Euler's load, under compression.
};

/// A member that exceeded a limit during a run. The simulation continues with the member intact.
struct Overload {
  MemberKind kind = MemberKind::kCable;
  std::string name;
  MemberLimit limit = MemberLimit::kStrength;
  double bears_n = 0;       ///< The limit, > 0.
  double carried_n = 0;     ///< Largest force, > 0: compression if `limit` is kBuckling.
  double first_time_s = 0;  ///< Time at which it first exceeded the limit.
};

/// Returns "cable", "bar" or "rod".
const char* NameOf(MemberKind kind) noexcept;
/// Returns "strength", "yield" or "buckling".
const char* NameOf(MemberLimit limit) noexcept;

/// Describes an overload in a sentence without a period: cable a carried 17.14 N, more than its
/// strength of 0.5 N, first at t = 0.12 s.
std::string Describe(const Overload& overload);
/// Describes the first overload and the number of others. Empty without overloads.
std::string Describe(const std::vector<Overload>& overloads);

}  // namespace taut
