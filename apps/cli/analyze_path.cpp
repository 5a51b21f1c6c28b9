// Output of load-displacement paths.
#include "analyze_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "json_values.h"
#include "output.h"
#include "table.h"

namespace taut::cli {
namespace {

using PathsJson = nlohmann::ordered_json;

/// Returns what happens at a point of the path; empty for most points.
std::string EventText(const ModelDef& def, const LoadedPoint& point) {
  std::string text = point.limit ? "limit point" : "";
  const auto add = [&](const std::vector<int>& cables, const char* change) {
    for (const int cable : cables) {
      text += fmt::format("{}{} goes {}", text.empty() ? "" : ", ",
                          def.cables[static_cast<std::size_t>(cable)].name, change);
    }
  };
  add(point.went_slack, "slack");
  add(point.went_taut, "taut");
  return text;
}

std::vector<std::string> RowOf(const ModelDef& def, const LoadedPoint& point) {
  const Move move = LargestMove(def, point.pose);
  return {fmt::format("{:.6g}", point.load_factor), fmt::format("{:.6g}", point.displacement_m),
          move.name.empty() ? "-" : fmt::format("{:.4g} {}", move.distance_m, move.name),
          point.stable ? "stable" : "unstable", EventText(def, point)};
}

Table NewTable() {
  Table table({"load factor", "displacement", "largest displacement", "equilibrium", "event"});
  table.Add({"", "m", "m", "", ""});
  return table;
}

/// Returns the verdict on a path: its first limit point or loss of stability, and where it ends.
std::string PathVerdict(const LoadCaseSpec& loads, const LoadPath& path, double to_factor) {
  std::string text = "load case " + loads.name + ": ";
  if (path.points.empty()) return text + path.why;
  const auto limit = std::find_if(path.points.begin(), path.points.end(),
                                  [](const LoadedPoint& point) { return point.limit; });
  const auto unstable = std::find_if(path.points.begin(), path.points.end(),
                                     [](const LoadedPoint& point) { return !point.stable; });
  if (limit != path.points.end()) {
    text += fmt::format("limit point at load factor {:.6g}", limit->load_factor);
  } else if (unstable != path.points.end()) {
    text += fmt::format("unstable from load factor {:.6g} on", unstable->load_factor);
  } else {
    text += fmt::format("no limit point up to load factor {:.6g}", path.points.back().load_factor);
  }
  if (!path.why.empty()) {
    text += fmt::format("; the path ends before load factor {:.6g}, at {:.6g}: {}", to_factor,
                        path.points.back().load_factor, path.why);
  }
  return text;
}

std::string PathText(const ModelDef& def, const LoadPath& path, bool all) {
  Table table = NewTable();
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const LoadedPoint& point = path.points[i];
    const bool turns = i > 0 && point.stable != path.points[i - 1].stable;
    const bool shown =
        all || i == 0 || i + 1 == path.points.size() || turns || !EventText(def, point).empty();
    if (shown) table.Add(RowOf(def, point));
  }
  return table.Text();
}

PathsJson PathJson(const ModelDef& def, const LoadCaseSpec& loads, const LoadPath& path) {
  PathsJson json{{"load_case", loads.name},
                 {"reached_end", path.why.empty()},
                 {"why_not", path.why.empty() ? PathsJson() : PathsJson(path.why)},
                 {"left_out", path.left_out},
                 {"points", PathsJson::array()}};
  const auto names = [&](const std::vector<int>& cables) {
    PathsJson list = PathsJson::array();
    for (const int c : cables) list.push_back(def.cables[static_cast<std::size_t>(c)].name);
    return list;
  };
  for (const LoadedPoint& point : path.points) {
    const Move move = LargestMove(def, point.pose);
    PathsJson positions = PathsJson::array();
    for (const BodyState& body : point.pose.bodies) positions.push_back(ToJson(body.position_m));
    json["points"].push_back(
        {{"load_factor", point.load_factor},
         {"displacement_m", point.displacement_m},
         {"largest_move", {{"of", move.name}, {"distance_m", move.distance_m}}},
         {"stable", point.stable},
         {"limit", point.limit},
         {"went_slack", names(point.went_slack)},
         {"went_taut", names(point.went_taut)},
         {"body_position_m", positions},
         {"cable_tension_n", point.cable_tension_n},
         {"bar_force_n", point.bar_force_n}});
  }
  return json;
}

}  // namespace

int FollowPaths(const std::string& file, const RobotSpec& robot,
                const std::vector<LoadCaseSpec>& cases, const std::vector<std::string>& notes,
                const PathArguments& args) {
  LoadPathOptions options;
  options.to_factor = args.to_factor;
  PathsJson json{{"format_version", 1},
                 {"model", robot.def.name},
                 {"file", file},
                 {"notes", notes},
                 {"paths", PathsJson::array()}};
  int exit = kOk;
  for (const std::string& note : notes) {
    if (!args.json) fmt::print("{}\n", note);
  }
  for (const LoadCaseSpec& loads : cases) {
    const LoadPath path = FollowLoads(robot.def, loads, options);
    if (!path.why.empty()) exit = kFailed;
    if (args.json) {
      json["paths"].push_back(PathJson(robot.def, loads, path));
      continue;
    }
    fmt::print("{}\n", PathVerdict(loads, path, args.to_factor));
    if (!path.points.empty()) fmt::print("{}", PathText(robot.def, path, args.tables));
  }
  if (args.json) {
    fmt::print("{}\n", json.dump(2, ' ', false, PathsJson::error_handler_t::replace));
  }
  return exit;
}

}  // namespace taut::cli
