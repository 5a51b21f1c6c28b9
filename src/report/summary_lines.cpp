// Short summary of a run: the verdict, then one line per kind of load.
#include "report/summary_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/facts.h"
#include "report/reference.h"
#include "taut/summary.h"

namespace taut {
namespace {

const char* Verdict(const RunSummary& run) {
  if (run.status.bits & kStatusNonFinite) return "failed";
  if (run.interrupted) return "interrupted";
  return run.status.bits == kStatusOk ? "ok" : "warning";
}

/// Returns the item with the largest `value`; null if there are no items.
template <class Items, class Value>
auto Largest(const Items& items, const Value& value) -> decltype(items.data()) {
  const auto most = std::max_element(items.begin(), items.end(), [&](const auto& a, const auto& b) {
    return value(a) < value(b);
  });
  return most == items.end() ? nullptr : &*most;
}

std::string TensionLine(const RunSummary& run) {
  if (run.cables.empty()) return {};
  std::string line =
      fmt::format("largest tension: {:.3f} N in {}; elastic part: {:.3f} N",
                  run.system_max_tension_n, run.system_max_tension_cable, run.system_max_elastic_n);
  if (run.simulated_s > 5) {
    line += fmt::format(", from 5 s on: {:.3f} N", run.system_max_elastic_after_start_n);
  }
  return line;
}

std::string OverloadLine(const RunSummary& run) {
  if (run.overloads.empty()) return {};
  return fmt::format("exceeded limits of members: {}", run.overloads.size());
}

std::string RodLine(const RunSummary& run) {
  const StrutSummary* const rod =
      Largest(run.struts, [](const StrutSummary& strut) { return -strut.least_n; });
  if (!rod) return {};
  return fmt::format("largest compression of a rod: {:.3f} N in {}", std::max(0.0, -rod->least_n),
                     rod->name);
}

std::string AnchorLine(const RunSummary& run) {
  const AnchorSummary* const anchor =
      Largest(run.anchors, [](const AnchorSummary& one) { return one.max_force_n; });
  if (!anchor) return {};
  return fmt::format("largest reaction of an anchor: {:.3f} N at {}", anchor->max_force_n,
                     anchor->name);
}

std::string ActuatorLine(const RunSummary& run) {
  int count = 0;
  double energy_j = 0, net_j = 0;
  for (const CableSummary& cable : run.cables) {
    if (cable.max_force_n == 0.0 && cable.max_speed_m_per_s == 0.0) continue;
    ++count, energy_j += cable.energy_j, net_j += cable.net_energy_j;
  }
  if (count == 0) return {};
  const CableSummary* const most =
      Largest(run.cables, [](const CableSummary& cable) { return cable.max_force_n; });
  return fmt::format("actuators: {}; largest force: {:.3f} N in {}; energy: {:.3f} J, net {:.3f} J",
                     count, most->max_force_n, most->name, energy_j, net_j);
}

std::string MotorLine(const RunSummary& run) {
  int count = 0;
  double supply_j = 0, current_a = 0, hottest_c = -INFINITY;
  for (const CableSummary& cable : run.cables) {
    if (!cable.motor) continue;
    ++count;
    supply_j += cable.motor->energy_from_supply_j;
    current_a = std::max(current_a, cable.motor->max_current_a);
    hottest_c = std::max(hottest_c, cable.motor->max_winding_temperature_c);
  }
  if (count == 0) return {};
  return fmt::format(
      "motors: {}; energy from the supply: {:.3f} J; largest current: {:.3f} A; hottest winding: "
      "{:.1f} degC",
      count, supply_j, current_a, hottest_c);
}

}  // namespace

std::vector<std::string> report::HeadLines(const RunSummary& run) {
  std::vector<std::string> lines{
      fmt::format("{}: {}; {:g} s simulated in {:.3g} s ({:.3g} times real time)", run.experiment,
                  Verdict(run), run.simulated_s, run.wall_s, RealTimeFactor(run))};
  if (run.start) lines.push_back(StartLine(*run.start));
  if (run.status.bits != kStatusOk) {
    lines.push_back(
        fmt::format("WARNING: {} (first at {:.4g} s)", StatusText(run), run.status.first_time_s));
  }
  if (run.left_out.contacts > 0) lines.push_back("WARNING: " + LeftOutText(run));
  return lines;
}

std::vector<std::string> SummaryLines(const RunSummary& run) {
  std::vector<std::string> lines = report::HeadLines(run);
  for (std::string line : {TensionLine(run), OverloadLine(run), RodLine(run), AnchorLine(run),
                           ActuatorLine(run), MotorLine(run)}) {
    if (!line.empty()) lines.push_back(std::move(line));
  }
  for (const DragSummary& drag : run.drags) {
    lines.push_back(fmt::format("drag {}: mean {:.4g} N", drag.name, drag.force_n.mean));
  }
  for (std::string& line : report::ReferenceDifferences(run)) lines.push_back(std::move(line));
  return lines;
}

std::string StartLine(const StartChange& start) {
  std::string slack;
  for (const std::string& name : start.slack_cables) slack += (slack.empty() ? "" : ", ") + name;
  return fmt::format(
      "settled at the start: largest displacement {:.4g} m{}{}; robot size {:.4g} m; slack: {}",
      start.largest_displacement_m, start.displaced_node.empty() ? "" : " of ",
      start.displaced_node, start.size_m, slack.empty() ? "none" : slack);
}

}  // namespace taut
