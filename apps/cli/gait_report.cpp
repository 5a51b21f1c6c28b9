// Gaits and oscillator networks as tables, JSON and SVG.
#include "gait_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

namespace taut::cli {
namespace {

constexpr int kLargestMatrix = 24;  // largest number of oscillators whose matrix fits a terminal

std::string Name(const RobotSpec& robot, const CouplingGraph& graph, int oscillator) {
  const int cable = graph.cables[static_cast<std::size_t>(oscillator)];
  return robot.def.cables[static_cast<std::size_t>(cable)].name;
}

std::vector<int> CouplingsOfGroups(const CouplingGraph& graph) {
  std::vector<int> counts(graph.groups.size());
  for (const auto& link : graph.couplings) ++counts[static_cast<std::size_t>(link.group)];
  return counts;
}

std::string Matrix(const RobotSpec& robot, const CouplingGraph& graph, int width) {
  const int count = static_cast<int>(graph.cables.size());
  std::map<std::pair<int, int>, int> group;
  for (const auto& link : graph.couplings) group[{link.to, link.from}] = link.group;
  std::string out =
      "Groups of the couplings (row: driven oscillator, column: driving oscillator):\n";
  out += fmt::format("{:{}}", "", width + 4);
  for (int j = 0; j < count; ++j) out += fmt::format("{:>4}", j);
  out += '\n';
  for (int i = 0; i < count; ++i) {
    out += fmt::format("{:>3} {:{}}", i, Name(robot, graph, i), width);
    for (int j = 0; j < count; ++j) {
      const auto found = group.find({i, j});
      out += found == group.end() ? "   ." : fmt::format("{:>4}", found->second);
    }
    out += '\n';
  }
  return out + '\n';
}

/// Returns the number of the joint: "outer_top_2" is on joint 2. Cables without a number share one
/// joint.
int Joint(const std::string& name) {
  const std::size_t bar = name.rfind('_');
  int joint = 0;
  for (std::size_t i = bar == std::string::npos ? name.size() : bar + 1; i < name.size(); ++i) {
    if (name[i] < '0' || name[i] > '9' || joint > 9999) return 1;
    joint = 10 * joint + (name[i] - '0');
  }
  return std::max(1, joint);
}

}  // namespace

std::string GaitTable(GaitSpec& gait) {
  std::string out;
  for (const GaitValue& value : GaitValues(gait)) {
    out += fmt::format("{:52} {:>14.8g} {}\n", value.name, *value.value, value.unit);
  }
  if (gait.table) {
    out += fmt::format("{} cables, {} rows, {} s\n", gait.table->cables.size(),
                       gait.table->rows.size(), gait.table->time_s.back());
  }
  return out;
}

std::string GaitJson(GaitSpec& gait) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const GaitValue& value : GaitValues(gait)) {
    values.push_back({{"name", value.name}, {"unit", value.unit}, {"value", *value.value}});
  }
  const nlohmann::ordered_json json{{"ok", true}, {"name", gait.name}, {"values", values}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string CouplingTables(const RobotSpec& robot, const CouplingGraph& graph) {
  const int count = static_cast<int>(graph.cables.size());
  const std::vector<int> of_group = CouplingsOfGroups(graph);
  const auto used =
      std::count_if(of_group.begin(), of_group.end(), [](int couplings) { return couplings > 0; });
  int width = 0;
  for (int i = 0; i < count; ++i) {
    width = std::max(width, static_cast<int>(Name(robot, graph, i).size()));
  }
  std::string out = fmt::format(
      "{} oscillators, {} couplings, {} groups.\n"
      "Parameters to learn (weight and phase of each group, frequency, amplitude): {}.\n"
      "\n",
      count, graph.couplings.size(), used, 2 * used + 2);
  if (count <= kLargestMatrix) {
    out += Matrix(robot, graph, width);
  } else {
    std::vector<int> of_oscillator(graph.cables.size());
    for (const auto& link : graph.couplings) ++of_oscillator[static_cast<std::size_t>(link.to)];
    for (int i = 0; i < count; ++i) {
      out += fmt::format("{:>3} {:{}} {:>3} couplings\n", i, Name(robot, graph, i), width,
                         of_oscillator[static_cast<std::size_t>(i)]);
    }
    out += '\n';
  }
  for (std::size_t g = 0; g < graph.groups.size(); ++g) {
    if (of_group[g] > 0) {
      out += fmt::format("group {:>3} {:40} {:>4} couplings\n", g, graph.groups[g], of_group[g]);
    }
  }
  return out;
}

std::string CouplingJson(const RobotSpec& robot, const CouplingGraph& graph) {
  using Json = nlohmann::ordered_json;
  Json oscillators = Json::array(), couplings = Json::array();
  for (std::size_t i = 0; i < graph.cables.size(); ++i) {
    oscillators.push_back(Name(robot, graph, static_cast<int>(i)));
  }
  for (const auto& link : graph.couplings) {
    couplings.push_back({{"to", Name(robot, graph, link.to)},
                         {"from", Name(robot, graph, link.from)},
                         {"group", graph.groups[static_cast<std::size_t>(link.group)]}});
  }
  const Json json{{"robot", robot.def.name},
                  {"oscillators", std::move(oscillators)},
                  {"groups", graph.groups},
                  {"couplings", std::move(couplings)}};
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string CouplingSvg(const RobotSpec& robot, const CouplingGraph& graph) {
  constexpr double kRing = 70, kPitch = 200, kMargin = 110;
  std::map<int, std::vector<int>> joints;
  for (int i = 0; i < static_cast<int>(graph.cables.size()); ++i) {
    joints[Joint(Name(robot, graph, i))].push_back(i);
  }
  std::vector<std::pair<double, double>> at(graph.cables.size());
  double x = kMargin;
  for (const auto& [joint, oscillators] : joints) {
    for (std::size_t k = 0; k < oscillators.size(); ++k) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) /
                           static_cast<double>(oscillators.size());
      at[static_cast<std::size_t>(oscillators[k])] = {x + kRing * std::sin(angle),
                                                      kMargin - kRing * std::cos(angle)};
    }
    x += kPitch;
  }
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"9\">\n"
      "<title>{}: {} oscillators, {} couplings</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      x - kPitch + kMargin, 2 * kMargin + 20, robot.def.name, graph.cables.size(),
      graph.couplings.size());
  std::set<std::pair<int, int>> pairs;
  for (const auto& link : graph.couplings) pairs.insert(std::minmax(link.to, link.from));
  for (const auto& [a, b] : pairs) {
    const auto [ax, ay] = at[static_cast<std::size_t>(a)];
    const auto [bx, by] = at[static_cast<std::size_t>(b)];
    const bool same = Joint(Name(robot, graph, a)) == Joint(Name(robot, graph, b));
    out += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-opacity=\"{}\"/>\n",
        ax, ay, bx, by, same ? "#c0392b" : "#2c5f8a", same ? 0.8 : 0.3);
  }
  for (int i = 0; i < static_cast<int>(graph.cables.size()); ++i) {
    const auto [cx, cy] = at[static_cast<std::size_t>(i)];
    out += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"#222\"/>\n"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
        cx, cy, cx, cy < kMargin ? cy - 8 : cy + 15, Name(robot, graph, i));
  }
  out += fmt::format(
      "<text x=\"10\" y=\"{:.0f}\">red: same joint; blue: neighboring joints, which share a "
      "segment</text>\n"
      "</svg>\n",
      2 * kMargin + 12);
  return out;
}

}  // namespace taut::cli
