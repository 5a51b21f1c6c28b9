#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "description/material.h"
#include "description/model_text.h"

namespace taut::description {
namespace {

bool IsFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// `tags:`, if there are any.
Tags ReadTags(const MapReader& map) {
  Tags tags = map.NamesOr("tags", {});
  if (tags.size() > static_cast<std::size_t>(kMaxTags)) {
    map.Error("tags", map.Path("tags") + ": more than " + std::to_string(kMaxTags) + " tags");
    tags.clear();
  }
  return tags;
}

/// `tip: [x, y, z]` or `tip: {at_m: [x, y, z], tags: [...], fixed_to: other}`.
NodeText ReadNode(const Entry& entry, const std::string& what, const Scope& scope) {
  NodeText node;
  node.name = entry.key;
  node.at = entry.key_at;
  if (entry.value->kind == Value::Kind::kSequence) {
    node.at_m = ReadVec3(*entry.value, what, scope);
    return node;
  }
  if (entry.value->kind != Value::Kind::kMap) {
    WrongType(*entry.value, what, "[x, y, z] or a map with at_m", scope);
    node.at_m.x = NAN;
    return node;
  }
  const MapReader map(*entry.value, what, {"at_m", "tags", "fixed_to"}, scope);
  node.at_m = map.Vector("at_m");
  node.tags = ReadTags(map);
  if (map.Has("fixed_to")) node.fixed_to = {map.Name("fixed_to"), map.Find("fixed_to")->at};
  return node;
}

/// `[a, b]`, or more nodes for a cable with via points. Adds `pair` with them to `pairs`.
void ReadPairNodes(const Value& nodes, const std::string& what, bool placed_names,
                   const Scope& scope, PairText pair, std::vector<PairText>& pairs) {
  if (nodes.kind != Value::Kind::kSequence) {
    WrongType(nodes, what, "a list of nodes", scope);
    return;
  }
  if (nodes.items.size() < 2) {
    scope.out.Error(nodes.at,
                    what + " must name 2 or more nodes, got " + std::to_string(nodes.items.size()));
    return;
  }
  for (const ValuePtr& node : nodes.items) {
    // A placed node's full name has a dot in it: segment_0.tip.
    std::string name = placed_names ? ReadText(*node, what, scope) : ReadName(*node, what, scope);
    if (name.empty()) return;
    pair.nodes.push_back({std::move(name), node->at});
  }
  pairs.push_back(std::move(pair));
}

}  // namespace

std::vector<PairText> ReadPairs(const Value* list, const std::string& what, bool placed_names,
                                const Scope& scope) {
  std::vector<PairText> pairs;
  for (const ValuePtr& item : Items(list, what, scope)) {
    const MapReader map(*item, what, {"name", "nodes", "each", "tags"}, scope);
    PairText pair;
    pair.at = item->at;
    pair.name = map.NameOr("name", "");
    pair.tags = ReadTags(map);
    const std::string key = map.ExactlyOne({"nodes", "each"});
    if (key == "nodes") {
      ReadPairNodes(*map.Find(key), map.Path(key), placed_names, scope, pair, pairs);
    } else if (key == "each") {
      if (map.Has("name")) {
        map.Error("name", map.Path("each") + " makes several pairs, which cannot share a name");
      }
      for (const ValuePtr& nodes : Items(map.Find(key), map.Path(key), scope)) {
        pair.at = nodes->at;
        ReadPairNodes(*nodes, map.Path(key), placed_names, scope, pair, pairs);
      }
    }
  }
  return pairs;
}

void ReadNodesAndPairs(const MapReader& map, PartText& part, ModelText& model) {
  const Scope& scope = map.scope();
  std::vector<std::string> names;
  const Value* nodes = map.Find("nodes");
  for (const Entry& entry : Entries(nodes, map.Path("nodes"), scope)) {
    if (ReadKey(entry, map.Path("nodes"), scope).empty()) {
      model.nodes_complete = false;
      continue;
    }
    part.nodes.push_back(ReadNode(entry, map.Path("nodes." + entry.key), scope));
    names.push_back(entry.key);
    if (!IsFinite(part.nodes.back().at_m)) model.nodes_complete = false;
  }
  if (nodes && nodes->kind == Value::Kind::kMap && nodes->entries.empty()) {
    scope.out.Error(nodes->at, map.Path("nodes") + " is empty");
    model.nodes_complete = false;
  }
  if (nodes && nodes->kind != Value::Kind::kMap) model.nodes_complete = false;

  const std::unordered_set<std::string> known(names.begin(), names.end());
  for (const NodeText& node : part.nodes) {
    if (node.fixed_to.text.empty()) continue;
    if (node.fixed_to.text == node.name) {
      scope.out.Error(node.fixed_to.at, "the node \"" + node.name + "\" is fixed to itself");
    } else if (known.count(node.fixed_to.text) == 0) {
      scope.out.Error(node.fixed_to.at,
                      "there is no node \"" + node.fixed_to.text + "\" in this part",
                      NameHint(node.fixed_to.text, names));
    }
  }
  const std::size_t errors_before = scope.out.items().size();
  const bool loose = &part == &model.loose;  // its pairs may join placed nodes, known later
  part.pairs = ReadPairs(map.Find("pairs"), map.Path("pairs"), loose, scope);
  for (const PairText& pair : part.pairs) {
    for (std::size_t i = 1; i < pair.nodes.size(); ++i) {
      if (pair.nodes[i].text != pair.nodes[i - 1].text) continue;
      scope.out.Error(pair.nodes[i].at, "a pair from \"" + pair.nodes[i].text + "\" to itself");
    }
  }
  for (const PairText& pair : part.pairs) {
    for (const Placed& node : pair.nodes) {
      if (loose || known.count(node.text) > 0 || !model.nodes_complete) continue;
      scope.out.Error(node.at,
                      "there is no node \"" + node.text + "\" in part \"" + part.name + "\"",
                      NameHint(node.text, names));
    }
  }
  if (scope.out.items().size() != errors_before) model.pairs_complete = false;
}

std::vector<PlacementText> ReadStructure(const Value* list, ModelText& model, const Scope& scope) {
  std::vector<PlacementText> structure;
  if (list && list->kind != Value::Kind::kSequence) model.nodes_complete = false;
  std::vector<std::string> part_names;
  for (const PartText& part : model.parts) part_names.push_back(part.name);

  for (const ValuePtr& item : Items(list, "structure", scope)) {
    const std::string what = "structure";
    const MapReader map(
        *item, what,
        {"part", "name", "copies", "at_m", "rotate", "step_m", "step_rotate", "tags", "connect",
         "ring", "velocity_m_per_s", "angular_velocity_rad_per_s"},
        scope);
    if (!map.is_map()) {
      model.nodes_complete = false;
      continue;
    }
    PlacementText placement;
    placement.at = item->at;
    placement.part = {map.Text("part"), map.Has("part") ? map.Find("part")->at : item->at};
    placement.name = map.NameOr("name", placement.part.text);
    if (const Value* copies = map.Find("copies")) {
      const auto count = ReadInteger(*copies, map.Path("copies"), 1, kMaxCopies, scope);
      model.nodes_complete = model.nodes_complete && count.has_value();
      placement.copies = count.value_or(1);
      placement.numbered = true;
    }
    placement.at_m = map.VectorOr("at_m", {});
    placement.step_m = map.VectorOr("step_m", {});
    if (const Value* rotate = map.Find("rotate")) {
      placement.rotate = ReadRotation(*rotate, map.Path("rotate"), scope);
    }
    if (const Value* rotate = map.Find("step_rotate")) {
      placement.step_rotate = ReadRotation(*rotate, map.Path("step_rotate"), scope);
    }
    placement.tags = ReadTags(map);
    placement.velocity_m_per_s = map.VectorOr("velocity_m_per_s", {});
    placement.angular_velocity_rad_per_s = map.VectorOr("angular_velocity_rad_per_s", {});
    const std::size_t errors_before = scope.out.items().size();
    placement.connect = ReadPairs(map.Find("connect"), map.Path("connect"), false, scope);
    placement.ring = map.BoolOr("ring", false);
    for (const char* key : {"step_m", "step_rotate", "connect", "ring"}) {
      if (map.Has(key) && !placement.numbered) {
        map.Error(key, map.Path(key) + " needs copies",
                  "write `copies: 2`, or as many as you want");
      }
    }

    const auto part = std::find_if(model.parts.begin(), model.parts.end(), [&](const PartText& p) {
      return p.name == placement.part.text;
    });
    if (part == model.parts.end()) {
      model.nodes_complete = false;
      if (!map.Has("part")) continue;
      scope.out.Error(placement.part.at, "there is no part \"" + placement.part.text + "\"",
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
        scope.out.Error(node.at,
                        "there is no node \"" + node.text + "\" in part \"" + part->name + "\"",
                        NameHint(node.text, node_names));
      }
    }
    if (scope.out.items().size() != errors_before) model.pairs_complete = false;
    structure.push_back(std::move(placement));
  }
  return structure;
}

}  // namespace taut::description
