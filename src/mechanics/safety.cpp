#include "taut/safety.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/brief.h"
#include "math/angle.h"
#include "math/vec.h"

namespace taut {
namespace {

/// Relative change of a tension that a load causes only by the rounding of its equilibrium.
constexpr double kNoChange = 1e-9;

/// Computes the safety factors of a cross section (eq. 9 to 11).
void TakeSection(const MemberDef& member, double length_m, MemberLoad& load) {
  const MemberLimits bears = LimitsOf(member, load.kind, length_m);
  const double push_n = -load.least_n, pull_n = load.greatest_n;
  const double larger_n = std::max(push_n, pull_n);
  if (bears.buckling_n && push_n > 0) load.buckling = *bears.buckling_n / push_n;
  if (bears.yield_n && larger_n > 0) load.yield = *bears.yield_n / larger_n;
  if (bears.strength_n && pull_n > 0) load.strength = *bears.strength_n / pull_n;
}

MemberLoad Of(MemberKind kind, int index, const std::string& name) {
  MemberLoad load;
  load.kind = kind, load.index = index, load.name = name;
  return load;
}

/// Safety factors in a fixed order, with their names.
std::array<std::pair<const char*, const std::optional<double>*>, 3> FactorsOf(const MemberLoad& m) {
  return {{{"buckling", &m.buckling}, {"yield", &m.yield}, {"strength", &m.strength}}};
}

std::pair<const char*, std::optional<double>> LeastFactor(const MemberLoad& load) {
  std::pair<const char*, std::optional<double>> least{"", std::nullopt};
  for (const auto& [name, factor] : FactorsOf(load)) {
    if (*factor && (!least.second || **factor < *least.second)) least = {name, *factor};
  }
  return least;
}

}  // namespace

MemberLimits LimitsOf(const MemberDef& member, MemberKind kind, double length_m) {
  MemberLimits bears;
  // Cables do not buckle.
  if (kind != MemberKind::kCable && member.young_pa > 0 && member.second_moment_m4 > 0) {
    const double free_m = member.buckling_length_m > 0 ? member.buckling_length_m : length_m;
    bears.buckling_n = kPi * kPi * member.young_pa * member.second_moment_m4 / (free_m * free_m);
  }
  if (member.yield_pa > 0 && member.area_m2 > 0) {
    bears.yield_n = member.yield_pa * member.area_m2;
  }
  if (member.strength_n > 0) bears.strength_n = member.strength_n;
  return bears;
}

std::optional<double> MemberLoad::Least() const { return LeastFactor(*this).second; }
std::string MemberLoad::LeastOf() const { return LeastFactor(*this).first; }

std::vector<MemberLoad> MemberLoads(const ModelDef& def, const MemberForces& now,
                                    const MemberForces* unloaded) {
  std::vector<MemberLoad> out;
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const CableDef& cable = def.cables[c];
    MemberLoad load = Of(MemberKind::kCable, static_cast<int>(c), cable.name);
    load.least_n = load.greatest_n = now.cable_tension_n[c];
    load.slack = !(load.greatest_n > 0);
    TakeSection(cable.member, 0, load);
    if (unloaded != nullptr) {
      const double before_n = unloaded->cable_tension_n[c];
      if (before_n - load.greatest_n > kNoChange * before_n)
        load.slackening = before_n / (before_n - load.greatest_n);
    }
    out.push_back(std::move(load));
  }
  for (std::size_t j = 0; j < def.joints.size(); ++j) {
    const JointDef& joint = def.joints[j];
    if (!IsBar(joint)) continue;
    MemberLoad load = Of(MemberKind::kBar, static_cast<int>(j), joint.name);
    load.least_n = load.greatest_n = now.bar_force_n[j];
    TakeSection(joint.member, Length(joint.to_m - joint.from_m), load);
    out.push_back(std::move(load));
  }
  for (const StrutForce& strut : now.struts) {
    const auto rod = std::find_if(def.capsules.begin(), def.capsules.end(),
                                  [&](const CapsuleDef& c) { return c.body == strut.body; });
    MemberLoad load =
        Of(MemberKind::kRod, strut.body, def.bodies[static_cast<std::size_t>(strut.body)].name);
    load.least_n = strut.axial.least_n;
    load.greatest_n = strut.axial.greatest_n;
    TakeSection(rod->member, Length(rod->to_m - rod->from_m), load);
    out.push_back(std::move(load));
  }
  return out;
}

const char* NameOf(MemberKind kind) noexcept {
  switch (kind) {
    case MemberKind::kCable:
      return "cable";
    case MemberKind::kBar:
      return "bar";
    case MemberKind::kRod:
      return "rod";
  }
  return "";
}

const char* NameOf(MemberLimit limit) noexcept {
  switch (limit) {
    case MemberLimit::kStrength:
      return "strength";
    case MemberLimit::kYield:
      return "yield";
    case MemberLimit::kBuckling:
      return "buckling";
  }
  return "";
}

std::string Describe(const Overload& overload) {
  using base::Brief;
  const char* const limit = overload.limit == MemberLimit::kStrength ? "its strength of "
                            : overload.limit == MemberLimit::kYield  ? "its yield force of "
                                                                     : "its buckling load of ";
  return std::string(NameOf(overload.kind)) + " " + overload.name + " carried " +
         Brief(overload.carried_n) + " N, more than " + limit + Brief(overload.bears_n) +
         " N, first at t = " + Brief(overload.first_time_s) + " s";
}

std::string Describe(const std::vector<Overload>& overloads) {
  if (overloads.empty()) return {};
  const std::size_t more = overloads.size() - 1;
  return Describe(overloads[0]) +
         (more == 0   ? ""
          : more == 1 ? "; and one more limit of a member was exceeded"
                      : "; and " + std::to_string(more) + " more limits of members were exceeded");
}

}  // namespace taut
