#include "taut/safety.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "math/vec.h"

namespace taut {
namespace {

double Length(const Vec3& v) { return std::sqrt(Dot(v, v)); }

/// What a member's section bears; a cable does not buckle (eq. 9 to 11).
void TakeSection(const MemberDef& member, double length_m, MemberLoad& load) {
  const double push_n = -load.least_n, pull_n = load.greatest_n;
  if (load.kind != MemberKind::kCable && push_n > 0 && member.young_pa > 0 &&
      member.second_moment_m4 > 0) {
    constexpr double kPi = 3.14159265358979323846;
    const double free_m = member.buckling_length_m > 0 ? member.buckling_length_m : length_m;
    load.buckling =
        kPi * kPi * member.young_pa * member.second_moment_m4 / (free_m * free_m) / push_n;
  }
  const double larger_n = std::max(push_n, pull_n);
  if (member.yield_pa > 0 && member.area_m2 > 0 && larger_n > 0) {
    load.yield = member.yield_pa * member.area_m2 / larger_n;
  }
  if (member.strength_n > 0 && pull_n > 0) load.strength = member.strength_n / pull_n;
}

MemberLoad Of(MemberKind kind, int index, const std::string& name) {
  MemberLoad load;
  load.kind = kind, load.index = index, load.name = name;
  return load;
}

/// Safety factors in a fixed order, with their names.
std::array<std::pair<const char*, const std::optional<double>*>, 3> Factors(const MemberLoad& m) {
  return {{{"buckling", &m.buckling}, {"yield", &m.yield}, {"strength", &m.strength}}};
}

std::pair<const char*, std::optional<double>> LeastFactor(const MemberLoad& load) {
  std::pair<const char*, std::optional<double>> least{"", std::nullopt};
  for (const auto& [name, factor] : Factors(load)) {
    if (*factor && (!least.second || **factor < *least.second)) least = {name, *factor};
  }
  return least;
}

}  // namespace

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
      if (before_n > load.greatest_n) load.slackening = before_n / (before_n - load.greatest_n);
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

}  // namespace taut
