// `taut analyze --inverse`: cable forces of least cost that hold a robot in its pose.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "analyze_inverse.h"
#include "analyze_names.h"
#include "json_values.h"
#include "member_groups.h"
#include "output.h"
#include "table.h"

namespace taut::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Answer {
  LoadCaseSpec loads;
  HoldingForces forces;
};

HoldingOptions OptionsOf(const InverseArguments& args, const ModelDef& def) {
  HoldingOptions options;
  options.minimise = args.minimise;
  options.bounds.assign(def.cables.size(), args.bounds);
  options.touches = FindTouches(def, kTouch_m);
  options.calibration_rest_m = args.calibration_rest_m;
  return options;
}

std::string Unbalance(const ModelDef& def, const HoldingForces& forces) {
  std::string text;
  for (const Unbalanced& left : forces.left) {
    const Vec3 &f = left.force_n, &t = left.torque_n_m;
    text += fmt::format(
        "  unbalanced on body {}: ({:.4g}, {:.4g}, {:.4g}) N and ({:.4g}, {:.4g}, {:.4g}) N m\n",
        BodyName(def, left.body), f.x, f.y, f.z, t.x, t.y, t.z);
  }
  return text;
}

std::string Text(const ModelDef& def, const Answer& answer) {
  const HoldingForces& forces = answer.forces;
  std::string text = fmt::format("\nLoad case {}{}\n", answer.loads.name,
                                 answer.loads.weight ? "" : ", without weight");
  for (const std::string& note : forces.notes) text += "  " + note + "\n";
  if (!forces.found) {
    return text + "  no cable forces hold this pose: " + forces.why + "\n" + Unbalance(def, forces);
  }
  text += fmt::format("  residual: {:.2g} N, objective: {:.6g}\n", forces.residual_n, forces.cost);
  Table cables({"cable", "tension", "force density", "rest length", "command", ""});
  cables.Add({"", "N", "N/m", "m", "m", ""});
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const auto& bound = forces.at_bound;
    const bool at_bound = std::find(bound.begin(), bound.end(), static_cast<int>(c)) != bound.end();
    cables.Add({def.cables[c].name, Fixed(forces.cable_tension_n[c], 3),
                Fixed(forces.cable_force_density_n_per_m[c], 3), Fixed(forces.rest_length_m[c], 6),
                Fixed(forces.command_m[c], 6), at_bound ? "at bound" : ""});
  }
  if (!def.cables.empty()) text += "\n" + cables.Text();
  Table bars({"bar", "force", "rest length"});
  bars.Add({"", "N", "m"});
  bool any = false;
  for (std::size_t j = 0; j < def.joints.size(); ++j) {
    if (!IsBar(def.joints[j])) continue;
    any = true;
    bars.Add({def.joints[j].name, Fixed(forces.bar_force_n[j], 3), Fixed(forces.bar_rest_m[j], 6)});
  }
  return any ? text + "\n" + bars.Text() : text;
}

/// Returns the verdict and a summary of at most ten lines.
std::string InverseSummary(const RobotSpec& robot, const std::vector<Answer>& answers,
                           const std::vector<std::string>& notes, const InverseArguments& args) {
  const bool all =
      std::all_of(answers.begin(), answers.end(), [](const Answer& a) { return a.forces.found; });
  CappedLines lines;
  for (const std::string& note : notes) lines.Add(note);
  for (const Answer& answer : answers) {
    const HoldingForces& forces = answer.forces;
    const std::string name = "load case " + answer.loads.name;
    for (const std::string& note : forces.notes) lines.Add(name + ": " + note);
    if (!forces.found) {
      lines.Add(name + ": no cable forces hold this pose: " + forces.why);
      continue;
    }
    lines.Add(fmt::format("{}: objective {:.6g}, cables at a bound: {}", name, forces.cost,
                          forces.at_bound.size()));
    for (const CableGroup& group : GroupCables(robot, answers.size() > 1 ? 2 : 5)) {
      const auto range = [&](const std::vector<double>& of, int digits, const char* unit) {
        return RangeOver(group, [&](std::size_t c) { return of[c]; }).Text(digits, unit);
      };
      lines.Add(fmt::format("{}: tension {}, command {}", group.name,
                            range(forces.cable_tension_n, 3, "N"),
                            range(forces.command_m, 6, "m")));
    }
  }
  return lines.Text(fmt::format("{}: {} the described pose (least {})", robot.def.name,
                                all ? "tensions hold" : "no tensions hold",
                                HoldingCostName(args.minimise)));
}

Json CablesJson(const ModelDef& def, const HoldingForces& forces) {
  Json cables = Json::array();
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const auto& bound = forces.at_bound;
    cables.push_back(
        {{"name", def.cables[c].name},
         {"tension_n", forces.cable_tension_n[c]},
         {"force_density_n_per_m", forces.cable_force_density_n_per_m[c]},
         {"rest_length_m", forces.rest_length_m[c]},
         {"command_m", forces.command_m[c]},
         {"at_bound", std::find(bound.begin(), bound.end(), static_cast<int>(c)) != bound.end()}});
  }
  return cables;
}

Json AnswerJson(const ModelDef& def, const Answer& answer) {
  const HoldingForces& forces = answer.forces;
  Json json{{"name", answer.loads.name},
            {"weight", answer.loads.weight},
            {"found", forces.found},
            {"why", forces.found ? Json() : Json(forces.why)},
            {"notes", forces.notes}};
  if (!forces.found) {
    json["left"] = Json::array();
    for (const Unbalanced& left : forces.left) {
      json["left"].push_back({{"body", BodyName(def, left.body)},
                              {"force_n", ToJson(left.force_n)},
                              {"torque_n_m", ToJson(left.torque_n_m)}});
    }
    return json;
  }
  json["residual_n"] = forces.residual_n;
  json["cost"] = forces.cost;
  json["cables"] = CablesJson(def, forces);
  json["bars"] = Json::array();
  for (std::size_t j = 0; j < def.joints.size(); ++j) {
    if (!IsBar(def.joints[j])) continue;
    json["bars"].push_back({{"name", def.joints[j].name},
                            {"force_n", forces.bar_force_n[j]},
                            {"rest_length_m", forces.bar_rest_m[j]}});
  }
  return json;
}

}  // namespace

int Inverse(const std::string& file, const RobotSpec& robot, const std::vector<LoadCaseSpec>& cases,
            const std::vector<std::string>& notes, const InverseArguments& args) {
  const ModelDef& def = robot.def;
  Diagnostics found;
  std::vector<Answer> answers;
  for (const LoadCaseSpec& loads : cases) {
    answers.push_back({loads, FindHoldingForces(def, loads, OptionsOf(args, def), found)});
  }
  if (!found.ok()) return Fail(found, kBadInput);
  const bool all =
      std::all_of(answers.begin(), answers.end(), [](const Answer& a) { return a.forces.found; });
  if (args.json) {
    Json json{{"format_version", 1},
              {"model", def.name},
              {"file", file},
              {"notes", notes},
              {"minimise", HoldingCostName(args.minimise)}};
    json["load_cases"] = Json::array();
    for (const Answer& answer : answers) json["load_cases"].push_back(AnswerJson(def, answer));
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    fmt::print("{}", InverseSummary(robot, answers, notes, args));
  }
  if (!args.json && args.tables) {
    for (const Answer& answer : answers) fmt::print("{}", Text(def, answer));
    fmt::print("\n");
  }
  for (const Answer& answer : answers) {
    if (answer.forces.found) continue;
    fmt::print(stderr, "error: load case {}: {}\n", answer.loads.name, answer.forces.why);
  }
  if (!args.json) {
    std::vector<std::string> next = args.again;
    next.push_back(args.tables ? "--json" : "--tables");
    SayNext(next);
  }
  return all ? kOk : kFailed;
}

}  // namespace taut::cli
