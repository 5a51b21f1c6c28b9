/// How far members are from what they bear: Euler's load, yield, strength, slack
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
  kBar,  ///< A joint that is one (`IsBar`).
  kRod,  ///< A body that is one straight rod (`StrutForces`).
};

/// Load limits of a member. Empty where the model has no value.
struct MemberLimits {
  std::optional<double> buckling_n;  ///< Euler's load, of bars and rods: pi^2 E I / Lb^2.
  std::optional<double> yield_n;     ///< Yield stress times area, in tension and compression.
  std::optional<double> strength_n;  ///< Tension at which it breaks.
};
/// `length_m`: buckling length of a bar or rod whose model sets none.
MemberLimits LimitsOf(const MemberDef& member, MemberKind kind, double length_m);

/// What members carry, tension positive.
struct MemberForces {
  std::vector<double> cable_tension_n;  ///< Per cable.
  std::vector<double> bar_force_n;      ///< Per joint; of those that are no bars 0.
  std::vector<StrutForce> struts;
};

/// What a member bears over what it carries: above 1 it holds. Nothing where a figure for it is not
/// known or nothing of the kind is carried.
struct MemberLoad {
  MemberKind kind = MemberKind::kCable;
  int index = 0;  ///< The cable, the joint or the body.
  std::string name;
  double least_n = 0, greatest_n = 0;  ///< Along a rod; else the same.
  bool slack = false;                  ///< A cable without tension.
  std::optional<double> buckling;      ///< pi^2 E I / Lb^2 over its compression; Lb is its length
                                       ///< where the model says none.
  std::optional<double> yield;         ///< Yield stress times area over the larger force.
  std::optional<double> strength;      ///< Over its tension.
  /// Of a cable that has less tension than unloaded: how many times the load until it is slack,
  /// if tension falls in proportion.
  std::optional<double> slackening;
  /// The smallest safety factor (buckling, yield, strength) and its name; nothing without one.
  /// Slack is not a failure and does not count: see `slackening`.
  std::optional<double> Least() const;
  std::string LeastOf() const;
};

/// Cables first, then bars, then rods. `def`: as it stands under these forces. `unloaded`: the same
/// members without the load, if that is known.
std::vector<MemberLoad> MemberLoads(const ModelDef& def, const MemberForces& now,
                                    const MemberForces* unloaded = nullptr);

/// Kinds of load limits.
enum class MemberLimit {
  kStrength,  ///< Tension at which it breaks.
  kYield,     ///< Force at its yield stress, in tension or compression.
  kBuckling,  ///< Euler's load, under compression.
};

/// A member that exceeded a limit during a run. The simulation goes on as if it held.
struct Overload {
  MemberKind kind = MemberKind::kCable;
  std::string name;
  MemberLimit limit = MemberLimit::kStrength;
  double bears_n = 0;       ///< The limit, > 0.
  double carried_n = 0;     ///< Largest force, > 0: compression if `limit` is kBuckling.
  double first_time_s = 0;  ///< Time at which it first exceeded the limit.
};

/// "cable", "bar" or "rod".
const char* NameOf(MemberKind kind) noexcept;
/// "strength", "yield" or "buckling".
const char* NameOf(MemberLimit limit) noexcept;

/// Describes an overload in a sentence without a period: cable a carried 17.14 N, more than its
/// strength of 0.5 N, first at t = 0.12 s.
std::string Describe(const Overload& overload);
/// Describes the first overload and the number of others. Empty without overloads.
std::string Describe(const std::vector<Overload>& overloads);

}  // namespace taut
