#include "identify/carried.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/pattern.h"
#include "math/vec.h"

namespace taut::identify {
namespace {

/// Largest relative difference between computed member forces and applied loads. A larger
/// difference means that other forces hold the bodies, too.
constexpr double kClosed = 1e-6;

Vec3 PlaceOf(const ModelDef& def, const Pose& pose, int body, const Vec3& described_m) {
  if (body == kWorld) return described_m;
  const auto b = static_cast<std::size_t>(body);
  const BodyState& s = pose.bodies[b];
  return s.position_m + Rotate(s.orientation, described_m - def.bodies[b].com_m);
}

/// Returns the force on the inner bodies along `direction`, per unit of tension in a member.
double PullAlong(const ModelDef& def, const Pose& pose, const CutMember& member,
                 const Vec3& direction) {
  const Vec3 way = PlaceOf(def, pose, member.outside, member.to_m) -
                   PlaceOf(def, pose, member.inside, member.from_m);
  return Dot(way, direction) / std::sqrt(Dot(way, way));
}

double AppliedAlong(const ModelDef& def, const Cut& cut, const LoadCaseSpec& loads,
                    const Vec3& direction) {
  double applied_n = 0;
  for (const LoadCaseSpec::NodeForce& force : loads.forces) {
    if (!cut.bodies.count(def.nodes[static_cast<std::size_t>(force.node)].body)) continue;
    applied_n += Dot(force.force_n, direction);
  }
  for (const int body : cut.bodies) {
    if (!loads.weight) break;
    applied_n += loads.weight_factor * def.bodies[static_cast<std::size_t>(body)].mass_kg *
                 Dot(def.gravity_m_per_s2, direction);
  }
  return applied_n;
}

void AddCable(const CableDef& cable, Cut& cut) {
  const auto in = [&](const AttachmentDef& at) { return cut.bodies.count(at.body) > 0; };
  bool crosses = false;
  for (std::size_t i = 1; i < cable.attachments.size(); ++i) {
    const AttachmentDef &a = cable.attachments[i - 1], &b = cable.attachments[i];
    if (in(a) == in(b)) continue;
    crosses = true;
    const AttachmentDef &inside = in(a) ? a : b, &outside = in(a) ? b : a;
    const std::string name = "cable/" + cable.name + "/";
    cut.members.push_back({{name + "tension_n", name + "elastic_n"},
                           inside.body,
                           outside.body,
                           inside.position_m,
                           outside.position_m});
  }
  if (!crosses) return;
  const auto wheel = [](const AttachmentDef& at) { return at.wheel.has_value(); };
  if (HasFriction(cable)) {
    cut.wrong.push_back("cable " + cable.name +
                        " has friction along its path, so its tension is not uniform");
  } else if (cable.touches != CableTouches::kNone ||
             std::any_of(cable.attachments.begin(), cable.attachments.end(), wheel)) {
    cut.wrong.push_back("cable " + cable.name + " runs over wheels or around obstacles");
  }
}

void AddJoint(const JointDef& joint, Cut& cut) {
  const bool a = cut.bodies.count(joint.body_a) > 0, b = cut.bodies.count(joint.body_b) > 0;
  if (a == b) return;
  if (!IsBar(joint)) {
    cut.wrong.push_back("joint " + joint.name + ", which holds the bodies, is not a bar");
    return;
  }
  cut.members.push_back({{"joint/" + joint.name + "/axial_n"},
                         a ? joint.body_a : joint.body_b,
                         a ? joint.body_b : joint.body_a,
                         a ? joint.from_m : joint.to_m,
                         a ? joint.to_m : joint.from_m});
}

/// Returns the member's first measured channel; empty if none was measured.
std::string ChannelOf(const CutMember& member, const MeasuredForces& measured) {
  for (const std::string& channel : member.channels) {
    if (measured.by_channel.count(channel)) return channel;
  }
  return {};
}

/// Returns a member's force in a computed equilibrium [N].
double ComputedForce(const ModelDef& def, const Equilibrium& rest, const CutMember& member) {
  for (std::size_t i = 0; i < def.cables.size(); ++i) {
    if (member.channels[0] == "cable/" + def.cables[i].name + "/tension_n") {
      return rest.cable_tension_n[i];
    }
  }
  for (std::size_t i = 0; i < def.joints.size(); ++i) {
    if (member.channels[0] == "joint/" + def.joints[i].name + "/axial_n") {
      return rest.bar_force_n[i];
    }
  }
  return 0;
}

/// Returns the comparison at one equilibrium. Returns nothing if a member was not measured there.
std::optional<CarriedLoad::Row> RowOf(const ModelDef& def, const Cut& cut, const Pose& pose,
                                      const Vec3& direction, const MeasuredForces& measured) {
  CarriedLoad::Row row{measured.where, 0, 0, 0};
  // Sum per channel, since all crossings of a cable share one measurement error.
  std::map<std::string, double> pulls;
  for (const CutMember& member : cut.members) {
    const std::string channel = ChannelOf(member, measured);
    if (channel.empty()) return std::nullopt;
    pulls[channel] += PullAlong(def, pose, member, direction);
  }
  double variance = 0;
  for (const auto& [channel, pull] : pulls) {
    const auto& [force_n, sd_n] = measured.by_channel.at(channel);
    row.carried_n -= pull * force_n;
    variance += pull * sd_n * (pull * sd_n);
  }
  row.sd_n = std::sqrt(variance);
  return row;
}

}  // namespace

Cut CutAbout(const ModelDef& def, const std::vector<std::string>& bodies) {
  Cut cut;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    if (!base::FitsAny(bodies, def.bodies[b].name)) continue;
    cut.bodies.insert(static_cast<int>(b));
    if (def.bodies[b].fixed) cut.wrong.push_back("body " + def.bodies[b].name + " is anchored");
  }
  for (const CableDef& cable : def.cables) AddCable(cable, cut);
  for (const JointDef& joint : def.joints) AddJoint(joint, cut);
  return cut;
}

void CheckCut(const FitCarried& asked, const FitExperiment& one,
              const std::vector<MeasuredForces>& measured, Diagnostics& out) {
  const std::string of = "carried: " + asked.name + " of " + one.name + ": ";
  const Cut cut = CutAbout(one.experiment.robot.def, asked.bodies);
  for (const std::string& what : cut.wrong) {
    out.Error("carried.not_held", asked.at, of + what,
              "expected bodies that are held by cables and bars only");
  }
  if (cut.members.empty() && cut.wrong.empty())
    out.Error("carried.not_held", asked.at, of + "no member holds the bodies");
  std::set<std::string> missing;
  for (const CutMember& member : cut.members) {
    const auto has = [&](const MeasuredForces& m) { return !ChannelOf(member, m).empty(); };
    if (std::any_of(measured.begin(), measured.end(), has)) continue;
    missing.insert(member.channels[0]);
  }
  for (const std::string& channel : missing) {
    out.Error("carried.not_compared", asked.at, of + channel + " is not compared",
              "add all members between the bodies and the rest of the robot to `residuals`");
  }
}

CarriedLoad CarriedBy(const FitCarried& asked, const FitExperiment& one,
                      const std::vector<double>& moments_s,
                      const std::vector<MeasuredForces>& measured) {
  CarriedLoad out;
  out.name = asked.name;
  const ModelDef& def = one.experiment.robot.def;
  const Cut cut = CutAbout(def, asked.bodies);
  std::string other;
  const auto take = [&](double time, const LoadCaseSpec& loads, const Equilibrium& rest) {
    const double applied_n = AppliedAlong(def, cut, loads, asked.direction);
    double held_n = 0, size_n = std::fabs(applied_n);
    for (const CutMember& member : cut.members) {
      const double pull_n =
          PullAlong(def, rest.pose, member, asked.direction) * ComputedForce(def, rest, member);
      held_n -= pull_n;
      size_n = std::max(size_n, std::fabs(pull_n));
    }
    if (std::fabs(held_n - applied_n) > kClosed * std::max(size_n, 1.0)) {
      other = fmt::format(
          "other supports than members, such as the ground, hold the bodies: {:.4g} N of {:.4g} N",
          applied_n - held_n, applied_n);
      return false;
    }
    for (const MeasuredForces& m : measured) {
      if (std::fabs(m.time - time) > 1e-9) continue;
      auto row = RowOf(def, cut, rest.pose, asked.direction, m);
      if (!row) continue;
      row->applied_n = applied_n;
      out.rows.push_back(std::move(*row));
    }
    return true;
  };
  out.check.why = EachRest(one.experiment, one.forward, moments_s, take);
  if (out.check.why.empty()) out.check.why = other;
  if (!out.check.why.empty()) return out;
  std::vector<ProportionPoint> points;
  for (const CarriedLoad::Row& row : out.rows) {
    const int group = static_cast<int>(points.size());
    points.push_back({row.applied_n, row.carried_n, row.sd_n, group});
  }
  out.check = CheckProportion(points, asked.name + " of " + one.name + ": measured forces carry");
  return out;
}

}  // namespace taut::identify
