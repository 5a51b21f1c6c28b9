// Verdict and summary of `taut check`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "check_report.h"
#include "member_groups.h"
#include "table.h"
#include "taut/env.h"
#include "taut/loads.h"
#include "taut/run.h"
#include "taut/summary.h"

namespace taut::cli {
namespace {

constexpr std::size_t kMostGroups = 6;  ///< Limit of the groups in a summary.

std::string Contents(const ModelDef& def) {
  return fmt::format("{}, {}, {}; moving mass {:.6f} kg", Counted(def.bodies.size(), "body"),
                     Counted(def.cables.size(), "cable"), Counted(def.nodes.size(), "node"),
                     TotalMass(def));
}

std::string Events(const ExperimentSpec& experiment) {
  std::string text;
  const auto add = [&](std::size_t count, const char* one) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + Counted(count, one);
  };
  add(experiment.pushes.size(), "push");
  add(experiment.drags.size(), "drag");
  add(experiment.phases.size(), "phase");
  return text.empty() ? text : "events: " + text;
}

std::string GroupLine(const ModelDef& def, const CableGroup& group) {
  const auto range = [&](auto quantity, int digits, const char* unit) {
    return RangeOver(group, [&](std::size_t c) { return quantity(def.cables[c]); })
        .Text(digits, unit);
  };
  return fmt::format(
      "{}: length {}, tension {}, stiffness {}", group.name, range(CableLength, 4, "m"),
      range(CableTension, 3, "N"),
      range([](const CableDef& cable) { return cable.stiffness_n_per_m; }, 0, "N/m"));
}

std::string RodLine(const ModelDef& def, const std::vector<JointLoad>& joints) {
  Range force;
  const std::vector<StrutForce> struts = StrutForces(def, StartForces(def, joints));
  for (const StrutForce& strut : struts) force.Add(strut.axial.middle_n);
  if (struts.empty()) return {};
  return fmt::format("{}: axial force {} (tension positive)", Counted(struts.size(), "rod"),
                     force.Text(3, "N"));
}

/// Returns the largest net force of cables, weight and joints on a body. In a model, no ground can
/// balance this force.
std::string NetLine(const ModelDef& def, const std::vector<JointLoad>& joints) {
  const std::vector<LeftLoad> left = LeftAtStart(def, joints);
  double most_n = -1;
  std::size_t body = 0;
  for (std::size_t b = 0; b < left.size(); ++b) {
    if (def.bodies[b].fixed) continue;
    const Vec3& f = left[b].force_n;
    const double size_n = std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
    if (size_n > most_n) most_n = size_n, body = b;
  }
  if (most_n < 0) return {};
  return fmt::format("net force at the start, without contacts: at most {} N, on {}",
                     Fixed(most_n, 3), def.bodies[body].name);
}

}  // namespace

std::string SchemesLine(const ExperimentSpec& experiment) {
  std::map<CableScheme, int> counts;
  const CableIntegration integration = IntegrationOf(experiment);
  for (const CableScheme scheme : integration.schemes) ++counts[scheme];
  std::string text;
  for (const auto& [scheme, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "Cables per integration scheme: " : ", ", count,
                        CableSchemeName(scheme));
  }
  if (integration.substeps > 1) {
    text += fmt::format("; {} substeps a step", integration.substeps);
  }
  return text;
}

std::string EnvironmentLine(const ExperimentSpec& experiment) {
  if (!experiment.environment) return {};
  const double period_s = experiment.environment->period_s;
  return fmt::format("Environment: {} and {} every {:g} s, {:.0f} steps per episode",
                     Counted(experiment.environment->actions.size(), "action"),
                     Counted(ObservedChannels(experiment).size(), "observation"), period_s,
                     experiment.duration_s / period_s);
}

std::string CheckSummary(const std::string& path, const RobotSpec& robot,
                         const ExperimentSpec* experiment, const StartChange* settled) {
  const ModelDef& def = robot.def;
  std::string verdict = path + ": good: ";
  CappedLines lines;
  if (experiment) {
    verdict += fmt::format("experiment {}, {:g} s in steps of {:g} s, {}", experiment->name,
                           experiment->duration_s, LongestStep(*experiment),
                           Counted(experiment->controllers.size(), "controller"));
    lines.Add(fmt::format("model {}: {}", def.name, Contents(def)));
    lines.Add(SchemesLine(*experiment));
    lines.Add(Events(*experiment));
    lines.Add(EnvironmentLine(*experiment));
  } else {
    verdict += fmt::format("model {}, {}", def.name, Contents(def));
  }
  if (settled) lines.Add(StartLine(*settled));
  for (const CableGroup& group : GroupCables(robot, experiment ? 3 : kMostGroups)) {
    lines.Add(GroupLine(def, group));
  }
  const std::vector<JointLoad> joints = StartJointLoads(def);
  if (joints.size() == def.joints.size()) {
    lines.Add(RodLine(def, joints));
    lines.Add(NetLine(def, joints));
  }
  return lines.Text(verdict);
}

}  // namespace taut::cli
