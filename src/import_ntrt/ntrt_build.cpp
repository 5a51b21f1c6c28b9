// Construction of a structure by the rules of NTRT (tgStructureInfo, tgConnectorInfo, tgRodInfo,
// tgBoxInfo and tgSphereInfo at f0c52e93).
#include "import_ntrt/ntrt_build.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/union_find.h"
#include "import_ntrt/turn.h"
#include "math/angle.h"

namespace taut::import_ntrt {
namespace {

class Maker {
 public:
  Maker(Model& model, Diagnostics& out) : model_(model), out_(out) {}

  Built Run() {
    FindSamePlaces();
    BuildSolids(0);
    Weld();
    for (std::size_t i = 0; i < connectors_.size(); ++i) AddCable(connectors_[i]);
    Count();
    return std::move(built_);
  }

 private:
  const Node& NodeOf(int i) const { return model_.nodes[static_cast<std::size_t>(i)]; }
  const Pair& PairOf(int i) const { return model_.pairs[static_cast<std::size_t>(i)]; }
  const Builder& BuilderOf(int i) const { return model_.builders[static_cast<std::size_t>(i)]; }
  const Structure& StructureOf(int i) const {
    return model_.structures[static_cast<std::size_t>(i)];
  }
  int Same(int node) const { return built_.same[static_cast<std::size_t>(node)]; }

  void FindSamePlaces() {
    const std::size_t count = model_.nodes.size();
    std::vector<int> by_x(count);
    std::iota(by_x.begin(), by_x.end(), 0);
    std::sort(by_x.begin(), by_x.end(),
              [&](int a, int b) { return NodeOf(a).place.x < NodeOf(b).place.x; });
    base::UnionFind sets(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) {
        const Vec3 &a = NodeOf(by_x[i]).place, &b = NodeOf(by_x[j]).place;
        if (b.x - a.x > 1e-7) break;
        if (SamePlace(a, b)) sets.Join(by_x[i], by_x[j]);
      }
    }
    for (std::size_t i = 0; i < count; ++i) built_.same.push_back(sets.Root(static_cast<int>(i)));
  }

  /// Returns the last builder of a kind whose search matches. Tags of the structure count as tags
  /// of the item.
  template <class Kind>
  int FindBuilder(const Words& tags, int structure, const Kind& is_kind) const {
    for (int b = static_cast<int>(model_.builders.size()) - 1; b >= 0; --b) {
      if (!is_kind(BuilderOf(b).kind)) continue;
      const Words& search = BuilderOf(b).search;
      const Words& own = StructureOf(structure).tags;
      if (!model_.MayCompare(search, own) || !model_.MayCompare(tags, search)) return -1;
      if (HasAll(tags, Without(search, own))) return b;
    }
    return -1;
  }

  void BuildSolids(int structure) {
    for (const int node : StructureOf(structure).nodes) {
      const int b = FindBuilder(NodeOf(node).tags, structure,
                                [](Class kind) { return kind == Class::kSphere; });
      if (b >= 0) AddSolid({b, -1, node, Same(node), Same(node)});
    }
    for (const int i : StructureOf(structure).pairs) {
      const Pair& pair = PairOf(i);
      if (pair.removed) continue;
      ++model_.counts.pairs;
      const std::pair<int, int> ends = std::minmax(Same(pair.from), Same(pair.to));
      if (!joined_.emplace(structure, ends).second) {
        ++model_.counts.duplicate_pairs;
        out_.Warning("ntrt.duplicate_pair", pair.at,
                     "another pair already joins these two nodes; both are built, as in NTRT",
                     "leave out one of them");
      }
      const int solid = FindBuilder(pair.tags, structure, [](Class kind) {
        return kind == Class::kRod || kind == Class::kBox;
      });
      if (solid >= 0) {
        AddSolid({solid, i, -1, Same(pair.from), Same(pair.to)});
        continue;
      }
      const int cable =
          FindBuilder(pair.tags, structure, [](Class kind) { return !IsSolid(kind); });
      if (cable >= 0) {
        connectors_.push_back({cable, i});
        continue;
      }
      if (model_.ComparedTooMuch()) return;
      ++model_.counts.ignored_pairs;
      std::string tags;
      for (const std::string& tag : pair.tags) tags += (tags.empty() ? "" : " ") + tag;
      out_.Warning("ntrt.pair_left_out", pair.at,
                   "no builder has the tag \"" + tags + "\", so the pair is left out, as in NTRT",
                   "the tags rod, string, box and sphere have default builders");
    }
    for (const int child : StructureOf(structure).children) BuildSolids(child);
  }

  void AddSolid(Solid solid) {
    const Parameters& is = BuilderOf(solid.builder).is;
    const Class kind = BuilderOf(solid.builder).kind;
    const double length = Length(NodeOf(solid.to).place - NodeOf(solid.from).place);
    if (kind == Class::kSphere) {
      solid.mass_kg = is.density * 4.0 / 3.0 * kPi * is.radius * is.radius * is.radius;
    } else {
      if (!(length > 0.0)) {
        out_.Error("ntrt.no_length", PairOf(solid.pair).at,
                   "both ends of a rod or box are at the same place");
        return;
      }
      solid.mass_kg =
          is.density * length *
          (kind == Class::kRod ? kPi * is.radius * is.radius : 4 * is.width * is.height);
    }
    built_.solids.push_back(solid);
  }

  void Weld() {
    base::UnionFind sets(model_.nodes.size());
    for (const Solid& solid : built_.solids) sets.Join(solid.from, solid.to);
    std::vector<int> body(model_.nodes.size(), -1);
    at_node_.resize(model_.nodes.size());
    for (std::size_t i = 0; i < built_.solids.size(); ++i) {
      Solid& solid = built_.solids[i];
      int& index = body[static_cast<std::size_t>(sets.Root(solid.from))];
      if (index < 0) {
        index = static_cast<int>(built_.mass_kg.size());
        built_.mass_kg.push_back(0.0);
        built_.bodies_solids.push_back(0);
      }
      solid.body = index;
      built_.mass_kg[static_cast<std::size_t>(index)] += solid.mass_kg;
      ++built_.bodies_solids[static_cast<std::size_t>(index)];
      at_node_[static_cast<std::size_t>(solid.from)].push_back(static_cast<int>(i));
      if (solid.to == solid.from) continue;
      at_node_[static_cast<std::size_t>(solid.to)].push_back(static_cast<int>(i));
    }
  }

  /// Returns the solid at a node whose center is nearest. If several are equally near, NTRT uses
  /// the first in its heap, taut the first in the file.
  const Solid* ChooseSolid(int node) {
    const Solid* chosen = nullptr;
    double nearest = INFINITY;
    bool tied = false;
    for (const int i : at_node_[static_cast<std::size_t>(node)]) {
      const Solid& solid = built_.solids[static_cast<std::size_t>(i)];
      const Vec3 centre = 0.5 * (NodeOf(solid.from).place + NodeOf(solid.to).place);
      const double distance = Length(centre - NodeOf(node).place);
      const double same = 1e-9 * (1.0 + distance);
      if (distance < nearest - same) {
        chosen = &solid;
        tied = false;
        nearest = distance;
      } else {
        tied = tied || distance < nearest + same;
      }
    }
    if (tied) {
      ++model_.counts.ends_with_tied_choice;
      out_.Warning("ntrt.several_rods", NodeOf(node).at,
                   "a cable ends where several rods are equally near: NTRT attaches it to one of "
                   "them by chance, the import to the first",
                   "attach the cable to another node");
    }
    return chosen;
  }

  /// Returns the point on the surface of a rod or box, in the direction of `other`. Boxes count as
  /// round, with `width` as radius.
  Vec3 PointOnBeam(const Solid& solid, double radius, double rotation, const Vec3& at,
                   const Vec3& other, bool& special) const {
    const Vec3 axis = Unit(NodeOf(solid.to).place - NodeOf(solid.from).place);
    Vec3 out = (other - at) - Dot(axis, other - at) * axis;
    if (Length(out) < 1e-9 * Length(other - at)) {
      special = true;
      out = Cross(axis, Vec3{axis.y - axis.z, -axis.x, axis.x});
      if (!(Length(out) > 1e-9)) out = {1, 0, 0};  // NTRT divides by zero here
    }
    if (rotation != 0.0) out = Rotate(About(axis, rotation), out);
    return at + radius * Unit(out);
  }

  CableEnd MakeEnd(const Builder& builder, bool moves, int node, int other) {
    CableEnd end;
    end.node = Same(node);
    const Vec3 at = NodeOf(node).place, towards = NodeOf(other).place;
    end.point = at;
    const Solid* const solid = ChooseSolid(end.node);
    if (!solid) {
      out_.Error(
          "ntrt.no_solid_at_end", NodeOf(node).at,
          "a cable ends at the node \"" + NodeOf(node).tags[0] + "\", where there is no solid",
          "attach it to a solid; NTRT ends with an error at such a cable, too");
      return end;
    }
    end.body = solid->body;
    if (!moves) return end;
    const Builder& of_solid = BuilderOf(solid->builder);
    end.kind = End::kSurface;
    if (of_solid.kind == Class::kSphere) {
      end.point = at + of_solid.is.radius * Unit(towards - at);
      return end;
    }
    const bool box = of_solid.kind == Class::kBox;
    bool special = box || builder.is.rotation != 0.0;
    end.point = PointOnBeam(*solid, box ? of_solid.is.width : of_solid.is.radius,
                            builder.is.rotation, at, towards, special);
    if (special) end.kind = End::kPoint;
    return end;
  }

  struct Connector {
    int builder = 0, pair = 0;
  };

  void AddCable(const Connector& connector) {
    const Pair& pair = PairOf(connector.pair);
    const Builder& builder = BuilderOf(connector.builder);
    if (SamePlace(NodeOf(pair.from).place, NodeOf(pair.to).place)) {
      out_.Error("ntrt.cable_without_length", pair.at,
                 "both ends of a cable are at the same place");
      return;
    }
    Cable cable{connector.builder, connector.pair, {}, {}, 0.0};
    cable.from = MakeEnd(builder, builder.is.move_from_to_edge, pair.from, pair.to);
    cable.to = MakeEnd(builder, builder.is.move_to_to_edge, pair.to, pair.from);
    if (out_.ok() && cable.from.body == cable.to.body) {
      out_.Warning(
          "ntrt.cable_on_one_body", pair.at,
          "both ends of the cable are on the same body, so it has no effect and is left out",
          "remove the pair");
      return;
    }
    cable.rest_length =
        Length(cable.to.point - cable.from.point) - builder.is.pretension / builder.is.stiffness;
    if (!(cable.rest_length > 0.0)) {
      ++model_.counts.cables_without_rest_length;
      out_.Warning(
          "ntrt.pretension_too_high", pair.at,
          "the pretension of this cable requires a negative rest length; NTRT ends with an "
          "error at such a cable",
          "reduce the pretension, in this file or in the imported model");
    }
    built_.cables.push_back(cable);
  }

  void Count() {
    NtrtCounts& counts = model_.counts;
    counts.nodes = static_cast<int>(model_.nodes.size());
    for (const Solid& solid : built_.solids) {
      const Class kind = BuilderOf(solid.builder).kind;
      ++(kind == Class::kRod ? counts.rods : kind == Class::kBox ? counts.boxes : counts.spheres);
    }
    counts.bodies = static_cast<int>(built_.mass_kg.size());
    counts.cables = static_cast<int>(built_.cables.size());
    counts.mass_kg = std::accumulate(built_.mass_kg.begin(), built_.mass_kg.end(), 0.0);
  }

  Model& model_;
  Diagnostics& out_;
  Built built_;
  std::vector<Connector> connectors_;
  std::vector<std::vector<int>> at_node_;  ///< Indices of the solids at each node.
  std::set<std::pair<int, std::pair<int, int>>> joined_;
};

}  // namespace

Built BuildStructure(Model& model, Diagnostics& out) { return Maker(model, out).Run(); }

}  // namespace taut::import_ntrt
