#include "description/gait/gait_feedback_cpg.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace taut::description {
namespace {

const std::vector<std::string> kSaid{"frequency", "amplitude", "phase"};

std::vector<std::string> GoalOutputs(const FeedbackCpgGait& cpg) {
  std::vector<std::string> names;
  for (const FeedbackOscillator& oscillator : cpg.oscillators) {
    for (const std::string& said : kSaid) names.push_back(oscillator.name + "_" + said);
  }
  return names;
}

void CheckWeights(const std::vector<Neuron>& neurons, std::size_t least, std::size_t most,
                  const std::string& of, const SourceRef& at, Diagnostics& out) {
  for (const Neuron& neuron : neurons) {
    const std::size_t count = neuron.weights.size();
    if (least <= count && count <= most) continue;
    const SourceRef& where = neuron.at.line > 0 ? neuron.at : at;
    out.Error("network.wrong_number_of_weights", where,
              "neuron " + neuron.name + " has " + std::to_string(count) +
                  " weights, but there are " + std::to_string(least) +
                  (most > least ? " or " + std::to_string(most) : "") + " " + of);
  }
}

/// Checks conditions on several keys of a neural network.
void CheckNetwork(const NetworkSpec& network, const std::string& what, std::size_t least_inputs,
                  std::size_t most_inputs, const std::vector<std::string>& outputs,
                  const SourceRef& at, Diagnostics& out) {
  const std::size_t hidden = network.hidden.size();
  const SourceRef& where = network.at.line > 0 ? network.at : at;
  if (hidden < 1 || hidden > NetworkSpec::kMostHidden) {
    out.Error("network.bad_size", where,
              what + ".hidden must have 1 to 32 neurons, got " + std::to_string(hidden));
    return;
  }
  const std::string inputs = what == "cable_network"
                                 ? "inputs: stretch, tension"
                                 : "inputs: goal_x, goal_y, and optionally place";
  CheckWeights(network.hidden, least_inputs, most_inputs, inputs, at, out);
  const std::size_t first = network.hidden[0].weights.size();
  for (const Neuron& neuron : network.hidden) {
    const std::size_t count = neuron.weights.size();
    const auto possible = [&](std::size_t n) { return least_inputs <= n && n <= most_inputs; };
    if (count == first || !possible(count) || !possible(first)) continue;
    out.Error("network.wrong_number_of_weights", neuron.at.line > 0 ? neuron.at : at,
              what + ": neuron " + neuron.name + " has " + std::to_string(count) +
                  " weights, but " + network.hidden[0].name + " has " + std::to_string(first),
              "all hidden neurons must have the same inputs");
  }
  CheckWeights(network.outputs, hidden, hidden, "hidden neurons", at, out);
  for (const Neuron& neuron : network.outputs) {
    if (std::find(outputs.begin(), outputs.end(), neuron.name) != outputs.end()) continue;
    out.Error("network.unknown_output", neuron.at.line > 0 ? neuron.at : at,
              what + ".outputs: there is no output called " + neuron.name,
              NameHint(neuron.name, outputs));
  }
}

void CheckNetworks(const FeedbackCpgGait& cpg, const SourceRef& at, Diagnostics& out) {
  if (cpg.cable_network) CheckNetwork(*cpg.cable_network, "cable_network", 2, 2, kSaid, at, out);
  if (cpg.goal_network) {
    CheckNetwork(*cpg.goal_network, "goal_network", 2, 3, GoalOutputs(cpg), at, out);
  }
}

/// Returns the oscillator index of each cable, in ascending order of cables.
std::map<int, int> RolesOf(const FeedbackCpgGait& cpg, const RobotSpec& robot, Diagnostics& out) {
  std::map<int, int> roles;
  for (std::size_t i = 0; i < cpg.oscillators.size(); ++i) {
    const FeedbackOscillator& one = cpg.oscillators[i];
    for (const int cable : FindCables(one.cables, "oscillators " + one.name, one.at, robot, out)) {
      const auto [other, fresh] = roles.emplace(cable, static_cast<int>(i));
      if (fresh) continue;
      out.Error("gait.two_oscillators", one.at,
                "oscillators " + one.name + ": " +
                    robot.def.cables[static_cast<std::size_t>(cable)].name +
                    " already has an oscillator, of " +
                    cpg.oscillators[static_cast<std::size_t>(other->second)].name,
                "a cable can have only one oscillator");
      break;
    }
  }
  return roles;
}

/// Keeps the couplings of the groups in `cpg.groups`, in this order; removes all others.
bool KeepGroups(const FeedbackCpgGait& cpg, const std::string& robot, CouplingGraph& graph,
                Diagnostics& out) {
  std::map<std::string, int> given;
  bool good = true;
  for (std::size_t g = 0; g < cpg.groups.size(); ++g) {
    const std::string& name = cpg.groups[g].name;
    given[name] = static_cast<int>(g);
    if (std::find(graph.groups.begin(), graph.groups.end(), name) != graph.groups.end()) continue;
    out.Error("gait.unknown_group", cpg.groups[g].at.line > 0 ? cpg.groups[g].at : cpg.at,
              "feedback_cpg.groups: " + robot + " has no group " + name,
              NameHint(name, graph.groups));
    good = false;
  }
  std::vector<CouplingGraph::Coupling> kept;
  for (CouplingGraph::Coupling link : graph.couplings) {
    const auto found = given.find(graph.groups[static_cast<std::size_t>(link.group)]);
    if (found == given.end()) continue;
    link.group = found->second;
    kept.push_back(link);
  }
  graph.couplings = std::move(kept);
  graph.groups.clear();
  for (const CouplingGroup& group : cpg.groups) graph.groups.push_back(group.name);
  return good;
}

}  // namespace

void Check(const MapReader& map, NetworkSpec& network) {
  CheckTwice(network.hidden, "hidden neurons", map.scope());
  CheckTwice(network.outputs, "outputs", map.scope());
  std::map<std::string, const Neuron*> hidden;
  for (const Neuron& neuron : network.hidden) hidden[neuron.name] = &neuron;
  for (const Neuron& neuron : network.outputs) {
    if (neuron.name.empty() || hidden.count(neuron.name) == 0) continue;
    map.scope().out.Error("network.duplicate_neuron", neuron.at,
                          "a hidden neuron and an output are both called " + neuron.name,
                          "give each neuron a different name: parameters are named after neurons");
  }
}

void Check(const MapReader& map, FeedbackCpgGait& cpg) {
  CheckTwice(cpg.groups, "groups", map.scope());
  CheckTwice(cpg.oscillators, "oscillators", map.scope());
  if (map.Has("oscillators") && cpg.oscillators.empty() && map.scope().out.ok()) {
    map.Error("gait.no_oscillators", "oscillators",
              "feedback_cpg.oscillators needs at least one entry");
  }
  if (map.scope().out.ok()) CheckNetworks(cpg, cpg.at, map.scope().out);
}

void CheckNumbers(const FeedbackCpgGait& cpg, const SourceRef& at, Diagnostics& out) {
  if (!(cpg.convergence_per_s > 0.0 && cpg.integrator_step_s > 0.0)) {
    out.Error("gait.not_positive", at,
              "feedback_cpg.convergence_per_s and feedback_cpg.integrator_step_s must be positive");
  }
  CheckNetworks(cpg, at, out);
}

void Resolve(const FeedbackCpgGait& cpg, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const std::map<int, int> roles = RolesOf(cpg, robot, out);
  if (out.items().size() != errors_before || roles.empty()) return;
  std::vector<std::string> order;
  for (const auto& [cable, role] : roles) {
    order.push_back(robot.def.cables[static_cast<std::size_t>(cable)].name);
  }
  CouplingGraph graph;
  if (cpg.groups.empty()) {  // without groups, cable names need no number at the end
    for (const auto& [cable, role] : roles) graph.cables.push_back(cable);
  } else {
    auto found = FindCouplings(robot, cpg.symmetry, order, cpg.at, out);
    if (!found || !KeepGroups(cpg, robot.def.name, *found, out)) return;
    graph = std::move(*found);
  }
  std::map<int, int> joint_of;  // joint by the number at the end of a cable's name
  std::vector<int> number;
  for (const int cable : graph.cables) {
    const auto place = PlaceInChain(robot.def.cables[static_cast<std::size_t>(cable)].name);
    number.push_back(place ? place->number : 0);
    joint_of[number.back()] = 0;
  }
  int count = 0;
  for (auto& [at_end, joint] : joint_of) joint = count++;
  for (int j = 0; j < count; ++j) {
    resolved.place.push_back(count == 1 ? 0.0 : 1.0 - 2.0 * j / (count - 1));
  }
  for (std::size_t i = 0; i < graph.cables.size(); ++i) {
    const auto cable = static_cast<std::size_t>(graph.cables[i]);
    resolved.role.push_back(roles.at(graph.cables[i]));
    resolved.joint.push_back(joint_of.at(number[i]));
    const ActuatorDef& actuator = robot.def.cables[cable].actuator;
    const double most_n = actuator.kind == ActuatorDef::Kind::kNone
                              ? std::numeric_limits<double>::infinity()
                              : actuator.max_force_n;
    resolved.most_tension_n.push_back(most_n);
    if (!cpg.cable_network || (std::isfinite(most_n) && most_n > 0.0)) continue;
    out.Error("cable.no_max_force", cpg.cable_network->at.line > 0 ? cpg.cable_network->at : cpg.at,
              "cable_network: the actuator of " + robot.def.cables[cable].name +
                  " has no max_force_n, to which the network's input is relative",
              "add max_force_n, or leave out `cable_network`");
    return;
  }
  resolved.cables = graph.cables;
  resolved.graph = std::move(graph);
}

}  // namespace taut::description
