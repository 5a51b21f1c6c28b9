#include "description/model/assembly.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "math/vec.h"

namespace taut::description {
namespace {

void AddTag(Tags& tags, const std::string& tag) {
  if (!tag.empty() && std::find(tags.begin(), tags.end(), tag) == tags.end()) tags.push_back(tag);
}

/// Adds the tags of copy `i` of `count` copies: its number, and first, middle or last.
void AddPositionTags(Tags& tags, int i, int count, int number) {
  if (i == 0) AddTag(tags, "first");
  if (i == count - 1) AddTag(tags, "last");
  if (i > 0 && i < count - 1) AddTag(tags, "middle");
  AddTag(tags, std::to_string(number));
}

std::string Joined(const std::vector<std::string>& names) {
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : "-") + name;
  return joined;
}

class Assembler {
 public:
  Assembler(const ModelText& model, Diagnostics& out) : model_(model), out_(out) {}

  Assembly Run() {
    assembly_.complete = model_.nodes_complete && model_.pairs_complete;
    if (!FitsLimits()) {
      assembly_.complete = false;
      return std::move(assembly_);
    }
    assembly_.instances.push_back({"", model_.at, {}, {}, {}});
    PlaceNodes(model_.loose, nullptr, 0);
    for (const PlacementText& placement : model_.structure) Place(placement);
    PlaceLoosePairs();
    DeclareTags();
    return std::move(assembly_);
  }

 private:
  const PartText* FindPart(const std::string& name) const {
    for (const PartText& part : model_.parts) {
      if (part.name == name) return &part;
    }
    return nullptr;
  }

  /// Checks the limits before any allocation, so that a huge model such as `copies: 10000` of a
  /// large part fails at once.
  bool FitsLimits() {
    const auto ends = [](const std::vector<PairText>& pairs) {
      long long count = 0;
      for (const PairText& pair : pairs) count += static_cast<long long>(pair.nodes.size());
      return count;
    };
    long long nodes = static_cast<long long>(model_.loose.nodes.size());
    long long pair_ends = ends(model_.loose.pairs);
    for (const PlacementText& placement : model_.structure) {
      const PartText* part = FindPart(placement.part.text);
      if (!part) continue;
      nodes += static_cast<long long>(part->nodes.size()) * placement.copies;
      pair_ends += (ends(part->pairs) + ends(placement.connect)) * placement.copies;
      if (nodes <= kMaxModelNodes && pair_ends <= kMaxModelEnds) continue;
      out_.Error("model.too_large", placement.at,
                 nodes > kMaxModelNodes
                     ? "the model has more than " + std::to_string(kMaxModelNodes) + " nodes"
                     : "the pairs of the model have more than " + std::to_string(kMaxModelEnds) +
                           " nodes in all",
                 "reduce the " + std::to_string(placement.copies) + " copies of this placement");
      return false;
    }
    return true;
  }

  void Place(const PlacementText& placement) {
    const PartText* part = FindPart(placement.part.text);
    if (!part) return;
    const int first_instance = static_cast<int>(assembly_.instances.size());
    Quat q = placement.rotate;
    for (int i = 0; i < placement.copies; ++i) {
      if (i > 0) q = placement.step_rotate * q;
      Instance instance;
      instance.name =
          placement.numbered ? placement.name + "_" + std::to_string(i) : placement.name;
      instance.at = placement.at;
      instance.q_WPart = q;
      instance.velocity_m_per_s = placement.velocity_m_per_s;
      instance.angular_velocity_rad_per_s = placement.angular_velocity_rad_per_s;
      if (!instance.name.empty() && !instances_.emplace(instance.name, placement.at).second) {
        out_.Error("structure.duplicate_name", placement.at,
                   "two placements in the structure have the name \"" + instance.name + "\"",
                   "give each placement a different `name:`");
        return;
      }
      assembly_.instances.push_back(std::move(instance));
      PlaceNodes(*part, &placement, i);
    }
    for (int i = 0; i < placement.copies; ++i) PlacePairs(*part, placement, first_instance, i);
    Connect(placement, first_instance);
  }

  void PlaceNodes(const PartText& part, const PlacementText* placement, int copy) {
    const int instance = static_cast<int>(assembly_.instances.size()) - 1;
    const Instance& in = assembly_.instances.back();
    const Vec3 origin =
        placement ? placement->at_m + static_cast<double>(copy) * placement->step_m : Vec3{};
    for (const NodeText& text : part.nodes) {
      PlacedNode node;
      node.name = FullName(instance, text.name);
      node.at = text.at;
      node.instance = instance;
      node.position_m = origin + Rotate(in.q_WPart, text.at_m);
      node.tags = text.tags;
      AddTag(node.tags, text.name);
      AddTag(node.tags, node.name);
      if (placement) {
        for (const std::string& tag : placement->tags) AddTag(node.tags, tag);
        if (placement->numbered) AddPositionTags(node.tags, copy, placement->copies, copy);
      }
      node_of_.emplace(node.name, static_cast<int>(assembly_.nodes.size()));
      assembly_.nodes.push_back(std::move(node));
    }
    for (const NodeText& text : part.nodes) {  // after all nodes of the copy are known
      if (text.fixed_to.text.empty()) continue;
      const auto other = node_of_.find(FullName(instance, text.fixed_to.text));
      if (other == node_of_.end()) continue;
      assembly_.nodes[node_of_.at(FullName(instance, text.name))].fixed_to = other->second;
    }
  }

  std::string FullName(int instance, const std::string& name) const {
    const std::string& of = assembly_.instances[instance].name;
    return of.empty() ? name : of + "." + name;
  }

  void PlacePairs(const PartText& part, const PlacementText& placement, int first_instance,
                  int copy) {
    const int instance = first_instance + copy;
    for (const PairText& text : part.pairs) {
      PlacedPair pair;
      pair.at = text.at;
      pair.instance = instance;
      pair.tags = text.tags;
      std::vector<std::string> names;
      for (const Placed& node : text.nodes) {
        names.push_back(node.text);
        AddNode(pair, FullName(instance, node.text));
      }
      pair.name = FullName(instance, text.name.empty() ? Joined(names) : text.name);
      AddTag(pair.tags, text.name);
      for (const std::string& tag : placement.tags) AddTag(pair.tags, tag);
      if (placement.numbered) AddPositionTags(pair.tags, copy, placement.copies, copy);
      Add(std::move(pair), text, text.nodes.size());
    }
  }

  /// Adds the `connect` pairs in the order of copies: all pairs from copy 0 to 1, then from 1 to 2,
  /// ...
  void Connect(const PlacementText& placement, int first_instance) {
    for (int i = 0; i < placement.copies; ++i) {
      for (const PairText& text : placement.connect) {
        const int span = static_cast<int>(text.nodes.size()) - 1;
        const int count = placement.ring ? placement.copies : placement.copies - span;
        if (i < count) Connect(text, placement, first_instance, i, count);
      }
    }
  }

  void Connect(const PairText& text, const PlacementText& placement, int first_instance, int i,
               int count) {
    PlacedPair pair;
    pair.at = text.at;
    pair.tags = text.tags;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < text.nodes.size(); ++k) {
      const int copy = (i + static_cast<int>(k)) % placement.copies;
      names.push_back(FullName(first_instance + copy, text.nodes[k].text));
      AddNode(pair, names.back());
    }
    pair.name = text.name.empty() ? Joined(names) : text.name + "_" + std::to_string(i + 1);
    AddTag(pair.tags, text.name);
    for (const std::string& tag : placement.tags) AddTag(pair.tags, tag);
    AddPositionTags(pair.tags, i, count, i + 1);
    Add(std::move(pair), text, text.nodes.size());
  }

  void PlaceLoosePairs() {
    for (const PairText& text : model_.loose.pairs) {
      PlacedPair pair;
      pair.at = text.at;
      pair.tags = text.tags;
      std::vector<std::string> names;
      for (const Placed& node : text.nodes) {
        names.push_back(node.text);
        if (!AddNode(pair, node.text) && model_.nodes_complete) {
          out_.Error("node.unknown", node.at, "there is no node \"" + node.text + "\"",
                     NodeHint(node.text));
          assembly_.complete = false;
        }
      }
      pair.name = text.name.empty() ? Joined(names) : text.name;
      AddTag(pair.tags, text.name);
      Add(std::move(pair), text, text.nodes.size());
    }
  }

  bool AddNode(PlacedPair& pair, const std::string& name) const {
    const auto found = node_of_.find(name);
    if (found == node_of_.end()) return false;
    pair.nodes.push_back(found->second);
    return true;
  }

  /// Adds a pair if all its nodes exist. Missing nodes are already reported.
  void Add(PlacedPair pair, const PairText& text, std::size_t node_count) {
    if (pair.nodes.size() != node_count) return;
    pair.route = text.route;
    if (pair.instance < 0) {
      pair.instance = assembly_.nodes[pair.nodes[0]].instance;
      for (const int node : pair.nodes) {
        if (assembly_.nodes[node].instance != pair.instance) pair.instance = -1;
      }
    }
    AddTag(pair.tags, pair.name);
    // Two unnamed pairs between the same nodes count as duplicates, in either direction.
    std::string key = pair.name;
    if (text.name.empty() && pair.nodes.size() == 2 && pair.nodes[0] > pair.nodes[1]) {
      key = assembly_.nodes[pair.nodes[1]].name + "-" + assembly_.nodes[pair.nodes[0]].name;
    } else if (text.name.empty()) {
      std::vector<std::string> names;
      for (const int node : pair.nodes) names.push_back(assembly_.nodes[node].name);
      key = Joined(names);
    }
    const auto [first, fresh] = pair_keys_.emplace(key, pair.at);
    const bool same_name = fresh && !pair_names_.emplace(pair.name).second;
    if (!fresh || same_name) {
      out_.Error("pair.duplicate_name", pair.at, "duplicate pair \"" + pair.name + "\"",
                 "the first is in line " + std::to_string(first->second.line) +
                     "; to keep both, give each a `name:`");
      return;
    }
    assembly_.pairs.push_back(std::move(pair));
  }

  std::string NodeHint(const std::string& name) const {
    std::vector<std::string> names;
    if (assembly_.nodes.size() > 300) return {};
    for (const PlacedNode& node : assembly_.nodes) names.push_back(node.name);
    return NameHint(name, names);
  }

  void DeclareTags() {
    const auto declare = [](std::vector<TagsInFile>& list, Tags tags, const std::string& name,
                            const Tags& more, bool copied) {
      AddTag(tags, name);
      for (const std::string& tag : more) AddTag(tags, tag);
      list.push_back({std::move(tags), copied});
    };
    for (const NodeText& node : model_.loose.nodes) {
      declare(assembly_.node_tags, node.tags, node.name, {}, false);
    }
    for (const PairText& pair : model_.loose.pairs) {
      declare(assembly_.pair_tags, pair.tags, pair.name, {}, false);
    }
    for (const PlacementText& placement : model_.structure) {
      const PartText* part = FindPart(placement.part.text);
      if (!part) continue;
      for (const NodeText& node : part->nodes) {
        declare(assembly_.node_tags, node.tags, node.name, placement.tags, placement.numbered);
      }
      for (const PairText& pair : part->pairs) {
        declare(assembly_.pair_tags, pair.tags, pair.name, placement.tags, placement.numbered);
      }
      for (const PairText& pair : placement.connect) {
        declare(assembly_.pair_tags, pair.tags, pair.name, placement.tags, true);
      }
    }
  }

  const ModelText& model_;
  Diagnostics& out_;
  Assembly assembly_;
  std::unordered_map<std::string, int> node_of_;
  std::unordered_map<std::string, SourceRef> instances_, pair_keys_;
  std::unordered_set<std::string> pair_names_;
};

}  // namespace

Assembly Assemble(const ModelText& model, Diagnostics& out) { return Assembler(model, out).Run(); }

}  // namespace taut::description
