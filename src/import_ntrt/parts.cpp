// YAML text of nodes, pairs, parts and placements. A file with several copies becomes one part.
// Pairs that only some copies have are written outside of the part.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "import_ntrt/draft.h"

namespace taut::import_ntrt {
namespace {

/// Copies of a file with the same nodes.
struct Part {
  std::string name, file, nodes;
  std::vector<int> structures;
  std::set<std::string> pairs;  ///< Pairs that all copies have, by number and text.
};

class YamlText {
 public:
  YamlText(const Model& model, const Draft& draft, double length_unit_m)
      : model_(model), draft_(draft), u_(length_unit_m), grid_(SizeOf()) {}

  std::string Run() {
    for (const Group& group : draft_.groups) {
      if (group.on_nodes) continue;
      for (const int item : group.items) is_built_.insert(item);
    }
    FindParts();
    for (Part& part : parts_) FindPairs(part);
    std::string parts, places;
    for (const Part& part : parts_) {
      parts += "\n  " + part.name + ":  # " + part.file + "\n    nodes:\n" + part.nodes +
               PairsText(PairsOfPart(part), true, "    ");
    }
    for (std::size_t s = 1; s < model_.structures.size(); ++s) {
      if (part_of_[s]) places += PlaceText(s) + "\n";
    }
    if (!parts.empty()) parts = "\nparts:" + parts + "\nstructure:\n" + places;
    std::vector<int> loose;
    for (const int pair : is_built_) {
      if (!InPart(pair)) loose.push_back(pair);
    }
    const std::string nodes = NodesText(0, "  ");
    const std::string pairs = PairsText(loose, false, "");
    return (nodes.empty() ? "" : "\nnodes:\n" + nodes) + parts +
           (pairs.empty() ? "" : "\n" + pairs);
  }

 private:
  const DraftNode& NodeOf(int i) const { return draft_.nodes[static_cast<std::size_t>(i)]; }
  const DraftPair& PairOf(int i) const { return draft_.pairs[static_cast<std::size_t>(i)]; }

  double SizeOf() const {
    double size = 0.0;
    const auto grow = [&](const Vec3& v) {
      for (const double x : {v.x, v.y, v.z}) size = std::max(size, std::fabs(x));
    };
    for (const DraftNode& node : draft_.nodes) grow(node.at_m);
    for (const Structure& structure : model_.structures) grow(u_ * structure.shift);
    return size;
  }

  std::string NodesText(int structure, const std::string& indent) const {
    std::string text;
    for (const DraftNode& node : draft_.nodes) {
      if (node.structure != structure) continue;
      const std::string at = grid_.Text(node.at_m);
      std::string more;
      if (!node.tags.empty()) more += ", tags: " + FlowList(node.tags);
      if (!node.fixed_to.empty()) more += ", fixed_to: " + node.fixed_to;
      text += indent + node.name + ": " + (more.empty() ? at : "{at_m: " + at + more + "}") + "\n";
    }
    return text;
  }

  static std::string FlowList(const Words& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "[" : ", ") + word;
    return text + "]";
  }

  void FindParts() {
    part_of_.assign(model_.structures.size(), 0);
    std::set<std::string> taken;
    for (std::size_t s = 1; s < model_.structures.size(); ++s) {
      const std::string nodes = NodesText(static_cast<int>(s), "      ");
      if (nodes.empty()) continue;
      const std::filesystem::path file = model_.structures[s].file;
      auto same = std::find_if(parts_.begin(), parts_.end(), [&](const Part& part) {
        return part.nodes == nodes &&
               model_.structures[static_cast<std::size_t>(part.structures[0])].file == file;
      });
      if (same == parts_.end()) {
        Part part;
        const std::string name = NameText(file.stem().string());
        part.name = name;
        for (int i = 2; !taken.insert(part.name).second; ++i) {
          part.name = name + "_" + std::to_string(i);
        }
        part.file = file.filename().string();
        part.nodes = nodes;
        parts_.push_back(std::move(part));
        same = parts_.end() - 1;
      }
      same->structures.push_back(static_cast<int>(s));
      part_of_[s] = static_cast<int>(same - parts_.begin()) + 1;
    }
  }

  bool IsInside(int pair) const {
    const DraftPair& is = PairOf(pair);
    return NodeOf(is.from).structure == is.structure && NodeOf(is.to).structure == is.structure;
  }
  std::string TextInside(int pair) const {
    const DraftPair& is = PairOf(pair);
    return std::to_string(is.number) + " " + is.name + " " + NodeOf(is.from).name + " " +
           NodeOf(is.to).name + " " + FlowList(is.tags);
  }

  void FindPairs(Part& part) const {
    std::map<std::string, std::size_t> count;
    for (const int structure : part.structures) {
      for (const int pair : model_.structures[static_cast<std::size_t>(structure)].pairs) {
        if (is_built_.count(pair) > 0 && IsInside(pair)) ++count[TextInside(pair)];
      }
    }
    for (const auto& [text, copies] : count) {
      if (copies == part.structures.size()) part.pairs.insert(text);
    }
  }

  bool InPart(int pair) const {
    const int part = part_of_[static_cast<std::size_t>(PairOf(pair).structure)];
    return part > 0 && IsInside(pair) &&
           parts_[static_cast<std::size_t>(part - 1)].pairs.count(TextInside(pair)) > 0;
  }

  std::vector<int> PairsOfPart(const Part& part) const {
    std::vector<int> pairs;
    const auto first = static_cast<std::size_t>(part.structures[0]);
    for (const int pair : model_.structures[first].pairs) {
      if (is_built_.count(pair) > 0 && InPart(pair)) pairs.push_back(pair);
    }
    return pairs;
  }

  /// Writes pairs; consecutive pairs with the same tags are one entry.
  std::string PairsText(const std::vector<int>& pairs, bool inside,
                        const std::string& indent) const {
    std::string text;
    const auto nodes_of = [&](int pair) {
      const DraftNode &from = NodeOf(PairOf(pair).from), &to = NodeOf(PairOf(pair).to);
      return inside ? "[" + from.name + ", " + to.name + "]"
                    : "[" + from.full_name + ", " + to.full_name + "]";
    };
    for (std::size_t i = 0; i < pairs.size();) {
      const DraftPair& first = PairOf(pairs[i]);
      const std::string tags = FlowList(first.tags);
      std::vector<std::string> each;
      if (!first.name.empty()) {
        text += indent + "  - {name: " + first.name + ", nodes: " + nodes_of(pairs[i]) +
                ", tags: " + tags + "}\n";
        ++i;
        continue;
      }
      for (; i < pairs.size(); ++i) {
        const DraftPair& next = PairOf(pairs[i]);
        if (next.tags != first.tags || !next.name.empty()) break;
        each.push_back(nodes_of(pairs[i]));
      }
      if (each.size() == 1) {
        text += indent + "  - {nodes: " + each[0] + ", tags: " + tags + "}\n";
      } else {
        text += indent + "  - tags: " + tags + "\n" + indent +
                "    each:" + WrappedList(each, indent + "      ") + "\n";
      }
    }
    return text.empty() ? "" : indent + "pairs:\n" + text;
  }

  std::string PlaceText(std::size_t s) const {
    const Structure& structure = model_.structures[s];
    const Part& part = parts_[static_cast<std::size_t>(part_of_[s] - 1)];
    std::string text = "  - {part: " + part.name;
    if (draft_.placements[s] != part.name) text += ", name: " + draft_.placements[s];
    const std::string at = grid_.Text(u_ * ZUp(structure.shift));
    if (at != "[0, 0, 0]") text += ", at_m: " + at;
    const std::string turn = RotationText(ZUp(structure.turn));
    return text + (turn.empty() ? "}" : ", rotate: " + turn + "}");
  }

  const Model& model_;
  const Draft& draft_;
  const double u_;
  const Grid grid_;
  std::set<int> is_built_;  ///< Pairs that have a builder.
  std::vector<Part> parts_;
  std::vector<int> part_of_;  ///< Per structure: number of its part, starting at 1; 0 if it has no
                              ///< nodes or is the top level.
};

}  // namespace

std::string PartsText(const Model& model, const Draft& draft, double length_unit_m) {
  return YamlText(model, draft, length_unit_m).Run();
}

}  // namespace taut::import_ntrt
