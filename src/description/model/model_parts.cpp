// Reader of nodes, pairs, routes, parts and placements.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "description/model/model_keys.h"

namespace taut::description {
namespace {

bool IsFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void CheckTags(const MapReader& map, Tags& tags) {
  if (tags.size() <= static_cast<std::size_t>(kMaxTags)) return;
  map.Error("tags.too_many", "tags",
            map.Path("tags") + " has more than " + std::to_string(kMaxTags) + " tags");
  tags.clear();
}

/// Reads the nodes of a pair: `[a, b]`, or more for a cable with via points. Appends `pair` with
/// these nodes to `pairs`.
void ReadPairNodes(const Value& nodes, const std::string& what, bool placed_names,
                   const Scope& scope, PairText pair, std::vector<PairText>& pairs) {
  if (nodes.kind != Value::Kind::kSequence) {
    WrongType(nodes, what, "a list of nodes", scope);
    return;
  }
  if (nodes.items.size() < 2) {
    scope.out.Error("pair.few_nodes", nodes.at,
                    what + " must name 2 or more nodes, got " + std::to_string(nodes.items.size()));
    return;
  }
  for (const ValuePtr& node : nodes.items) {
    // Full names of placed nodes contain a dot: segment_0.tip.
    std::string name = placed_names ? ReadText(*node, what, scope) : ReadName(*node, what, scope);
    if (name.empty()) return;
    pair.nodes.push_back({std::move(name), node->at});
  }
  pairs.push_back(std::move(pair));
}

/// Converts the entries of a list to pairs. `placed_names`: whether full names such as
/// segment_0.tip are permitted.
std::vector<PairText> ToPairs(const MapReader& map, std::string_view key,
                              const std::vector<PairsText>& entries, bool placed_names) {
  const Scope& scope = map.scope();
  const std::string what = map.Path(key);
  std::vector<PairText> pairs;
  for (const PairsText& entry : entries) {
    PairText pair{entry.name, entry.at, {}, entry.tags};
    if (map.Has(key) &&
        (entry.nodes.value != nullptr) + (entry.each.value != nullptr) + (!entry.route.empty()) !=
            1) {
      continue;
    }
    if (!entry.route.empty()) {
      pair.route = entry.route;
      for (const RouteText& element : entry.route) pair.nodes.push_back(element.node());
      const auto nameless = [](const Placed& node) { return node.text.empty(); };
      const bool whole = std::none_of(pair.nodes.begin(), pair.nodes.end(), nameless);
      if (whole && pair.nodes.size() > 1) pairs.push_back(pair);
    }
    if (entry.nodes.value) {
      ReadPairNodes(*entry.nodes.value, what + ".nodes", placed_names, scope, pair, pairs);
    }
    for (const ValuePtr& nodes : Items(entry.each.value, what + ".each", scope)) {
      pair.at = nodes->at;
      ReadPairNodes(*nodes, what + ".each", placed_names, scope, pair, pairs);
    }
  }
  return pairs;
}

/// Returns false if the key is present and its value is not a list.
bool IsListOrAbsent(const MapReader& map, std::string_view key) {
  const Value* value = map.Find(key);
  return !value || value->kind == Value::Kind::kSequence;
}

bool AllGood(const std::vector<PairsText>& entries) {
  return std::all_of(entries.begin(), entries.end(), [](const PairsText& p) { return p.good; });
}

/// Checks that drums are at the ends of a route, and pulleys and friction between the ends.
void CheckRoute(const MapReader& map, const PairsText& pairs) {
  const Scope& scope = map.scope();
  const Value* const value = map.Find("route");
  if (value == nullptr || value->kind != Value::Kind::kSequence) return;
  const std::string what = map.Path("route");
  const std::vector<RouteText>& route = pairs.route;
  if (value->items.size() < 2) {
    map.Error("route.few_nodes", "route",
              what + " must name 2 or more nodes, got " + std::to_string(value->items.size()));
  }
  for (std::size_t i = 0; i < route.size(); ++i) {
    const bool end = i == 0 || i + 1 == route.size();
    if (end && route[i].is_pulley()) {
      scope.out.Error("route.ends_at_pulley", route[i].at, what + " ends at a pulley",
                      "end the cable at a node or on a drum");
    } else if (end && !route[i].is_drum() && route[i].friction > 0) {
      scope.out.Error("route.friction_at_end", route[i].at,
                      what + " has friction at an end, where the cable is fixed",
                      "leave out `friction` there");
    } else if (!end && route[i].is_drum()) {
      scope.out.Error("route.drum_inside", route[i].at, what + " has a drum between its ends",
                      "use a `pulley` there: drums are allowed only at the ends of a cable");
    }
  }
}

}  // namespace

void Check(const MapReader& map, NodeText& node) { CheckTags(map, node.tags); }

bool ReadShort(const Value& value, const std::string& path, const Scope& scope, NodeText& out) {
  if (value.kind == Value::Kind::kMap) return false;
  if (value.kind == Value::Kind::kSequence) {
    Scope metres = scope;  // the path ends with the node's name, without a unit
    metres.unit = "m";
    out.at_m = ReadVec3(value, path, metres);
  } else {
    WrongType(value, path, "[x, y, z] or a map with at_m", scope);
    out.at_m.x = NAN;
  }
  return true;
}

bool ReadShort(const Value& value, const std::string& path, const Scope& scope, RouteText& out) {
  out.at = value.at;
  if (value.kind == Value::Kind::kMap) return false;
  out.eyelet = {ReadText(value, path, scope), value.at};
  return true;
}

void Check(const MapReader& map, RouteText& element) {
  element.at = map.at();
  const bool round = element.is_pulley() || element.is_drum();
  const char* const what = element.is_drum() ? "a drum" : "a pulley";
  for (const char* key : {"axis", "radius_m", "side"}) {
    if (round && !map.Has(key))
      map.Error("route.key_missing", key, what + std::string(" needs ") + map.Path(key));
  }
  for (const char* key : {"axis", "radius_m", "side", "turns"}) {
    if (round || !map.Has(key)) continue;
    map.Error("route.key_of_wheels", key,
              map.Path(key) + " is a key of pulleys and drums, not of eyelets");
  }
  const double turns = element.turns;
  if (element.is_pulley() && turns != std::floor(turns) && !std::isnan(turns)) {
    map.Error("route.turns_not_whole", "turns",
              map.Path("turns") + " of a pulley must be a whole number",
              "give whole turns only: the shortest way around is added to them");
  }
}

void Check(const MapReader& map, PairsText& pairs) {
  CheckTags(map, pairs.tags);
  CheckRoute(map, pairs);
  if (map.Has("each") && !map.Has("nodes") && map.Has("name")) {
    map.Error("pair.name_shared", "name",
              map.Path("each") + " makes several pairs, which cannot share a name");
  }
}

void Check(const MapReader& map, PartText& part) {
  FinishNodesAndPairs(map, false, part);
  part.nodes_complete = part.nodes_complete && map.Has("nodes");
}

void FinishNodesAndPairs(const MapReader& map, bool loose, PartText& part) {
  const Scope& scope = map.scope();
  const Value* nodes = map.Find("nodes");
  std::vector<std::string> names;
  for (auto& item : part.nodes_text.items) {
    if (!item.good_name) part.nodes_complete = false;
    if (!item.good_name) continue;
    item.value.at = item.name_at;
    names.push_back(item.name);
    if (!IsFinite(item.value.at_m)) part.nodes_complete = false;
    part.nodes.push_back(std::move(item.value));
  }
  if (nodes && nodes->kind != Value::Kind::kMap) part.nodes_complete = false;
  if (nodes && nodes->kind == Value::Kind::kMap && nodes->entries.empty()) {
    scope.out.Error("pair.no_nodes", nodes->at, map.Path("nodes") + " is empty");
    part.nodes_complete = false;
  }

  const std::unordered_set<std::string> known(names.begin(), names.end());
  for (const NodeText& node : part.nodes) {
    if (node.fixed_to.text.empty()) continue;
    if (node.fixed_to.text == node.name) {
      scope.out.Error("node.fixed_to_itself", node.fixed_to.at,
                      "the node \"" + node.name + "\" is fixed to itself");
    } else if (known.count(node.fixed_to.text) == 0) {
      scope.out.Error("node.unknown", node.fixed_to.at,
                      "there is no node \"" + node.fixed_to.text + "\" in this part",
                      NameHint(node.fixed_to.text, names));
    }
  }
  const std::size_t errors_before = scope.out.items().size();
  part.pairs = ToPairs(map, "pairs", part.pairs_text, loose);
  for (const PairText& pair : part.pairs) {
    for (std::size_t i = 1; i < pair.nodes.size(); ++i) {
      if (pair.nodes[i].text != pair.nodes[i - 1].text) continue;
      scope.out.Error("pair.same_node_twice", pair.nodes[i].at,
                      "a pair connects \"" + pair.nodes[i].text + "\" to itself");
    }
  }
  for (const PairText& pair : part.pairs) {
    for (const Placed& node : pair.nodes) {
      // Pairs at the top level of the file (`loose`) may use nodes of placements, known only later.
      if (loose || known.count(node.text) > 0 || !part.nodes_complete) continue;
      scope.out.Error("node.unknown", node.at,
                      "there is no node \"" + node.text + "\" in part \"" + part.name + "\"",
                      NameHint(node.text, names));
    }
  }
  part.pairs_complete = scope.out.items().size() == errors_before && AllGood(part.pairs_text) &&
                        IsListOrAbsent(map, "pairs");
}

void Check(const MapReader& map, PlacementText& placement) {
  CheckTags(map, placement.tags);
  placement.numbered = map.Has("copies");
  const Value* const copies = map.Find("copies");
  Diagnostics reported;
  placement.copies_known =
      !copies || ReadInteger(*copies, "copies", 1, kMaxCopies, {map.scope().names, reported});
  placement.nodes_complete = map.is_map() && map.Has("part") && placement.copies_known;
  if (!map.Has("part")) placement.part.at = map.at();
  if (!map.Has("name")) placement.name = placement.part.text;
  const std::size_t errors_before = map.scope().out.items().size();
  placement.connect = ToPairs(map, "connect", placement.connect_text, false);
  for (const char* key : {"step_m", "step_rotate", "connect", "ring"}) {
    if (map.Has(key) && !placement.numbered) {
      map.Error("structure.key_needs_copies", key, map.Path(key) + " needs `copies`",
                "write `copies: 2` or more");
    }
  }
  placement.pairs_complete = map.scope().out.items().size() == errors_before &&
                             AllGood(placement.connect_text) && IsListOrAbsent(map, "connect");
}

void FinishStructure(const MapReader& map, ModelText& model) {
  const Scope& scope = map.scope();
  if (!IsListOrAbsent(map, "structure")) model.nodes_complete = false;
  std::vector<std::string> part_names;
  for (const PartText& part : model.parts) part_names.push_back(part.name);

  std::vector<PlacementText> placed;
  for (PlacementText& placement : model.structure) {
    model.nodes_complete = model.nodes_complete && placement.nodes_complete;
    model.pairs_complete = model.pairs_complete && placement.pairs_complete;
    const auto part = std::find_if(model.parts.begin(), model.parts.end(), [&](const PartText& p) {
      return p.name == placement.part.text;
    });
    if (part == model.parts.end()) {
      model.nodes_complete = false;
      if (placement.part.text.empty()) continue;
      scope.out.Error("part.unknown", placement.part.at,
                      "there is no part \"" + placement.part.text + "\"",
                      NameHint(placement.part.text, part_names));
      continue;
    }
    std::vector<std::string> node_names;
    for (const NodeText& node : part->nodes) node_names.push_back(node.name);
    const std::unordered_set<std::string> known(node_names.begin(), node_names.end());
    for (const PairText& pair : placement.connect) {
      for (const Placed& node : pair.nodes) {
        if (!model.nodes_complete) break;
        if (known.count(node.text) > 0) continue;
        scope.out.Error("node.unknown", node.at,
                        "there is no node \"" + node.text + "\" in part \"" + part->name + "\"",
                        NameHint(node.text, node_names));
        model.pairs_complete = false;
      }
    }
    // With an unknown number of copies, later checks would report errors that do not exist.
    if (placement.copies_known) placed.push_back(std::move(placement));
  }
  model.structure = std::move(placed);
}

}  // namespace taut::description
