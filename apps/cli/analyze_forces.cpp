// Self-stresses and mechanisms in the output of `taut analyze`: the member forces without loads,
// and the motions that change no member's length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analyze_names.h"
#include "analyze_report.h"
#include "table.h"

namespace taut::cli {
namespace {

constexpr std::size_t kMostStates = 6;  ///< Maximum number of columns of a table of self-stresses.

std::string GapText(const RankGap& rank) {
  return fmt::format("{} (smallest singular value kept: {:.3g}, largest dropped: {:.3g}{})",
                     rank.rank, rank.smallest_kept, rank.largest_dropped,
                     rank.clear() ? "" : "; RATIO BELOW 1000: the rank is uncertain");
}

std::string Counts(const ForceAnalysis& f) {
  std::string text = fmt::format(
      "  members: {}, degrees of freedom: {}, rank: {}\n"
      "  states of self-stress: {}, mechanisms: {}, rigid motions: {}",
      f.members.size(), f.unknowns, GapText(f.rank), f.self_stress.size(), f.mechanisms.size(),
      f.rigid);
  if (f.free_turns > 0) text += fmt::format(", free rotations: {}", f.free_turns);
  text += "\n";
  if (f.classical) {
    const ClassicalCount& c = *f.classical;
    text += fmt::format(
        "  as pin-jointed: nodes: {}, members: {}, rank: {}\n"
        "    states of self-stress: {}, mechanisms: {}, rigid motions: {}\n",
        c.nodes, c.members, GapText(c.rank), c.self_stresses, c.mechanisms, c.rigid);
  }
  return text;
}

std::string Prestress(const ForceAnalysis& f) {
  std::string text;
  const auto feasible = std::count_if(f.self_stress.begin(), f.self_stress.end(),
                                      [](const SelfStress& s) { return s.feasible; });
  if (LacksPrestress(f)) {
    text += "  no state of self-stress with all cables in tension was found";
    text += FormFindingMayHelp(f) ? " (--form --tension_n 10 finds a shape that has one)\n" : "\n";
  } else if (feasible > 0 && !f.mechanism_stiffness.empty()) {
    const double least = f.mechanism_stiffness.front();
    text += fmt::format(
        "  {}: least stiffness of the mechanisms: {:.4g} times the largest force density of a "
        "cable\n",
        least > 0 ? "stable by prestress" : "NOT STABLE by prestress", least);
  }
  return text;
}

/// Formats force densities, one column per state of self-stress.
std::string States(const ModelDef& def, const ForceAnalysis& f) {
  const std::size_t shown = std::min(f.self_stress.size(), kMostStates);
  if (shown == 0) return {};
  std::vector<std::string> head{"force density"}, kinds{"N/m"};
  for (std::size_t s = 0; s < shown; ++s) {
    head.push_back(fmt::format("state {}", s + 1));
    kinds.push_back(f.self_stress[s].feasible ? "feasible" : "");
  }
  Table table(head);
  table.Add(kinds);
  for (std::size_t m = 0; m < f.members.size(); ++m) {
    const StaticMember& member = f.members[m];
    if (member.kind != StaticMember::Kind::kCable && member.kind != StaticMember::Kind::kBar) {
      continue;
    }
    std::vector<std::string> row{StaticMemberName(def, member)};
    for (std::size_t s = 0; s < shown; ++s) {
      row.push_back(Fixed(f.self_stress[s].density_n_per_m[m], 6));
    }
    table.Add(row);
  }
  for (std::size_t r = 0; f.classical && r < f.classical->rods.size(); ++r) {
    std::vector<std::string> row{BodyName(def, f.classical->rods[r])};
    for (std::size_t s = 0; s < shown; ++s) {
      const auto& rods = f.self_stress[s].rod_density_n_per_m;
      row.push_back(r < rods.size() ? Fixed(rods[r], 6) : "-");
    }
    table.Add(row);
  }
  std::string text = table.Text();
  if (shown < f.self_stress.size()) {
    text += fmt::format("  ... and {} more states\n", f.self_stress.size() - shown);
  }
  return text;
}

}  // namespace

bool LacksPrestress(const ForceAnalysis& forces) {
  const auto is_cable = [](const StaticMember& member) {
    return member.kind == StaticMember::Kind::kCable;
  };
  const auto feasible = [](const SelfStress& s) { return s.feasible; };
  return std::any_of(forces.members.begin(), forces.members.end(), is_cable) &&
         std::none_of(forces.self_stress.begin(), forces.self_stress.end(), feasible);
}

bool FormFindingMayHelp(const ForceAnalysis& forces) {
  return forces.rigid == 6 && LacksPrestress(forces);
}

std::string ForceTables(const ModelDef& def, const ForceAnalysis& forces) {
  std::string text = "\nDescribed pose\n" + Counts(forces) + Prestress(forces);
  for (const std::string& part : forces.left_out) text += "  left out: " + part + "\n";
  const std::string states = States(def, forces);
  return states.empty() ? text : text + "\n" + states;
}

}  // namespace taut::cli
