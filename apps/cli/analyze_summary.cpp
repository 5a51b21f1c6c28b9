// Verdict and summary of the statics of `taut analyze`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analyze_names.h"
#include "analyze_report.h"
#include "member_groups.h"
#include "table.h"

namespace taut::cli {
namespace {

/// Result of all load cases together, from best to worst.
enum class Standing { kStands, kMoves, kUnstable, kNoEquilibrium };

Standing StandingOf(const CaseResult& result) {
  if (!result.at.found) return Standing::kNoEquilibrium;
  const bool negative = result.least_stiffness_n_per_m && *result.least_stiffness_n_per_m < 0;
  if (negative || (result.modes && result.modes->unstable > 0)) return Standing::kUnstable;
  if (result.modes && result.modes->mechanisms > 0) return Standing::kMoves;
  return Standing::kStands;
}

/// Returns the load case with the worst result; among equal results, the one with the least
/// stiffness.
const CaseResult& WorstOf(const std::vector<CaseResult>& cases) {
  const auto stiffness = [](const CaseResult& one) {
    return one.least_stiffness_n_per_m.value_or(INFINITY);
  };
  return *std::max_element(cases.begin(), cases.end(),
                           [&](const CaseResult& a, const CaseResult& b) {
                             const Standing of_a = StandingOf(a), of_b = StandingOf(b);
                             return of_a != of_b ? of_a < of_b : stiffness(a) > stiffness(b);
                           });
}

/// Returns how the described structure resists its mechanisms.
std::string Prestressed(const ForceAnalysis& forces) {
  const bool feasible = std::any_of(forces.self_stress.begin(), forces.self_stress.end(),
                                    [](const SelfStress& s) { return s.feasible; });
  if (!feasible || forces.mechanism_stiffness.empty()) return {};
  return forces.mechanism_stiffness.front() > 0 ? "prestress-stable" : "not stable by prestress";
}

std::string Stiffness(const CaseResult& result) {
  return result.least_stiffness_n_per_m
             ? fmt::format("least stiffness {:.6g} N/m", *result.least_stiffness_n_per_m)
             : std::string();
}

std::string VerdictOn(const AnalysisResult& result) {
  const CaseResult& worst = WorstOf(result.cases);
  const Standing standing = StandingOf(worst);
  constexpr const char* kTexts[] = {" stands", " stands, but mechanisms move freely",
                                    " does not stand: the equilibrium is unstable",
                                    " does not stand: no equilibrium"};  // indexed by Standing
  std::string text = result.robot.def.name + kTexts[static_cast<int>(standing)];
  if (result.cases.size() > 1) text += " (load case " + worst.loads.name + ")";
  std::string details;
  const auto add = [&](const std::string& part) {
    if (!part.empty()) details += (details.empty() ? ": " : ", ") + part;
  };
  if (standing == Standing::kNoEquilibrium) return text + ": " + worst.at.why;
  if (standing == Standing::kStands) add(Prestressed(result.forces));
  add(Stiffness(worst));
  return text + details;
}

std::string SelfStressLine(const ForceAnalysis& forces) {
  std::string line = fmt::format("states of self-stress: {}, mechanisms: {}, rigid motions: {}",
                                 forces.self_stress.size(), forces.mechanisms.size(), forces.rigid);
  if (!forces.rank.clear()) line += "; the rank is uncertain";
  return line;
}

std::string FormHint(const ForceAnalysis& forces) {
  return LacksPrestress(forces) ? "no state of self-stress has all cables in tension"
                                : std::string();
}

/// Returns the natural frequencies in one line; empty without elastic modes.
std::string FrequenciesLine(const CaseResult& result) {
  constexpr std::size_t kMost = 6;
  if (!result.modes) return {};
  std::string list;
  std::size_t count = 0;
  for (const Mode& mode : result.modes->modes) {
    if (mode.kind != Mode::Kind::kElastic || count == kMost) continue;
    list += fmt::format("{}{:.4g}", count++ == 0 ? "" : ", ", mode.frequency_hz);
  }
  if (count == 0) return {};
  return "natural frequencies: " + list + " Hz (load case " + result.loads.name + ")";
}

std::string CablesLine(const CableGroup& group, const CaseResult& result) {
  Range tension;
  for (const MemberLoad& load : result.members) {
    if (load.kind != MemberKind::kCable) continue;
    const auto cable = static_cast<std::size_t>(load.index);
    if (std::find(group.cables.begin(), group.cables.end(), cable) == group.cables.end()) continue;
    tension.Add(load.greatest_n);
  }
  return tension.empty() ? std::string() : group.name + ": tension " + tension.Text(3, "N");
}

std::string BarsLine(MemberKind kind, const CaseResult& result) {
  int count = 0;
  Range force;
  for (const MemberLoad& load : result.members) {
    if (load.kind != kind) continue;
    ++count, force.Add(load.least_n), force.Add(load.greatest_n);
  }
  if (count == 0) return {};
  return Counted(count, NameOf(kind)) + ": axial force " + force.Text(3, "N");
}

}  // namespace

std::vector<std::string> AnalysisLines(const AnalysisResult& result) {
  std::vector<std::string> lines{VerdictOn(result)};
  const auto add = [&lines](const std::string& line) {
    if (!line.empty()) lines.push_back(line);
  };
  for (const std::string& note : result.notes) add(note);
  add(SelfStressLine(result.forces));
  add(FormHint(result.forces));
  for (const CaseResult& one : result.cases) {
    if (one.open) {
      add(fmt::format("load case {}: {} forces are indeterminate (--tables lists their bounds)",
                      one.loads.name, one.open->forces.undetermined));
    }
  }
  const CaseResult& shown = WorstOf(result.cases);
  if (shown.at.found) {
    add(FrequenciesLine(shown));
    for (const CableGroup& group : GroupCables(result.robot, 4)) add(CablesLine(group, shown));
    add(BarsLine(MemberKind::kBar, shown));
    add(BarsLine(MemberKind::kRod, shown));
  }
  return lines;
}

std::string AnalysisSummary(const AnalysisResult& result) {
  const std::vector<std::string> all = AnalysisLines(result);
  CappedLines lines;
  for (std::size_t i = 1; i < all.size(); ++i) lines.Add(all[i]);
  return lines.Text(all.front() + "\n" + CaseTable(result));
}

}  // namespace taut::cli
