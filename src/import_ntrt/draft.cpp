#include "import_ntrt/draft.h"

#include <algorithm>
#include <set>

#include "base/unique_names.h"

namespace taut::import_ntrt {
namespace {

Words NameTexts(const Words& words) {
  Words names;
  std::set<std::string> known;
  for (const std::string& word : words) {
    const std::string name = NameText(word);
    if (known.insert(name).second) names.push_back(name);
  }
  return names;
}

class Drafter {
 public:
  Drafter(const Model& model, const Built& built, double length_unit_m)
      : model_(model), built_(built), u_(length_unit_m) {}

  Draft Run() {
    NamePlacements();
    MakeNodes();
    std::vector<bool> is_built(model_.pairs.size(), false);
    for (const Solid& solid : built_.solids) {
      if (solid.pair >= 0) is_built[static_cast<std::size_t>(solid.pair)] = true;
    }
    for (const Cable& cable : built_.cables) is_built[static_cast<std::size_t>(cable.pair)] = true;
    MakePairs();
    NameDuplicates(is_built);
    return std::move(draft_);
  }

 private:
  const Structure& StructureOf(int i) const {
    return model_.structures[static_cast<std::size_t>(i)];
  }

  /// Names each placement by its path from the top-level structure: leg_knee.
  void NamePlacements() {
    base::UniqueNames taken;
    for (const Structure& structure : model_.structures) {
      std::string name;
      if (structure.parent >= 0) {
        const std::string& parent = draft_.placements[static_cast<std::size_t>(structure.parent)];
        name = structure.tags.empty() ? "_" : NameText(structure.tags[0]);
        name = taken.Take(parent.empty() ? name : parent + "_" + name);
      }
      draft_.placements.push_back(name);
    }
  }

  void MakeNodes() {
    std::vector<bool> is_used(model_.nodes.size(), false);
    const auto use = [&](int node) { is_used[static_cast<std::size_t>(node)] = true; };
    for (const Solid& solid : built_.solids) use(solid.from), use(solid.to);
    for (const Cable& cable : built_.cables) use(cable.from.node), use(cable.to.node);
    std::vector<base::UniqueNames> taken(model_.structures.size());
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      const Node& node = model_.nodes[i];
      DraftNode draft;
      draft.structure = is_used[i] ? node.structure : -1;
      draft.name = taken[static_cast<std::size_t>(node.structure)].Take(NameText(node.tags[0]));
      const std::string& placement = draft_.placements[static_cast<std::size_t>(node.structure)];
      draft.full_name = placement.empty() ? draft.name : placement + "." + draft.name;
      draft.tags = Without(NameTexts(node.tags), {draft.name});
      draft.at_m = u_ * ZUp(node.in_file);
      draft_.nodes.push_back(std::move(draft));
    }
    // If the sphere's node coincides with another node, that node receives its tags.
    for (const Solid& solid : built_.solids) {
      if (solid.node < 0 || solid.node == solid.from) continue;
      DraftNode& at = draft_.nodes[static_cast<std::size_t>(solid.from)];
      for (const std::string& tag :
           NameTexts(model_.nodes[static_cast<std::size_t>(solid.node)].tags)) {
        if (tag != at.name && !Has(at.tags, tag)) at.tags.push_back(tag);
      }
    }
  }

  void MakePairs() {
    for (const Pair& pair : model_.pairs) {
      DraftPair draft;
      draft.from = built_.same[static_cast<std::size_t>(pair.from)];
      draft.to = built_.same[static_cast<std::size_t>(pair.to)];
      draft.tags = NameTexts(pair.tags);
      draft.structure = pair.structure;
      draft_.pairs.push_back(std::move(draft));
    }
    for (const Structure& structure : model_.structures) {
      int number = 0;
      for (const int i : structure.pairs) {
        draft_.pairs[static_cast<std::size_t>(i)].number = number++;
      }
    }
  }

  /// taut names a pair after its nodes, in either order. So a second pair between the same nodes
  /// needs a separate name.
  void NameDuplicates(const std::vector<bool>& is_built) {
    std::map<std::pair<int, int>, int> count;
    for (std::size_t i = 0; i < draft_.pairs.size(); ++i) {
      DraftPair& pair = draft_.pairs[i];
      if (!is_built[i]) continue;
      const int number = ++count[std::minmax(pair.from, pair.to)];
      if (number == 1) continue;
      const DraftNode& from = draft_.nodes[static_cast<std::size_t>(pair.from)];
      const DraftNode& to = draft_.nodes[static_cast<std::size_t>(pair.to)];
      const bool together = from.structure == to.structure && from.structure == pair.structure;
      pair.name =
          NameText(together ? from.name + "-" + to.name : from.full_name + "-" + to.full_name) +
          "_" + std::to_string(number);
    }
  }

  const Model& model_;
  const Built& built_;
  const double u_;
  Draft draft_;
};

}  // namespace

Draft MakeDraft(const Model& model, const Built& built, double length_unit_m) {
  return Drafter(model, built, length_unit_m).Run();
}

std::string Group::Text() const {
  std::string text = kind + (on_nodes ? " nodes " : " pairs ") + comment;
  for (const auto* list : {&fields, &actuator}) {
    text += "|";
    for (const Field& field : *list) {
      text += field.key + "=" + (field.text.empty() ? NumberText(field.number) : field.text) + ";";
    }
  }
  return text;
}

}  // namespace taut::import_ntrt
