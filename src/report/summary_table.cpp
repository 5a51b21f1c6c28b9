// Summary of a run as tables for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/facts.h"
#include "report/reference.h"
#include "report/summary_lines.h"
#include "taut/summary.h"

namespace taut {
namespace {

constexpr int kCell = 8;                   ///< Width of a number in characters.
constexpr std::size_t kPhasesAbreast = 3;  ///< Number of phases that fit into 100 characters.

/// Returns the number of decimals that shows about four digits.
int DecimalsFor(double size) { return size >= 1000.0 ? 1 : size >= 10.0 ? 2 : size >= 1.0 ? 3 : 4; }

std::string Cell(double value, int decimals, int width = kCell) {
  return std::isfinite(value) ? fmt::format("{:>{}.{}f}", value, width, decimals)
                              : fmt::format("{:>{}}", "-", width);
}

std::string RangeCells(const Range& range, bool complete, int decimals) {
  std::string out;
  for (const double value : {range.mean, range.min, range.max}) {
    out += complete ? Cell(value, decimals) : fmt::format("{:>{}}", "-", kCell);
  }
  return out;
}

template <class Items>
std::size_t NameWidth(const Items& items) {
  std::size_t width = 10;
  for (const auto& item : items) width = std::max(width, item.name.size());
  return width;
}

/// Returns the table of cables for phases first to last - 1, with the maxima of the whole run.
std::string PhaseTable(const RunSummary& run, std::size_t first, std::size_t last) {
  const std::size_t name_width = NameWidth(run.cables);
  const int decimals = DecimalsFor(run.system_max_tension_n);
  std::string phases = fmt::format("{:<{}}", "", name_width);
  std::string heads = fmt::format("{:<{}}", "tension [N]", name_width);
  for (std::size_t i = first; i < last; ++i) {
    const PhaseSpec& phase = run.phases[i];
    std::string title = fmt::format("{} {:g}..{:g} s", phase.name, phase.from_s, phase.to_s);
    if (title.size() > 3 * kCell) title = phase.name.substr(0, 3 * kCell);
    phases += fmt::format(" {:>{}}", title, 3 * kCell);
    heads += fmt::format(" {:>{}}{:>{}}{:>{}}", "mean", kCell, "min", kCell, "max", kCell);
  }
  phases += fmt::format("  {:>{}}", "whole", kCell);
  heads += fmt::format("  {:>{}}", "max", kCell);
  std::string out = "\n" + phases + "\n" + heads + "\n";
  for (const CableSummary& cable : run.cables) {
    out += fmt::format("{:<{}}", cable.name, name_width);
    for (std::size_t i = first; i < last; ++i) {
      const bool known = i < cable.tension.phases.size() && report::Complete(run, run.phases[i]);
      out += " " + RangeCells(known ? cable.tension.phases[i] : Range(), known, decimals);
    }
    out += "  " + Cell(cable.tension.max_n, decimals) + "\n";
  }
  return out;
}

std::string SystemLines(const RunSummary& run) {
  std::string out = fmt::format(
      "\nlargest tension: {:.3f} N in {}\n"
      "largest elastic part: {:.3f} N",
      run.system_max_tension_n, run.system_max_tension_cable, run.system_max_elastic_n);
  if (run.simulated_s > 5) {
    out += fmt::format("; from 5 s on: {:.3f} N", run.system_max_elastic_after_start_n);
  }
  return out + "\n";
}

/// Returns tables of rod loads and of reactions of anchored bodies.
std::string LoadTables(const RunSummary& run) {
  std::string out;
  if (!run.struts.empty()) {
    const std::size_t name_width = NameWidth(run.struts);
    out += fmt::format("\n{:<{}} {:>12}{:>12}\n", "rod [N]", name_width, "compression", "tension");
    double size = 0;
    for (const StrutSummary& strut : run.struts) {
      size = std::max({size, -strut.least_n, strut.greatest_n});
    }
    for (const StrutSummary& strut : run.struts) {
      out += fmt::format("{:<{}} {}{}\n", strut.name, name_width,
                         Cell(std::max(0.0, -strut.least_n), DecimalsFor(size), 12),
                         Cell(std::max(0.0, strut.greatest_n), DecimalsFor(size), 12));
    }
  }
  if (!run.anchors.empty()) {
    const std::size_t name_width = NameWidth(run.anchors);
    out += fmt::format("\n{:<{}} {:>14}{:>18}\n", "anchor", name_width, "max force [N]",
                       "max torque [N m]");
    for (const AnchorSummary& anchor : run.anchors) {
      out += fmt::format("{:<{}} {}{}\n", anchor.name, name_width,
                         Cell(anchor.max_force_n, DecimalsFor(anchor.max_force_n), 14),
                         Cell(anchor.max_torque_n_m, DecimalsFor(anchor.max_torque_n_m), 18));
    }
  }
  return out;
}

/// Returns a table with one row per exceeded limit of a member.
std::string OverloadTable(const RunSummary& run) {
  if (run.overloads.empty()) return {};
  const std::size_t name_width = NameWidth(run.overloads);
  std::string out =
      fmt::format("\n{:<{}} {:<8}{:<10}{:>14}{:>15}{:>14}\n", "overloaded", name_width, "member",
                  "limit", "capacity [N]", "max force [N]", "first at [s]");
  for (const Overload& one : run.overloads) {
    out += fmt::format("{:<{}} {:<8}{:<10}{:>14.4g}{:>15.4g}{:>14.4g}\n", one.name, name_width,
                       NameOf(one.kind), NameOf(one.limit), one.bears_n, one.carried_n,
                       one.first_time_s);
  }
  return out;
}

std::string DragTable(const RunSummary& run) {
  if (run.drags.empty()) return {};
  const std::size_t name_width = NameWidth(run.drags);
  std::string out = fmt::format("\n{:<{}} {:>{}}{:>{}}{:>{}}\n", "drag [N]", name_width, "mean",
                                kCell, "min", kCell, "max", kCell);
  for (const DragSummary& drag : run.drags) {
    const double size = std::max(std::abs(drag.force_n.min), std::abs(drag.force_n.max));
    out += fmt::format("{:<{}} {}\n", drag.name, name_width,
                       RangeCells(drag.force_n, true, DecimalsFor(size)));
  }
  return out;
}

/// Returns the table of cables with a moving rest length or a motor. Other cables are omitted.
std::string ActuatorTable(const RunSummary& run) {
  std::string rows;
  const std::size_t name_width = NameWidth(run.cables);
  for (const CableSummary& cable : run.cables) {
    if (cable.max_force_n == 0.0 && cable.max_speed_m_per_s == 0.0) continue;
    rows += fmt::format("{:<{}} {:>14.2f}{:>17.4f}{:>15.3f}{:>12.3f}{:>12.3f}\n", cable.name,
                        name_width, cable.max_force_n, cable.max_speed_m_per_s, cable.max_power_w,
                        cable.energy_j, cable.net_energy_j);
  }
  if (rows.empty()) return {};
  return fmt::format("\n{:<{}} {:>14}{:>17}{:>15}{:>12}{:>12}\n", "actuator", name_width,
                     "max force [N]", "max speed [m/s]", "max power [W]", "energy [J]", "net [J]") +
         rows;
}

/// Returns the table of power and energy of motors.
std::string MotorTable(const RunSummary& run) {
  std::string rows;
  const std::size_t name_width = NameWidth(run.cables);
  double supply_j = 0, cable_j = 0, winding_j = 0;
  for (const CableSummary& cable : run.cables) {
    if (!cable.motor) continue;
    const MotorSummary& m = *cable.motor;
    supply_j += m.energy_from_supply_j;
    cable_j += m.energy_to_cable_j;
    winding_j += m.energy_in_winding_j;
    rows += fmt::format("{:<{}} {:>12.3f}{:>12.3f}{:>13.3f}{:>17.3f}{:>15.1f}\n", cable.name,
                        name_width, m.energy_from_supply_j, m.energy_to_cable_j,
                        m.energy_in_winding_j, m.max_current_a, m.max_winding_temperature_c);
  }
  if (rows.empty()) return {};
  return fmt::format("\n{:<{}} {:>12}{:>12}{:>13}{:>17}{:>15}\n", "motor", name_width, "supply [J]",
                     "cable [J]", "winding [J]", "max current [A]", "winding [degC]") +
         rows +
         fmt::format("{:<{}} {:>12.3f}{:>12.3f}{:>13.3f}\n", "all", name_width, supply_j, cable_j,
                     winding_j);
}

}  // namespace

std::string SummaryTable(const RunSummary& summary) {
  std::string out;
  for (const std::string& line : report::HeadLines(summary)) out += line + "\n";
  if (!summary.cables.empty()) {
    for (std::size_t i = 0; i == 0 || i < summary.phases.size(); i += kPhasesAbreast) {
      out += PhaseTable(summary, i, std::min(i + kPhasesAbreast, summary.phases.size()));
    }
    out += SystemLines(summary);
  }
  return out + OverloadTable(summary) + LoadTables(summary) + DragTable(summary) +
         ActuatorTable(summary) + MotorTable(summary) + report::ReferenceLines(summary);
}

}  // namespace taut
