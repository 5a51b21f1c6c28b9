// Coupling graph of a CPG, derived from the model: couplings between oscillators, and groups of
// couplings with equal parameters (docs/theory/gaits.md, eq. G.8 to G.10).
#include <algorithm>
#include <map>
#include <set>

#include "description/gait/gait_parts.h"
#include "description/yaml/reader.h"

namespace taut {
namespace description {
namespace {

constexpr std::size_t kMaxOscillators = 65535;  // StepCpg uses 16-bit indices

const std::string& CableName(const RobotSpec& robot, int cable) {
  return robot.def.cables[static_cast<std::size_t>(cable)].name;
}

bool HasActuator(const RobotSpec& robot, int cable) {
  const CableDef& def = robot.def.cables[static_cast<std::size_t>(cable)];
  return def.actuator.kind != ActuatorDef::Kind::kNone;
}

/// Returns the cables that have an oscillator, in order. Returns an empty list after an error.
std::vector<int> Oscillators(const RobotSpec& robot, const std::vector<std::string>& order,
                             const SourceRef& at, Diagnostics& out) {
  std::vector<int> cables;
  const std::string too_many =
      "the gait has more than " + std::to_string(kMaxOscillators) + " oscillators";
  if (order.size() > kMaxOscillators) {
    out.Error("gait.too_many_oscillators", at, too_many);
    return cables;
  }
  std::vector<std::string> names;
  for (std::size_t c = 0; c < robot.def.cables.size(); ++c) {
    const int cable = static_cast<int>(c);
    names.push_back(CableName(robot, cable));
    if (order.empty() && HasActuator(robot, cable)) cables.push_back(cable);
  }
  const std::size_t errors_before = out.items().size();
  std::set<std::string> seen;
  for (const std::string& name : order) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      out.Error("cable.unknown", at, "cpg.order: there is no cable \"" + name + "\"",
                NameHint(name, names));
      continue;
    }
    cables.push_back(static_cast<int>(found - names.begin()));
    if (!seen.insert(name).second)
      out.Error("gait.duplicate_cable", at, "cpg.order contains " + name + " twice");
    if (!HasActuator(robot, cables.back())) {
      out.Error("cable.no_actuator", at, "cpg.order: " + name + " has no actuator",
                "give the cable's builder in the model an `actuator:`");
    }
  }
  if (cables.empty() && order.empty())
    out.Error("gait.no_actuated_cable", at, "no cable of the robot has an actuator");
  if (cables.size() > kMaxOscillators) out.Error("gait.too_many_oscillators", at, too_many);
  return out.items().size() == errors_before ? cables : std::vector<int>();
}

/// Returns, for each cable, the bodies to which it is attached.
std::vector<std::set<int>> BodiesOf(const RobotSpec& robot, const std::vector<int>& cables) {
  std::vector<std::set<int>> bodies;
  for (const int cable : cables) {
    std::set<int>& of = bodies.emplace_back();
    for (const auto& attachment : robot.def.cables[static_cast<std::size_t>(cable)].attachments) {
      if (attachment.body != kWorld) of.insert(attachment.body);
    }
  }
  return bodies;
}

bool ShareABody(const std::set<int>& a, const std::set<int>& b) {
  return std::any_of(a.begin(), a.end(), [&](int body) { return b.count(body) > 0; });
}

/// Roles of cables in a chain, and the role and number of each oscillator.
struct Chain {
  std::vector<std::string> roles;
  std::vector<std::size_t> role;  ///< Index into `roles`, per oscillator.
  std::vector<int> number;
};

std::optional<Chain> FindChain(const RobotSpec& robot, const std::vector<int>& cables,
                               const SourceRef& at, Diagnostics& out) {
  Chain chain;
  for (const int cable : cables) {
    const auto place = PlaceInChain(CableName(robot, cable));
    if (!place) {
      out.Error("gait.cable_without_number", at,
                "the name of cable " + CableName(robot, cable) + " does not end in a number",
                "use names such as outer_top_2, by which symmetric couplings distinguish cables, "
                "or write `symmetry: none`");
      return std::nullopt;
    }
    const auto found = std::find(chain.roles.begin(), chain.roles.end(), place->role);
    chain.role.push_back(static_cast<std::size_t>(found - chain.roles.begin()));
    chain.number.push_back(place->number);
    if (found == chain.roles.end()) chain.roles.push_back(place->role);
  }
  return chain;
}

/// Returns the index of the unordered pair {j, k} in the list (0,0), (0,1), ..., (1,1), ... of
/// `count` elements.
std::size_t PairIndex(std::size_t j, std::size_t k, std::size_t count) {
  const std::size_t low = std::min(j, k), high = std::max(j, k);
  return low * count - low * (low + 1) / 2 + high;
}

/// Adds a group for each relation and each unordered pair of `names`. The relation with index
/// `same` excludes pairs of equal names.
void NameGroups(const std::vector<std::string>& relations, std::size_t same,
                const std::vector<std::string>& names, std::vector<std::string>& groups,
                std::vector<std::vector<int>>& index) {
  for (std::size_t relation = 0; relation < relations.size(); ++relation) {
    std::vector<int>& of = index.emplace_back();
    for (std::size_t j = 0; j < names.size(); ++j) {
      for (std::size_t k = j; k < names.size(); ++k) {
        const bool left_out = relation == same && j == k;
        of.push_back(left_out ? -1 : static_cast<int>(groups.size()));
        if (!left_out) groups.push_back(relations[relation] + "." + names[j] + "." + names[k]);
      }
    }
  }
}

/// Groups couplings by the roles of their two cables, and by relative position along the chain. The
/// second cable is in front of, next to or behind the first.
void GroupBySegments(const Chain& chain, CouplingGraph& graph) {
  std::vector<std::vector<int>> index;
  NameGroups({"front", "same", "behind"}, 1, chain.roles, graph.groups, index);
  for (CouplingGraph::Coupling& link : graph.couplings) {
    const auto a = static_cast<std::size_t>(link.to), b = static_cast<std::size_t>(link.from);
    const int ahead = chain.number[a] - chain.number[b];
    const std::size_t relation = ahead > 0 ? 0 : ahead == 0 ? 1 : 2;
    link.group = index[relation][PairIndex(chain.role[a], chain.role[b], chain.roles.size())];
  }
}

bool GroupByIndex(const RobotSpec& robot, const Chain& chain, CouplingGraph& graph,
                  const SourceRef& at, Diagnostics& out) {
  const int count = static_cast<int>(chain.roles.size());
  std::vector<std::string> names;
  for (int j = 0; j < count; ++j) names.push_back(std::to_string(j));
  std::vector<std::vector<int>> index;
  NameGroups({"rp0", "rp1", "rp2"}, 1, names, graph.groups, index);
  for (CouplingGraph::Coupling& link : graph.couplings) {
    const int relation = (link.to - link.from) / count + 1;  // integer division, rounds toward zero
    if (relation < 0 || relation > 2) {
      out.Error("gait.index_too_far", at,
                "symmetry: index couples oscillators up to " + std::to_string(2 * count - 1) +
                    " places apart, but " + CableName(robot, graph.cables[std::size_t(link.to)]) +
                    " and " + CableName(robot, graph.cables[std::size_t(link.from)]) + " are " +
                    std::to_string(std::abs(link.to - link.from)) + " apart",
                "list the cables of neighboring segments together in cpg.order");
      return false;
    }
    link.group = index[static_cast<std::size_t>(relation)][PairIndex(
        static_cast<std::size_t>(link.to % count), static_cast<std::size_t>(link.from % count),
        static_cast<std::size_t>(count))];
  }
  return true;
}

}  // namespace

std::optional<CablePlace> PlaceInChain(const std::string& cable_name) {
  const std::size_t bar = cable_name.rfind('_');
  if (bar == std::string::npos || bar == 0 || bar + 1 == cable_name.size()) return std::nullopt;
  int number = 0;
  for (std::size_t i = bar + 1; i < cable_name.size(); ++i) {
    const char c = cable_name[i];
    if (c < '0' || c > '9' || number > 99'999) return std::nullopt;
    number = 10 * number + (c - '0');
  }
  if (number < 1) return std::nullopt;
  return CablePlace{cable_name.substr(0, bar), number};
}

}  // namespace description

std::optional<CouplingGraph> FindCouplings(const RobotSpec& robot, CpgSymmetry symmetry,
                                           const std::vector<std::string>& order,
                                           const SourceRef& at, Diagnostics& out) {
  CouplingGraph graph;
  graph.cables = description::Oscillators(robot, order, at, out);
  if (graph.cables.empty()) return std::nullopt;
  const std::vector<std::set<int>> bodies = description::BodiesOf(robot, graph.cables);
  const int count = static_cast<int>(graph.cables.size());
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      if (a == b || !description::ShareABody(bodies[std::size_t(a)], bodies[std::size_t(b)]))
        continue;
      graph.couplings.push_back({a, b, static_cast<int>(graph.couplings.size())});
    }
  }
  if (symmetry == CpgSymmetry::kNone) {
    for (const CouplingGraph::Coupling& link : graph.couplings) {
      graph.groups.push_back(description::CableName(robot, graph.cables[std::size_t(link.to)]) +
                             "." +
                             description::CableName(robot, graph.cables[std::size_t(link.from)]));
    }
    return graph;
  }
  const auto chain = description::FindChain(robot, graph.cables, at, out);
  if (!chain) return std::nullopt;
  if (symmetry == CpgSymmetry::kSegments) {
    description::GroupBySegments(*chain, graph);
  } else if (!description::GroupByIndex(robot, *chain, graph, at, out)) {
    return std::nullopt;
  }
  return graph;
}

}  // namespace taut
