// Reader of `bond_groups:`: pairs between substructures, and substructures attached to each other.
#include <cmath>
#include <utility>

#include "description/yaml/yaml_tree.h"
#include "import_ntrt/read.h"
#include "import_ntrt/turn.h"

namespace taut::import_ntrt {
namespace {

/// Bond that attaches a node of one structure to the middle of an edge (a cable) of the other.
struct NodeOnEdge {
  int node = -1;
  int edge_from = -1, edge_to = -1;
  Vec3 in_first, in_second;  ///< Coincident points in both structures: the node and the middle of
                             ///< the edge.
  SourceRef at;
};

Vec3 MiddleOf(const Reading& in, int a, int b) {
  return 0.5 * (in.node(a).place + in.node(b).place);
}

/// Reads one side of a bond `[top1, bottom1/bottom2]`. Returns its point; nothing after an error.
std::optional<Vec3> ReadHalf(const Reading& in, int structure, const std::string& text,
                             NodeOnEdge& bond) {
  const std::vector<std::string> names = AtSlashes(text);
  if (names.size() == 1) {
    bond.node = NodeAt(in, structure, text, bond.at);
    return bond.node < 0 ? std::nullopt : std::optional(in.node(bond.node).place);
  }
  bond.edge_from = NodeAt(in, structure, names[0], bond.at);
  bond.edge_to = NodeAt(in, structure, names[1], bond.at);
  if (bond.edge_from < 0 || bond.edge_to < 0) return std::nullopt;
  return MiddleOf(in, bond.edge_from, bond.edge_to);
}

std::optional<NodeOnEdge> ReadNodeOnEdge(const Reading& in, int first, int second,
                                         const Value& line) {
  NodeOnEdge bond;
  bond.at = line.at;
  std::string a, b;
  if (!ReadTwo(line, a, b, in.out)) return std::nullopt;
  const std::size_t edges = AtSlashes(a).size() * AtSlashes(b).size();
  if (edges != 2) {
    in.out.Error("ntrt.bond_of_node_and_edge", line.at,
                 "a node_edge bond must join a node and an edge",
                 "such as [top1, bottom1/bottom2]");
    return std::nullopt;
  }
  const auto in_first = ReadHalf(in, first, a, bond);
  const auto in_second = ReadHalf(in, second, b, bond);
  if (!in_first || !in_second) return std::nullopt;
  bond.in_first = *in_first;
  bond.in_second = *in_second;
  return bond;
}

/// Rotates and shifts structure `second` to match the bonds' points in the first structure. The
/// planes through the first three points become parallel, the centers coincide, and the first
/// points have the same direction from the center.
void Fit(const Reading& in, int second, const std::vector<NodeOnEdge>& bonds) {
  Vec3 centre_1, centre_2;
  for (const NodeOnEdge& bond : bonds) {
    centre_1 = centre_1 + bond.in_first;
    centre_2 = centre_2 + bond.in_second;
  }
  centre_1 = (1.0 / static_cast<double>(bonds.size())) * centre_1;
  centre_2 = (1.0 / static_cast<double>(bonds.size())) * centre_2;
  const Vec3 normal_1 =
      Cross(bonds[1].in_first - bonds[0].in_first, bonds[2].in_first - bonds[0].in_first);
  const Vec3 normal_2 =
      Cross(bonds[1].in_second - bonds[0].in_second, bonds[2].in_second - bonds[0].in_second);
  if (!(Length(normal_1) > 0.0) || !(Length(normal_2) > 0.0)) {
    in.out.Error("ntrt.bonds_in_line", bonds[0].at, "the first three node_edge bonds lie on a line",
                 "they must span a plane in both structures");
    return;
  }
  const Quat to_plane = Between(normal_2, normal_1, bonds[1].in_second - bonds[0].in_second);
  in.model.Turn(second, centre_2, to_plane);
  in.model.Shift(second, centre_1 - centre_2);
  const Vec3 first_2 = Rotate(to_plane, bonds[0].in_second - centre_2);
  const Vec3 first_1 = bonds[0].in_first - centre_1;
  if (!(Length(first_1) > 0.0) || !(Length(first_2) > 0.0)) {
    in.out.Error("ntrt.bond_in_center", bonds[0].at,
                 "the first node_edge bond lies at the center of all bonds",
                 "begin with another bond: the direction from the center to the first bond sets "
                 "the rotation of the structure");
    return;
  }
  in.model.Turn(second, centre_1, Between(first_2, first_1, normal_1));
}

/// Warns of pairs attached to a structure that a later bond moves.
void WarnOfLeftBehind(const Reading& in, int second, const SourceRef& at) {
  const auto below = [&](int structure) {
    while (structure >= 0 && structure != second) structure = in.structure(structure).parent;
    return structure == second;
  };
  for (const Pair& pair : in.model.pairs) {
    if (!in.model.MayCompare({}, {})) return;
    if (pair.removed || below(pair.structure)) continue;
    if (!below(in.node(pair.from).structure) && !below(in.node(pair.to).structure)) continue;
    in.out.Warning("ntrt.bond_moves_bonded", at,
                   "this bond moves \"" + in.structure(second).tags[0] +
                       "\", to which earlier bonds are attached: NTRT leaves the ends of these "
                       "bonds behind, taut moves them, too",
                   "list this bond before the others");
    return;
  }
}

/// Removes the cable between two nodes in `structure`. Returns false, without removal, if the pair
/// is a solid.
bool Remove(const Reading& in, int structure, int a, int b, bool& found) {
  const int i = in.model.FindPair(structure, in.node(a).place, in.node(b).place);
  if (i < 0) return true;
  found = true;
  for (const Builder& builder : in.model.builders) {
    if (IsSolid(builder.kind) && HasAll(in.pair(i).tags, builder.search)) return false;
  }
  in.pair(i).removed = true;
  return true;
}

/// Replaces the cable along the bond's edge by two cables that meet at the bond's node.
void RunThrough(const Reading& in, int parent, int first, int second, const NodeOnEdge& bond,
                const std::vector<NodeOnEdge>& all, const Words& tags) {
  bool found = false;
  for (const int structure : {first, second}) {
    if (Remove(in, structure, bond.edge_from, bond.edge_to, found)) continue;
    in.out.Error("ntrt.bond_edge_is_solid", bond.at,
                 "the edge of a node_edge bond must be a cable, not a solid");
  }
  if (!found) {
    in.out.Warning(
        "ntrt.bond_without_cable", bond.at,
        "no cable runs along this edge, so the bond adds two cables and removes none, as in NTRT");
  }
  for (const NodeOnEdge& other : all) {
    if (in.model.ComparedTooMuch()) return;
    bool ignored = false;
    Remove(in, first, bond.node, other.node, ignored);
    Remove(in, second, bond.node, other.node, ignored);
  }
  AddPair(in, parent, bond.edge_from, bond.node, tags, bond.at);
  AddPair(in, parent, bond.node, bond.edge_to, tags, bond.at);
}

void BondNodesAndEdges(const Reading& in, int parent, int first, int second,
                       const std::string& tags, const Value& lines) {
  const auto& items = ListOf(&lines, "a node_edge bond", in.out);
  if (items.size() < 3) {
    in.out.Error("ntrt.few_bonds", lines.at, "a node_edge bond needs at least three entries");
    return;
  }
  std::vector<NodeOnEdge> bonds;
  for (const ValuePtr& line : items) {
    const auto bond = ReadNodeOnEdge(in, first, second, *line);
    if (bond) bonds.push_back(*bond);
  }
  if (bonds.size() != items.size()) return;
  WarnOfLeftBehind(in, second, lines.at);
  Fit(in, second, bonds);
  for (const NodeOnEdge& bond : bonds) {
    RunThrough(in, parent, first, second, bond, bonds, Split(tags));
  }
}

void BondNodes(const Reading& in, int parent, int first, int second, const std::string& first_name,
               const std::string& second_name, const std::string& tags, const Value& lines) {
  // The names of both structures are tags, because controllers find cables by these names.
  const std::string all =
      tags + " " + first_name + " " + second_name + " " + first_name + "/" + second_name;
  for (const ValuePtr& line : ListOf(&lines, "a node_node bond", in.out)) {
    std::string a, b;
    if (!ReadTwo(*line, a, b, in.out)) continue;
    const int from = NodeAt(in, first, a, line->at);
    const int to = NodeAt(in, second, b, line->at);
    if (from >= 0 && to >= 0) AddPair(in, parent, from, to, Split(all), line->at);
  }
}

/// Reads a key such as "a/b/c/node_node": bonds between each structure and the next.
void ReadChain(const Reading& in, int parent, const std::string& bonds, const std::string& tags,
               const Entry& entry) {
  if (entry.value->kind == Value::Kind::kNull) return;
  std::vector<std::string> names = AtSlashes(bonds);
  const std::string kind = names.back();
  names.pop_back();
  if (kind != "node_node" && kind != "node_edge") {
    in.out.Error("ntrt.bond_kind", entry.key_at,
                 "\"" + bonds + "\" does not end with a kind of bond",
                 "expected node_node or node_edge, such as t1/t2/node_node");
    return;
  }
  if (names.size() < 2) {
    in.out.Error("ntrt.bond_of_one", entry.key_at, "a bond must join at least two substructures",
                 "such as t1/t2/" + kind);
    return;
  }
  for (std::size_t i = 0; i + 1 < names.size(); ++i) {
    const int first = in.model.FindChild(parent, names[i]);
    const int second = in.model.FindChild(parent, names[i + 1]);
    if (first < 0 || second < 0) {
      in.out.Error("ntrt.unknown_substructure", entry.key_at,
                   "there is no substructure \"" + (first < 0 ? names[i] : names[i + 1]) + "\"");
      return;
    }
    if (kind == "node_node") {
      BondNodes(in, parent, first, second, names[i], names[i + 1], tags, *entry.value);
    } else {
      BondNodesAndEdges(in, parent, first, second, tags, *entry.value);
    }
  }
}

}  // namespace

void ReadBonds(const Reading& in, int structure, const Value* bonds) {
  const auto is_bond = [](const std::string& key) { return key.find('/') != key.npos; };
  for (const Entry& outer : MapOf(bonds, "bond_groups", in.out)) {
    for (const Entry& inner : MapOf(outer.value.get(), outer.key, in.out)) {
      if (is_bond(outer.key) == is_bond(inner.key)) {
        in.out.Error("ntrt.nested_bond", inner.key_at,
                     is_bond(inner.key) ? "a bond cannot contain another bond"
                                        : "a tag contains another tag instead of a bond",
                     "put bonds such as t1/t2/node_node into a tag, or tags into a bond");
        continue;
      }
      ReadChain(in, structure, is_bond(outer.key) ? outer.key : inner.key,
                is_bond(outer.key) ? inner.key : outer.key, inner);
    }
  }
}

}  // namespace taut::import_ntrt
