#include "description/model_keys.h"
#include "description/read_keys.h"

namespace taut::description {

void Check(const MapReader& map, ModelText& model) {
  for (auto& item : model.parts_text.items) {
    model.nodes_complete = model.nodes_complete && item.good_name && item.value.nodes_complete;
    model.pairs_complete = model.pairs_complete && item.value.pairs_complete;
    model.parts.push_back(std::move(item.value));
  }
  FinishNodesAndPairs(map, true, model.loose);
  model.nodes_complete = model.nodes_complete && model.loose.nodes_complete;
  model.pairs_complete = model.pairs_complete && model.loose.pairs_complete;
  FinishStructure(map, model);
  FinishBuilders(map, model);
  for (BuilderText& builder : model.builders) {
    if (!model.actuator_text || !builder.cable || !builder.cable->actuator_text) continue;
    builder.cable->actuator = *model.actuator_text;
  }
  if (!map.Has("nodes") && !map.Has("structure")) {
    map.scope().out.Error(map.at(), "the model places nothing",
                          map.Has("parts")
                              ? "parts are placed by a `structure:` list"
                              : "a model needs `nodes:`, or `parts:` and a `structure:`");
    model.nodes_complete = false;
  }
}

ModelText ReadModelText(const Value& root, const Scope& scope) {
  ModelText model;
  ReadMapping(root, "", scope, model);
  return model;
}

}  // namespace taut::description
