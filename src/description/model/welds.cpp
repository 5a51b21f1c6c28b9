#include "description/model/welds.h"

#include "base/union_find.h"

namespace taut::description {
namespace {

/// Union-find over all nodes, then all pairs.
class WeldFinder {
 public:
  WeldFinder(const ModelText& model, const Assembly& assembly, const Assignment& assignment)
      : model_(model),
        assembly_(assembly),
        assignment_(assignment),
        sets_(assembly.nodes.size() + assembly.pairs.size()) {}

  Welds Run() {
    JoinStiff();
    JoinTurning();
    Collect();
    return std::move(out_);
  }

 private:
  const BuilderText* Builder(std::size_t pair) const {
    const int b = assignment_.of_pair[pair];
    return b < 0 ? nullptr : &model_.builders[b];
  }
  bool IsSolid(std::size_t pair) const {
    return Builder(pair) && description::IsSolid(*Builder(pair));
  }
  bool TurnsInNodes(std::size_t pair) const {
    return IsSolid(pair) && Builder(pair)->rod && Builder(pair)->rod->class_k;
  }
  int Element(std::size_t pair) const { return static_cast<int>(assembly_.nodes.size() + pair); }

  void JoinStiff() {
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      if (!IsSolid(pair) || TurnsInNodes(pair)) continue;
      for (const int node : assembly_.pairs[pair].nodes) sets_.Join(Element(pair), node);
    }
    for (std::size_t node = 0; node < assembly_.nodes.size(); ++node) {
      const int other = assembly_.nodes[node].fixed_to;
      if (other >= 0) sets_.Join(static_cast<int>(node), other);
    }
  }

  /// Assigns the nodes of class-k rods to bodies. A node of another solid or an anchor stays with
  /// this solid or anchor. Otherwise the node joins the body of its first class-k rod. All other
  /// rods are pinned to the node.
  void JoinTurning() {
    std::vector<bool> taken(assembly_.nodes.size() + assembly_.pairs.size(), false);  // per root of
                                                                                      // a set
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      if (IsSolid(pair) && !TurnsInNodes(pair)) taken[sets_.Root(Element(pair))] = true;
    }
    for (std::size_t node = 0; node < assembly_.nodes.size(); ++node) {
      for (const int b : assignment_.of_node[node]) {
        if (model_.builders[b].anchor) taken[sets_.Root(static_cast<int>(node))] = true;
      }
    }
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      if (!TurnsInNodes(pair)) continue;
      for (const int node : assembly_.pairs[pair].nodes) {
        if (sets_.Root(node) == sets_.Root(Element(pair))) continue;
        if (taken[sets_.Root(node)]) {
          out_.pins.push_back({static_cast<int>(pair), node});
        } else {
          sets_.Join(node, Element(pair));
          taken[sets_.Root(node)] = true;
        }
      }
    }
  }

  void Collect() {
    std::vector<int> weld_of_root(assembly_.nodes.size() + assembly_.pairs.size(), -1);
    const auto weld_of = [&](int element) -> Weld& {
      int& weld = weld_of_root[sets_.Root(element)];
      if (weld < 0) {
        weld = static_cast<int>(out_.welds.size());
        out_.welds.emplace_back();
      }
      return out_.welds[weld];
    };
    for (int node = 0; node < static_cast<int>(assembly_.nodes.size()); ++node) {
      Weld& weld = weld_of(node);
      weld.nodes.push_back(node);
      for (const int b : assignment_.of_node[node]) {
        const BuilderText& builder = model_.builders[b];
        weld.anchored = weld.anchored || builder.anchor.has_value();
        weld.has_solid = weld.has_solid || !(builder.anchor || builder.support);
      }
    }
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      if (!IsSolid(pair) || assembly_.pairs[pair].nodes.size() != 2) continue;
      Weld& weld = weld_of(Element(pair));
      weld.pairs.push_back(static_cast<int>(pair));
      weld.has_solid = true;
    }
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      if (!Builder(pair) || !Builder(pair)->bar) continue;
      for (const int node : assembly_.pairs[pair].nodes) weld_of(node).ends_bar = true;
    }
    // Half the mass of a member at a node that is only an anchor belongs to the world.
    for (Weld& weld : out_.welds) {
      for (const int node : weld.nodes) {
        const double lump_kg = assignment_.lump_kg[static_cast<std::size_t>(node)];
        weld.has_solid = weld.has_solid || (lump_kg != 0 && !weld.anchored);
      }
    }
  }

  const ModelText& model_;
  const Assembly& assembly_;
  const Assignment& assignment_;
  base::UnionFind sets_;
  Welds out_;
};

}  // namespace

bool IsSolid(const BuilderText& builder) {
  return !builder.cable && !builder.bar && !builder.joint;
}

Welds FindWelds(const ModelText& model, const Assembly& assembly, const Assignment& assignment) {
  return WeldFinder(model, assembly, assignment).Run();
}

}  // namespace taut::description
