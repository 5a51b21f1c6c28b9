// Page of a static analysis, with the structs StaticsPage and LoadedCase of
// web/protocol/messages.json.
#include "analyze_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "analyze_names.h"
#include "apps/viewer/protocol_messages.h"
#include "apps/viewer/report.h"
#include "apps/viewer/scene.h"
#include "apps/viewer/web_files.h"
#include "output.h"
#include "table.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

using viewer::Json;
using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostShownStates = 6;  ///< Maximum number of displayed states of self-stress.

Json Nulls(std::size_t count) { return Json(std::vector<Json>(count, nullptr)); }

/// Returns the rotation vector of a unit quaternion.
Vec3 RotationVector(const Quat& q) {
  const double sine = std::hypot(q.x, q.y, q.z), sign = q.w < 0 ? -1 : 1;
  const double factor = sine > 0 ? sign * 2 * std::atan2(sine, std::fabs(q.w)) / sine : 0;
  return {factor * q.x, factor * q.y, factor * q.z};
}

/// Returns the relative rotation from `from` to `to`, in the world frame.
Quat TurnFrom(const Quat& from, const Quat& to) {
  const Quat& a = to;
  const Quat b{from.w, -from.x, -from.y, -from.z};
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Json DisplacementJson(const Json& scene, const Pose& pose) {
  Json translation = Json::array(), rotation = Json::array();
  for (std::size_t b = 0; b < pose.bodies.size(); ++b) {
    const Json &at = scene["bodies"][b]["position_m"], &q = scene["bodies"][b]["orientation"];
    const Vec3& to = pose.bodies[b].position_m;
    translation.push_back(viewer::ToJson(
        Vec3{to.x - at[0].get<double>(), to.y - at[1].get<double>(), to.z - at[2].get<double>()}));
    const Quat turn =
        TurnFrom({q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>()},
                 pose.bodies[b].orientation);
    rotation.push_back(viewer::ToJson(RotationVector(turn)));
  }
  return {{"kind", "elastic"},
          {"frequency_hz", 0},
          {"translation_m", translation},
          {"rotation_rad", rotation}};
}

Json ShapesJson(const std::vector<Mode>& modes, int most) {
  Json list = Json::array();
  for (const Mode& mode : modes) {
    if (mode.kind == Mode::Kind::kRigid || static_cast<int>(list.size()) >= most) continue;
    Json translation = Json::array(), rotation = Json::array();
    for (const Vec3& v : mode.translation_m) translation.push_back(viewer::ToJson(v));
    for (const Vec3& v : mode.turn_rad) rotation.push_back(viewer::ToJson(v));
    list.push_back({{"kind", NameOf(mode.kind)},
                    {"frequency_hz", mode.frequency_hz},
                    {"translation_m", translation},
                    {"rotation_rad", rotation}});
  }
  return list;
}

void AppendVector(const Vec3& v, Json& list) {
  for (const double x : {v.x, v.y, v.z}) list.push_back(x);
}

/// Returns the force of a member that is largest in magnitude.
double LargestForce(const MemberLoad& load) {
  return std::fabs(load.least_n) > std::fabs(load.greatest_n) ? load.least_n : load.greatest_n;
}

/// Enters forces and utilizations of the members of a kind, by index.
void AddMembers(const CaseResult& result, MemberKind kind, const char* forces, const char* uses,
                Json& json) {
  for (const MemberLoad& load : result.members) {
    if (load.kind != kind) continue;
    const auto at = static_cast<std::size_t>(load.index);
    if (*forces != 0) json[forces][at] = LargestForce(load);
    const auto least = load.Least();
    if (least && *least > 0) json[uses][at] = 1 / *least;
  }
}

/// Returns a table without the columns that have no value in any row.
Json TableJson(const std::string& title, const Rows& rows) {
  const auto lacks = [&rows](std::size_t column) {
    return std::all_of(rows.begin() + 1, rows.end(),
                       [&](const auto& row) { return row[column] == "-"; });
  };
  Json kept = Json::array();
  for (std::size_t r = 0; r < rows.size(); ++r) kept.push_back(Json::array());
  for (std::size_t column = 0; column < rows.front().size(); ++column) {
    if (rows.size() > 1 && lacks(column)) continue;
    for (std::size_t r = 0; r < rows.size(); ++r) kept[r].push_back(rows[r][column]);
  }
  return {{"title", title}, {"rows", kept}};
}

Json MemberTableJson(const CaseResult& result) {
  Rows rows{{"member", "kind", "force [N]", "utilization [%]", "buckling factor", "yield factor",
             "strength factor", "slack at load factor"}};
  for (const MemberLoad& load : result.members) {
    const auto least = load.Least();
    rows.push_back({load.name, NameOf(load.kind), Fixed(LargestForce(load), 3),
                    least && *least > 0 ? fmt::format("{:.3g}", 100 / *least) : "-",
                    FactorCell(load.buckling), FactorCell(load.yield), FactorCell(load.strength),
                    load.slack ? "now" : FactorCell(load.slackening)});
  }
  return TableJson("Members", rows);
}

Json ReactionTableJson(const std::vector<ReactionForce>& reactions) {
  Rows rows{{"reaction at", "kind", "x [N]", "y [N]", "z [N]", "torque x [N m]", "torque y [N m]",
             "torque z [N m]"}};
  for (const ReactionForce& one : reactions) {
    std::vector<std::string> row{one.name, one.kind};
    const Vec3 &f = one.force_n, &t = one.torque_n_m;
    for (const double x : {f.x, f.y, f.z}) row.push_back(Fixed(x, 3));
    for (const double x : {t.x, t.y, t.z}) row.push_back(Fixed(x, 4));
    rows.push_back(row);
  }
  return TableJson("Reactions", rows);
}

Json ModeTableJson(const Json& modes) {
  Rows rows{{"mode", "kind", "frequency [Hz]"}};
  for (const Json& mode : modes) {
    rows.push_back({std::to_string(rows.size()), mode["kind"].get<std::string>(),
                    fmt::format("{:.4g}", mode["frequency_hz"].get<double>())});
  }
  return TableJson("Modes", rows);
}

/// Returns a case without results.
Json EmptyCase(const ModelDef& def, const std::string& name) {
  const std::size_t cables = def.cables.size(), bodies = def.bodies.size();
  const std::size_t joints = def.joints.size();
  return {{"name", name},
          {"reason", ""},
          {"cables", Nulls(cables * viewer::kFrameCablesValues)},
          {"loads", Json::array()},
          {"reactions", Json::array()},
          {"body_force_n", Nulls(bodies)},
          {"joint_force_n", Nulls(joints)},
          {"cable_use", Nulls(cables)},
          {"body_use", Nulls(bodies)},
          {"joint_use", Nulls(joints)},
          {"modes", Json::array()},
          {"tables", Json::array()}};
}

void SetCable(std::size_t cable, double tension_n, const CableDef& def, Json& json) {
  const std::size_t at = cable * viewer::kFrameCablesValues;
  json["cables"][at] = tension_n;
  json["cables"][at + 1] = CableLength(def);
  json["cables"][at + 2] = def.rest_length_m;
}

Json LoadedCaseJson(const Json& scene, const ModelDef& described, const CaseResult& result,
                    int most_modes) {
  Json json = EmptyCase(described, result.loads.name);
  for (const LoadCaseSpec::NodeForce& load : result.loads.forces) {
    json["loads"].push_back(load.node);
    AppendVector(load.force_n, json["loads"]);
  }
  if (!result.at.found) {
    json["reason"] = "no equilibrium: " + result.at.why;
    return json;
  }
  json["displacement"] = DisplacementJson(scene, result.at.pose);
  for (const MemberLoad& load : result.members) {
    if (load.kind != MemberKind::kCable) continue;
    const auto cable = static_cast<std::size_t>(load.index);
    SetCable(cable, load.greatest_n, result.def.cables[cable], json);
  }
  AddMembers(result, MemberKind::kCable, "", "cable_use", json);
  AddMembers(result, MemberKind::kRod, "body_force_n", "body_use", json);
  AddMembers(result, MemberKind::kBar, "joint_force_n", "joint_use", json);
  const std::vector<ReactionForce> reactions = ReactionsOf(result);
  for (const ReactionForce& one : reactions) {
    AppendVector(one.point_m, json["reactions"]);
    AppendVector(one.force_n, json["reactions"]);
  }
  if (!result.members.empty()) json["tables"].push_back(MemberTableJson(result));
  if (!reactions.empty()) json["tables"].push_back(ReactionTableJson(reactions));
  if (result.modes) json["modes"] = ShapesJson(result.modes->modes, most_modes);
  if (!json["modes"].empty()) json["tables"].push_back(ModeTableJson(json["modes"]));
  return json;
}

/// Returns the length of a body's only rod; 0 without one.
double RodLength(const ModelDef& def, int body) {
  double length_m = 0;
  for (const CapsuleDef& rod : def.capsules) {
    if (rod.body != body) continue;
    if (length_m > 0) return 0;
    length_m =
        std::hypot(rod.to_m.x - rod.from_m.x, rod.to_m.y - rod.from_m.y, rod.to_m.z - rod.from_m.z);
  }
  return length_m;
}

Json SelfStressJson(const ModelDef& def, const ForceAnalysis& forces, std::size_t state) {
  const SelfStress& stress = forces.self_stress[state];
  Json json = EmptyCase(def, fmt::format("self-stress {}{}", state + 1,
                                         stress.feasible ? ", all cables in tension" : ""));
  Rows rows{{"member", "force density [N/m]", "force [N]"}};
  const auto add = [&rows](const std::string& name, double density_n_per_m, double force_n) {
    rows.push_back({name, fmt::format("{:.4g}", density_n_per_m), fmt::format("{:.4g}", force_n)});
  };
  for (std::size_t m = 0; m < forces.members.size(); ++m) {
    const StaticMember& member = forces.members[m];
    const auto at = static_cast<std::size_t>(member.index);
    if (member.kind == StaticMember::Kind::kCable) {
      SetCable(at, stress.force_n[m], def.cables[at], json);
    } else if (member.kind == StaticMember::Kind::kBar) {
      json["joint_force_n"][at] = stress.force_n[m];
    } else {
      continue;
    }
    add(StaticMemberName(def, member), stress.density_n_per_m[m], stress.force_n[m]);
  }
  for (std::size_t r = 0; r < stress.rod_density_n_per_m.size(); ++r) {
    const int body = forces.classical->rods[r];
    const double density_n_per_m = stress.rod_density_n_per_m[r];
    const double force_n = density_n_per_m * RodLength(def, body);
    json["body_force_n"][static_cast<std::size_t>(body)] = force_n;
    add(BodyName(def, body), density_n_per_m, force_n);
  }
  json["tables"].push_back(TableJson("Self-stress", rows));
  return json;
}

Json DescribedJson(const ModelDef& def, const ForceAnalysis& forces, int most_modes) {
  Json list = Json::array();
  if (!forces.mechanisms.empty() && most_modes > 0) {
    Json json = EmptyCase(def, "mechanisms");
    json["modes"] = ShapesJson(forces.mechanisms, most_modes);
    list.push_back(json);
  }
  for (std::size_t s = 0; s < std::min(forces.self_stress.size(), kMostShownStates); ++s) {
    list.push_back(SelfStressJson(def, forces, s));
  }
  return list;
}

Json PageJson(const ExperimentSpec& experiment, const AnalysisResult& result, int most_modes) {
  const ModelDef& def = result.robot.def;
  Json scene = viewer::SceneOf(experiment);
  scene["actions"] = Json::array();
  scene["contact_forces"] = true;  // reactions
  Json cases = Json::array();
  for (const CaseResult& one : result.cases) {
    cases.push_back(LoadedCaseJson(scene, def, one, most_modes));
  }
  Json summary = Json::array();
  for (const std::string& line : AnalysisLines(result)) summary.push_back(line);
  summary.push_back(fmt::format("{}, analyzed with taut {}", result.file, kVersion));
  return {{"version", viewer::kProtocolVersion},
          {"title", def.name},
          {"scene", scene},
          {"summary", summary},
          {"tables", Json::array({TableJson("Load cases", CaseRows(result))})},
          {"cases", cases},
          {"described", DescribedJson(def, result.forces, most_modes)}};
}

}  // namespace

int WriteAnalysisPage(const std::string& path, const ExperimentSpec& experiment,
                      const AnalysisResult& result, int most_modes) {
  std::string missing;
  const auto folder = viewer::FindWebFolder(missing);
  if (!folder) {
    fmt::print(stderr, "error: {}\n", missing);
    return kFailed;
  }
  std::ifstream file(*folder + "/report.html", std::ios::binary);
  const std::string form{std::istreambuf_iterator<char>(file), {}};
  const auto page = viewer::ReportPage(PageJson(experiment, result, most_modes), form);
  if (!page) {
    fmt::print(stderr, "error: {}/report.html is not the template of reports\n", *folder);
    return kFailed;
  }
  return WriteNamed(path, *page);
}

}  // namespace taut::cli
