// Tables of `taut analyze`.
#include "analyze_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analyze_names.h"
#include "table.h"

namespace taut::cli {
namespace {

std::vector<std::string> Factors(const MemberLoad& load) {
  return {FactorCell(load.buckling), FactorCell(load.yield), FactorCell(load.strength),
          FactorCell(load.slackening)};
}

std::string Cables(const CaseResult& result) {
  Table table(
      {"cable", "length", "rest length", "tension", "force density", "yield", "strength", "slack"});
  table.Add({"", "m", "m", "N", "N/m", "factor", "factor", "factor"});
  for (const MemberLoad& load : result.members) {
    if (load.kind != MemberKind::kCable) continue;
    const CableDef& cable = result.def.cables[static_cast<std::size_t>(load.index)];
    const double length = CableLength(cable);
    table.Add({load.name, Fixed(length, 6), Fixed(cable.rest_length_m, 6),
               load.slack ? "slack" : Fixed(load.greatest_n, 3), Fixed(load.greatest_n / length, 3),
               FactorCell(load.yield), FactorCell(load.strength), FactorCell(load.slackening)});
  }
  return table.Text();
}

std::string BarsAndRods(const CaseResult& result) {
  Table table({"bar or rod", "min force", "max force", "buckling", "yield", "strength"});
  table.Add({"", "N", "N", "factor", "factor", "factor"});
  for (const MemberLoad& load : result.members) {
    if (load.kind == MemberKind::kCable) continue;
    const std::vector<std::string> factors = Factors(load);
    table.Add({load.name, Fixed(load.least_n, 3), Fixed(load.greatest_n, 3), factors[0], factors[1],
               factors[2]});
  }
  return table.Text();
}

void AddCells(const Vec3& f, const Vec3& t, std::vector<std::string>& row) {
  for (const double x : {f.x, f.y, f.z}) row.push_back(Fixed(x, 3));
  for (const double x : {t.x, t.y, t.z}) row.push_back(Fixed(x, 4));
}

/// Formats the forces that hold the robot in the world: supports, anchors, ground.
std::string Reactions(const CaseResult& result) {
  Table table({"reaction", "force x", "y", "z", "torque x", "y", "z"});
  table.Add({"", "N", "N", "N", "N m", "N m", "N m"});
  const std::vector<ReactionForce> reactions = ReactionsOf(result);
  for (const ReactionForce& one : reactions) {
    const std::string kind = one.kind;
    std::vector<std::string> row{(kind == "ground" ? "ground at " : kind + " ") + one.name};
    AddCells(one.force_n, one.torque_n_m, row);
    table.Add(row);
  }
  return reactions.empty() ? std::string() : table.Text();
}

std::string Limit(double force_n) {
  return std::isfinite(force_n) ? Fixed(force_n, 3) : "unbounded";
}

/// Formats the forces that friction and redundant supports leave undetermined, each with its
/// limits.
std::string OpenForces(const CaseResult& result) {
  const CaseResult::Open& open = *result.open;
  std::string text =
      fmt::format("\nIndeterminate forces from friction and supports: {}; individual bounds\n",
                  open.forces.undetermined);
  if (!open.forces.found) return text + "  no bounds: " + open.forces.why + "\n";
  Table table({"force", "min", "max"});
  table.Add({"", "N", "N"});
  std::size_t rows = 0;
  const auto add = [&](const std::string& name, const ForceInterval& limits) {
    const double most_n = std::max(std::fabs(limits.low_n), std::fabs(limits.high_n));
    if (limits.high_n - limits.low_n <= 1e-6 * most_n + 2 * limits.uncertain_n) return;
    table.Add({name, Limit(limits.low_n), Limit(limits.high_n)});
    ++rows;
  };
  for (std::size_t t = 0; t < open.touches.size(); ++t) {
    add("ground at " + BodyName(result.def, open.touches[t].body), open.forces.touch[t]);
  }
  for (std::size_t j = 0; j < result.def.joints.size(); ++j) {
    const std::string& name = result.def.joints[j].name;
    if (IsBar(result.def.joints[j])) continue;  // the bar's rest length determines its force
    add(name + ", x", open.forces.joint_x[j]);
    add(name + ", y", open.forces.joint_y[j]);
    add(name + ", z", open.forces.joint_z[j]);
  }
  return text +
         (rows > 0 ? table.Text() : "  only along the ground; the normal forces are determinate\n");
}

std::string ModeTable(const CaseResult& result, int most) {
  const Modes& modes = *result.modes;
  if (!modes.why.empty()) return "  none: " + modes.why + "\n";
  std::string text = fmt::format("  rigid motions: {}, mechanisms: {}, unstable: {}\n", modes.rigid,
                                 modes.mechanisms, modes.unstable);
  Table table({"mode", "frequency", "kind", "body with largest displacement"});
  table.Add({"", "Hz", "", ""});
  int number = 0;
  for (const Mode& mode : modes.modes) {
    if (mode.kind == Mode::Kind::kRigid) continue;
    if (++number > most) break;
    table.Add({fmt::format("{}", number), fmt::format("{:.7g}", mode.frequency_hz),
               NameOf(mode.kind), BodyName(result.def, MovesMost(mode))});
  }
  return text + (number == 0 ? "" : table.Text());
}

/// Summarizes a load case: slack cables, least safety factor, first slack cable, largest
/// displacement, least stiffness.
std::string Verdict(const CaseResult& result) {
  std::string slack;
  for (const MemberLoad& load : result.members) {
    if (load.slack) slack += (slack.empty() ? "" : ", ") + load.name;
  }
  std::string text = "  slack: " + (slack.empty() ? std::string("none") : slack) + "\n";
  if (const MemberLoad* const least = result.LeastSafe()) {
    text += fmt::format("  least safety factor: {} ({} of {})\n", FactorCell(least->Least()),
                        least->LeastOf(), least->name);
  }
  // After a cable is slack, tensions no longer change in proportion to the load.
  if (const MemberLoad* const first = slack.empty() ? result.FirstSlack() : nullptr) {
    text += fmt::format("  first slack: {} at {} times the load\n", first->name,
                        FactorCell(first->slackening));
  }
  if (!result.move.name.empty()) {
    text += fmt::format("  largest displacement: {:.4g} m of {}\n", result.move.distance_m,
                        result.move.name);
  }
  if (result.least_stiffness_n_per_m) {
    text += fmt::format("  least stiffness: {:.6g} N/m{}\n", *result.least_stiffness_n_per_m,
                        *result.least_stiffness_n_per_m < 0 ? ": UNSTABLE" : "");
  }
  return text;
}

std::string CaseText(const CaseResult& result, int most_modes) {
  std::string text = fmt::format("\nLoad case {}", result.loads.name);
  if (!result.loads.weight) text += ", without weight";
  if (!result.at.found) return text + "\n  no equilibrium: " + result.at.why + "\n";
  text += fmt::format("\n  equilibrium: residual {:.2g} N after {} linear solves{}\n",
                      result.at.residual_n, result.at.iterations, WayText(result.at.way));
  text += Verdict(result);
  for (const std::string& part : result.at.left_out) text += "  left out: " + part + "\n";
  const bool others = std::any_of(result.members.begin(), result.members.end(),
                                  [](const MemberLoad& m) { return m.kind != MemberKind::kCable; });
  if (!result.def.cables.empty()) text += "\n" + Cables(result);
  if (others) text += "\n" + BarsAndRods(result);
  const std::string reactions = Reactions(result);
  if (!reactions.empty()) text += "\n" + reactions;
  if (result.open) text += OpenForces(result);
  if (result.modes) text += "\nModes about the equilibrium\n" + ModeTable(result, most_modes);
  return text;
}

}  // namespace

std::string SafetyFactorText(double factor) {
  return factor < 1000 ? fmt::format("{:.2f}", factor) : fmt::format("{:.3g}", factor);
}

std::string FactorCell(const std::optional<double>& factor) {
  return factor ? SafetyFactorText(*factor) : "-";
}

bool AnalysisResult::Found() const {
  return std::all_of(cases.begin(), cases.end(), [](const CaseResult& c) { return c.at.found; });
}

std::string AnalysisTables(const AnalysisResult& result, int most_modes) {
  std::string text = fmt::format("Model {}\n", result.robot.def.name);
  for (const std::string& note : result.notes) text += "  " + note + "\n";
  text += ForceTables(result.robot.def, result.forces);
  for (const CaseResult& one : result.cases) text += CaseText(one, most_modes);
  return text;
}

}  // namespace taut::cli
