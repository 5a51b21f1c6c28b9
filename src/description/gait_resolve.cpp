#include <algorithm>
#include <map>

#include "description/gait_keys.h"
#include "description/number_list.h"

namespace taut {
namespace description {
namespace {

std::string Written(const CableMatch& match) {
  std::string out;
  for (const auto& set : match) {
    std::string one;
    for (const std::string& tag : set) one += (one.empty() ? "" : ", ") + tag;
    out += (out.empty() ? "[" : " or [") + one + "]";
  }
  return out;
}

std::vector<int> CablesOf(const CableMatch& match, const std::string& what, const SourceRef& at,
                          const RobotSpec& robot, Diagnostics& out) {
  std::vector<int> cables;
  std::vector<std::string> words;
  for (std::size_t c = 0; c < robot.cable_tags.size(); ++c) {
    const Tags& tags = robot.cable_tags[c];
    if (Matches(match, tags)) cables.push_back(static_cast<int>(c));
    words.insert(words.end(), tags.begin(), tags.end());
  }
  if (!cables.empty()) return cables;
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  std::string hint = "no cable of " + robot.def.name + " has all of these tags";
  for (const auto& set : match) {
    for (const std::string& word : set) {
      if (std::binary_search(words.begin(), words.end(), word)) continue;
      hint = "no cable of " + robot.def.name + " is called or tagged \"" + word + "\"; " +
             NameHint(word, words);
    }
  }
  out.Error(at, what + ": no cable matches " + Written(match), hint);
  return cables;
}

void Resolve(const SineGait& sine, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out) {
  std::map<int, std::pair<ResolvedGait::Wave, const SineWave*>> by_cable;
  for (const SineWave& wave : sine.waves) {
    std::string twice;
    for (const int cable : CablesOf(wave.cables, "wave " + wave.name, wave.at, robot, out)) {
      const std::string& name = robot.def.cables[static_cast<std::size_t>(cable)].name;
      const auto place = PlaceInChain(name);
      if (!place && wave.phase_per_segment_rad != 0.0) {
        out.Error(
            wave.at,
            "wave " + wave.name + ": phase_per_segment_rad needs a number at the end of " + name,
            "such as outer_top_2");
      }
      const double phase_rad =
          wave.phase_rad + (place ? place->number - 1 : 0) * wave.phase_per_segment_rad;
      const auto [other, fresh] =
          by_cable.insert({cable,
                           {{cable, wave.frequency_hz.value_or(sine.frequency_hz), phase_rad,
                             wave.amplitude, wave.offset},
                            &wave}});
      if (!fresh && twice.empty()) {
        twice = name + " has a wave already, " + other->second.second->name;
      }
    }
    if (!twice.empty()) {
      out.Error(wave.at, "wave " + wave.name + ": " + twice, "a cable has one wave");
    }
  }
  for (const auto& [cable, wave] : by_cable) {
    resolved.cables.push_back(cable);
    resolved.waves.push_back(wave.first);
  }
}

void Resolve(const CpgGait& cpg, const RobotSpec& robot, ResolvedGait& resolved, Diagnostics& out) {
  auto graph = FindCouplings(robot, cpg.symmetry, cpg.order, cpg.at, out);
  if (!graph) return;
  std::map<std::string, int> given;
  for (std::size_t g = 0; g < cpg.groups.size(); ++g) {
    given[cpg.groups[g].name] = static_cast<int>(g);
    const std::string& name = cpg.groups[g].name;
    if (std::find(graph->groups.begin(), graph->groups.end(), name) == graph->groups.end()) {
      out.Error(cpg.groups[g].at, "cpg.groups: " + robot.def.name + " has no group " + name,
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
    out.Error(cpg.at, "cpg.groups lacks " + text,
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
    for (const int cable : CablesOf(cpg.inverted, "cpg.inverted", cpg.at, robot, out)) {
      const auto found = std::find(resolved.cables.begin(), resolved.cables.end(), cable);
      if (found != resolved.cables.end()) {
        resolved.sign[static_cast<std::size_t>(found - resolved.cables.begin())] = -1.0;
      }
    }
  }
  resolved.graph = std::move(*graph);
}

void Resolve(const TableGait& table, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out) {
  std::vector<std::string> names;
  for (const CableDef& cable : robot.def.cables) names.push_back(cable.name);
  for (const std::string& name : table.cables) {
    const auto found = std::find(names.begin(), names.end(), name);
    const int cable = static_cast<int>(found - names.begin());
    if (found == names.end()) {
      out.Error(table.at, robot.def.name + " has no cable \"" + name + "\"", NameHint(name, names));
    } else if (std::count(resolved.cables.begin(), resolved.cables.end(), cable) > 0) {
      out.Error(table.at, "the table has " + name + " twice");
    } else {
      resolved.cables.push_back(cable);
    }
  }
}

}  // namespace
}  // namespace description

std::optional<ResolvedGait> ResolveGait(const GaitSpec& gait, const RobotSpec& robot,
                                        Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  ResolvedGait resolved;
  if (gait.sine) description::Resolve(*gait.sine, robot, resolved, out);
  if (gait.cpg) description::Resolve(*gait.cpg, robot, resolved, out);
  if (gait.table) description::Resolve(*gait.table, robot, resolved, out);
  if (out.items().size() != errors_before) return std::nullopt;
  return resolved;
}

std::optional<GaitSpec> NewCpgGait(const RobotSpec& robot, CpgSymmetry symmetry, Diagnostics& out,
                                   GaitDrives drives) {
  CpgGait cpg;
  cpg.symmetry = symmetry;
  if (drives == GaitDrives::kRestLength) cpg.amplitude = 0.01;  // 5 cm would be much of a cable
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

std::vector<GaitValue> GaitValues(GaitSpec& gait) {
  description::NumberList<GaitValue> list("");
  Keys(list, gait);
  return std::move(list.numbers);
}

}  // namespace taut
