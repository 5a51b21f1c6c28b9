// Table of load cases: the first lines of `taut analyze`.
#include <fmt/format.h>

#include <algorithm>

#include "analyze_report.h"
#include "table.h"

namespace taut::cli {
namespace {

/// Returns the sum of the vertical reactions.
double ReactionZ_n(const CaseResult& result) {
  double sum_n = 0;
  for (const ReactionForce& one : ReactionsOf(result)) sum_n += one.force_n.z;
  // Loads on points of the world, such as half of the wind on a bar that ends there, need equal and
  // opposite reactions.
  for (const LoadCaseSpec::NodeForce& load : result.loads.forces) {
    if (result.def.nodes[static_cast<std::size_t>(load.node)].body == kWorld) {
      sum_n -= load.force_n.z;
    }
  }
  return sum_n;
}

/// Displacements below it are rounding errors of the search for the equilibrium.
constexpr double kNoMove_m = 1e-12;

std::string DisplacementCell(const CaseResult& result) {
  if (result.move.name.empty()) return "-";
  if (result.move.distance_m < kNoMove_m) return "0";
  return fmt::format("{:.4g} {}{}", 1000 * result.move.distance_m, result.move.name,
                     ExceedsDisplacement(result) ? " > limit" : "");
}

std::string SafetyCell(const CaseResult& result) {
  const MemberLoad* const least = result.LeastSafe();
  if (least == nullptr) return "-";
  return fmt::format("{} {} {}", SafetyFactorText(*least->Least()), least->LeastOf(), least->name);
}

std::string SlackCell(const CaseResult& result) {
  const auto slack = std::count_if(result.members.begin(), result.members.end(),
                                   [](const MemberLoad& load) { return load.slack; });
  if (slack > 0) return fmt::format("now: {}", slack);
  const MemberLoad* const first = result.FirstSlack();
  if (first == nullptr) return "-";
  return fmt::format("{} x {}", SafetyFactorText(*first->slackening), first->name);
}

}  // namespace

bool ExceedsDisplacement(const CaseResult& result) {
  const auto& limit_m = result.loads.max_displacement_m;
  return result.at.found && limit_m && result.move.distance_m > *limit_m;
}

std::vector<std::vector<std::string>> CaseRows(const AnalysisResult& result) {
  std::vector<std::vector<std::string>> rows{{"load case", "max displacement [mm]",
                                              "least safety factor", "first slack at",
                                              "reactions z [N]"}};
  for (const CaseResult& one : result.cases) {
    if (!one.at.found) {
      rows.push_back({one.loads.name, "no equilibrium", "-", "-", "-"});
      continue;
    }
    rows.push_back({one.loads.name, DisplacementCell(one), SafetyCell(one), SlackCell(one),
                    Fixed(ReactionZ_n(one), 3)});
  }
  return rows;
}

std::string CaseTable(const AnalysisResult& result) {
  const auto rows = CaseRows(result);
  Table table(rows.front());
  for (std::size_t i = 1; i < rows.size(); ++i) table.Add(rows[i]);
  return table.Text();
}

}  // namespace taut::cli
