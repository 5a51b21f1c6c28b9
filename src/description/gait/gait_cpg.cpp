#include "description/gait/gait_cpg.h"

#include <algorithm>
#include <map>

namespace taut {
namespace description {

void Check(const MapReader& map, CpgGait& cpg) { CheckTwice(cpg.groups, "groups", map.scope()); }

void CheckNumbers(const CpgGait& cpg, const SourceRef& at, Diagnostics& out) {
  if (cpg.convergence_per_s > 0.0 && cpg.integrator_step_s > 0.0) return;
  out.Error("gait.not_positive", at,
            "cpg.convergence_per_s and cpg.integrator_step_s must be positive");
}

void Resolve(const CpgGait& cpg, const RobotSpec& robot, ResolvedGait& resolved, Diagnostics& out) {
  auto graph = FindCouplings(robot, cpg.symmetry, cpg.order, cpg.at, out);
  if (!graph) return;
  std::map<std::string, int> given;
  for (std::size_t g = 0; g < cpg.groups.size(); ++g) {
    given[cpg.groups[g].name] = static_cast<int>(g);
    const std::string& name = cpg.groups[g].name;
    if (std::find(graph->groups.begin(), graph->groups.end(), name) == graph->groups.end()) {
      out.Error("gait.unknown_group", cpg.groups[g].at,
                "cpg.groups: " + robot.def.name + " has no group " + name,
                NameHint(name, graph->groups));
    }
  }
  std::vector<bool> used(graph->groups.size());
  for (const CouplingGraph::Coupling& link : graph->couplings) used[std::size_t(link.group)] = true;
  std::vector<std::string> missing;
  for (std::size_t g = 0; g < graph->groups.size(); ++g) {
    if (used[g] && given.count(graph->groups[g]) == 0) missing.push_back(graph->groups[g]);
  }
  if (!missing.empty()) {
    std::string text = missing[0];
    for (std::size_t i = 1; i < missing.size() && i < 3; ++i) text += ", " + missing[i];
    if (missing.size() > 3) text += " and " + std::to_string(missing.size() - 3) + " more";
    out.Error("gait.group_missing", cpg.at, "cpg.groups lacks " + text,
              "`taut gait create` writes a file with all groups of a robot");
    return;
  }
  for (CouplingGraph::Coupling& link : graph->couplings) {
    link.group = given[graph->groups[std::size_t(link.group)]];
  }
  graph->groups.clear();
  for (const CouplingGroup& group : cpg.groups) graph->groups.push_back(group.name);
  resolved.cables = graph->cables;
  resolved.sign.assign(graph->cables.size(), 1.0);
  if (!cpg.inverted.empty()) {
    for (const int cable : FindCables(cpg.inverted, "cpg.inverted", cpg.at, robot, out)) {
      const auto found = std::find(resolved.cables.begin(), resolved.cables.end(), cable);
      if (found != resolved.cables.end()) {
        resolved.sign[static_cast<std::size_t>(found - resolved.cables.begin())] = -1.0;
      }
    }
  }
  resolved.graph = std::move(*graph);
}

}  // namespace description

std::optional<GaitSpec> NewCpgGait(const RobotSpec& robot, CpgSymmetry symmetry, Diagnostics& out,
                                   GaitDrives drives) {
  CpgGait cpg;
  cpg.symmetry = symmetry;
  if (drives == GaitDrives::kRestLength) cpg.amplitude = 0.01;  // [m]; 0.05 is too large
  const auto graph = FindCouplings(robot, symmetry, {}, {}, out);
  if (!graph) return std::nullopt;
  for (const std::string& name : graph->groups) cpg.groups.push_back({name, 0.0, 0.0, {}});
  GaitSpec gait;
  gait.name = robot.def.name + "_cpg";
  gait.description = "Couplings of " + robot.def.name + ", not learned yet.";
  gait.drives = drives;
  gait.cpg = std::move(cpg);
  return gait;
}

}  // namespace taut
