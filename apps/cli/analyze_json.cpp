// JSON output of `taut analyze`.
#include <nlohmann/json.hpp>

#include "analyze_names.h"
#include "analyze_report.h"
#include "json_values.h"

namespace taut::cli {
namespace {

using Json = nlohmann::ordered_json;

Json RankJson(const RankGap& rank) {
  return {{"rank", rank.rank},
          {"smallest_kept", rank.smallest_kept},
          {"largest_dropped", rank.largest_dropped},
          {"clear", rank.clear()}};
}

Json ShapeJson(const ModelDef& def, const Mode& mode) {
  Json shape = Json::array();
  for (std::size_t b = 0; b < mode.translation_m.size(); ++b) {
    shape.push_back({{"body", def.bodies[b].name},
                     {"translation_m", ToJson(mode.translation_m[b])},
                     {"turn_rad", ToJson(mode.turn_rad[b])}});
  }
  return shape;
}

Json ForcesJson(const ModelDef& def, const ForceAnalysis& forces) {
  Json json{{"unknowns", forces.unknowns},
            {"free_turns", forces.free_turns},
            {"rank", RankJson(forces.rank)},
            {"rigid", forces.rigid}};
  json["members"] = Json::array();
  for (const StaticMember& member : forces.members) {
    json["members"].push_back({{"name", StaticMemberName(def, member)},
                               {"kind", NameOf(member.kind)},
                               {"length_m", member.length_m},
                               {"force_n", member.force_n}});
  }
  json["self_stress"] = Json::array();
  for (const SelfStress& state : forces.self_stress) {
    json["self_stress"].push_back({{"feasible", state.feasible},
                                   {"force_n", state.force_n},
                                   {"force_density_n_per_m", state.density_n_per_m},
                                   {"rod_force_density_n_per_m", state.rod_density_n_per_m}});
  }
  json["mechanisms"] = Json::array();
  for (const Mode& mode : forces.mechanisms) json["mechanisms"].push_back(ShapeJson(def, mode));
  json["mechanism_stiffness_n_per_m"] = forces.mechanism_stiffness;
  if (forces.classical) {
    const ClassicalCount& c = *forces.classical;
    Json rods = Json::array();
    for (const int rod : c.rods) rods.push_back(BodyName(def, rod));
    json["pin_jointed"] = {{"nodes", c.nodes},
                           {"members", c.members},
                           {"rank", RankJson(c.rank)},
                           {"self_stresses", c.self_stresses},
                           {"mechanisms", c.mechanisms},
                           {"rigid", c.rigid},
                           {"rods", rods}};
  }
  json["left_out"] = forces.left_out;
  return json;
}

Json MembersJson(const CaseResult& result) {
  Json members = Json::array();
  for (const MemberLoad& load : result.members) {
    Json one{{"name", load.name}, {"kind", NameOf(load.kind)}};
    if (load.kind == MemberKind::kCable) {
      const CableDef& cable = result.def.cables[static_cast<std::size_t>(load.index)];
      const double length_m = CableLength(cable);
      one["length_m"] = length_m;
      one["rest_length_m"] = cable.rest_length_m;
      one["tension_n"] = load.greatest_n;
      one["force_density_n_per_m"] = load.greatest_n / length_m;
      one["slack"] = load.slack;
    } else {
      one["least_force_n"] = load.least_n;
      one["greatest_force_n"] = load.greatest_n;
    }
    one["buckling_factor"] = ToJson(load.buckling);
    one["yield_factor"] = ToJson(load.yield);
    one["strength_factor"] = ToJson(load.strength);
    one["slack_factor"] = ToJson(load.slackening);
    members.push_back(std::move(one));
  }
  return members;
}

Json PoseJson(const CaseResult& result) {
  Json bodies = Json::array();
  for (std::size_t b = 0; b < result.at.pose.bodies.size(); ++b) {
    const BodyState& body = result.at.pose.bodies[b];
    const Quat& q = body.orientation;
    bodies.push_back({{"name", result.def.bodies[b].name},
                      {"position_m", ToJson(body.position_m)},
                      {"orientation", Json::array({q.w, q.x, q.y, q.z})}});
  }
  return bodies;
}

Json ReactionsJson(const CaseResult& result) {
  Json list = Json::array();
  for (const ReactionForce& one : ReactionsOf(result)) {
    list.push_back({{"kind", one.kind},
                    {"name", one.name},
                    {"point_m", ToJson(one.point_m)},
                    {"force_n", ToJson(one.force_n)},
                    {"torque_n_m", ToJson(one.torque_n_m)}});
  }
  return list;
}

Json IntervalJson(const ForceInterval& limits) {
  return {{"low_n", limits.low_n}, {"high_n", limits.high_n}, {"uncertain_n", limits.uncertain_n}};
}

/// Returns the open forces as JSON; an infinite limit is null.
Json OpenJson(const CaseResult& result) {
  const CaseResult::Open& open = *result.open;
  Json json{{"undetermined", open.forces.undetermined},
            {"found", open.forces.found},
            {"why", open.forces.found ? Json() : Json(open.forces.why)},
            {"ground", Json::array()},
            {"joints", Json::array()}};
  if (!open.forces.found) return json;
  for (std::size_t t = 0; t < open.touches.size(); ++t) {
    const TouchDef& touch = open.touches[t];
    json["ground"].push_back({{"name", BodyName(result.def, touch.body)},
                              {"point_m", ToJson(touch.point_m)},
                              {"normal", ToJson(touch.normal)},
                              {"friction", touch.friction},
                              {"normal_force_n", IntervalJson(open.forces.touch[t])}});
  }
  for (std::size_t j = 0; j < result.def.joints.size(); ++j) {
    if (IsBar(result.def.joints[j])) continue;
    json["joints"].push_back({{"name", result.def.joints[j].name},
                              {"force_x_n", IntervalJson(open.forces.joint_x[j])},
                              {"force_y_n", IntervalJson(open.forces.joint_y[j])},
                              {"force_z_n", IntervalJson(open.forces.joint_z[j])}});
  }
  return json;
}

Json ModesJson(const CaseResult& result, int most) {
  const Modes& modes = *result.modes;
  Json json{{"why_none", modes.why.empty() ? Json() : Json(modes.why)},
            {"rigid", modes.rigid},
            {"mechanisms", modes.mechanisms},
            {"unstable", modes.unstable},
            {"largest_dropped_per_s2", modes.largest_dropped},
            {"smallest_kept_per_s2", modes.smallest_kept}};
  json["modes"] = Json::array();
  int number = 0;
  for (const Mode& mode : modes.modes) {
    if (mode.kind != Mode::Kind::kRigid && ++number > most) break;
    json["modes"].push_back({{"kind", NameOf(mode.kind)},
                             {"frequency_hz", mode.frequency_hz},
                             {"eigenvalue_per_s2", mode.eigenvalue_per_s2},
                             {"shape", ShapeJson(result.def, mode)}});
  }
  return json;
}

Json CaseJson(const CaseResult& result, int most_modes) {
  Json json{{"name", result.loads.name},
            {"weight", result.loads.weight},
            {"weight_factor", result.loads.weight_factor},
            {"found", result.at.found},
            {"why", result.at.found ? Json() : Json(result.at.why)},
            {"residual_n", result.at.residual_n},
            {"iterations", result.at.iterations},
            {"left_out", result.at.left_out}};
  if (!result.at.found) return json;
  const MemberLoad *const least = result.LeastSafe(), *const first = result.FirstSlack();
  json["least_safety"] = Json();
  if (least != nullptr) {
    json["least_safety"] = {
        {"factor", *least->Least()}, {"of", least->LeastOf()}, {"member", least->name}};
  }
  json["first_slack"] = Json();
  if (first != nullptr) {
    json["first_slack"] = {{"factor", *first->slackening}, {"member", first->name}};
  }
  json["least_stiffness_n_per_m"] = ToJson(result.least_stiffness_n_per_m);
  json["largest_move"] = {{"of", result.move.name},
                          {"distance_m", result.move.distance_m},
                          {"size_m", result.move.size_m}};
  json["bodies"] = PoseJson(result);
  json["members"] = MembersJson(result);
  json["reactions"] = ReactionsJson(result);
  json["open_forces"] = result.open ? OpenJson(result) : Json();
  if (result.modes) json["modes"] = ModesJson(result, most_modes);
  return json;
}

}  // namespace

std::string AnalysisJson(const AnalysisResult& result, int most_modes) {
  Json json{{"format_version", 1},
            {"model", result.robot.def.name},
            {"file", result.file},
            {"parameters", result.robot.parameters},
            {"notes", result.notes}};
  json["as_described"] = ForcesJson(result.robot.def, result.forces);
  json["load_cases"] = Json::array();
  for (const CaseResult& one : result.cases) {
    json["load_cases"].push_back(CaseJson(one, most_modes));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace taut::cli
