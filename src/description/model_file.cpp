#include "description/laws.h"
#include "description/model_text.h"

namespace taut::description {
namespace {

const std::vector<std::string> kTopKeys{
    "taut",    "kind",    "name",        "description",       "base",     "parameters",
    "parts",   "nodes",   "pairs",       "structure",         "builders", "gravity_m_per_s2",
    "contact", "inertia", "damping_law", "allow_disconnected"};

void ReadContact(const Value& value, ModelText& model, const Scope& scope) {
  const MapReader map(value, "contact", {"friction_combine", "restitution_combine", "friction_law"},
                      scope);
  model.friction_combine = map.ChoiceOr("friction_combine", model.friction_combine, kCombineRules);
  model.restitution_combine =
      map.ChoiceOr("restitution_combine", model.restitution_combine, kCombineRules);
  model.friction_law = map.ChoiceOr("friction_law", model.friction_law, kFrictionLaws);
}

}  // namespace

ModelText ReadModelText(const Value& root, const Scope& scope) {
  ModelText model;
  const MapReader map(root, "", kTopKeys, scope);
  model.at = root.at;
  model.name = map.Name("name");
  model.description = map.TextOr("description", "");
  model.gravity_m_per_s2 = map.VectorOr("gravity_m_per_s2", model.gravity_m_per_s2);
  if (const Value* contact = map.Find("contact")) ReadContact(*contact, model, scope);
  model.bounding_box_inertia =
      map.ChoiceOr("inertia", InertiaLaw::kExact, kInertiaLaws) == InertiaLaw::kBoundingBox;
  model.allow_disconnected = map.BoolOr("allow_disconnected", false);
  const DampingLaw damping_law = map.ChoiceOr("damping_law", DampingLaw::kExact, kDampingLaws);

  for (const Entry& entry : Entries(map.Find("parts"), "parts", scope)) {
    const MapReader part(*entry.value, "parts." + entry.key, {"nodes", "pairs"}, scope);
    // Kept for those who name it, who have made no mistake.
    if (ReadKey(entry, "parts", scope).empty()) model.nodes_complete = false;
    model.parts.push_back({entry.key, {}, {}});
    ReadNodesAndPairs(part, model.parts.back(), model);
    if (part.is_map() && !part.Has("nodes")) {
      part.Require("nodes");
      model.nodes_complete = false;
    }
  }
  ReadNodesAndPairs(map, model.loose, model);
  model.structure = ReadStructure(map.Find("structure"), model, scope);
  model.builders = ReadBuilders(map.Find("builders"), damping_law, model.builders_complete, scope);
  if (!map.Has("nodes") && !map.Has("structure")) {
    scope.out.Error(root.at, "the model places nothing",
                    map.Has("parts") ? "parts are placed by a `structure:` list"
                                     : "a model needs `nodes:`, or `parts:` and a `structure:`");
    model.nodes_complete = false;
  }
  return model;
}

}  // namespace taut::description
