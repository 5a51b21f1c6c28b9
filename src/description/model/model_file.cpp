// Reader of the top level of model files.
#include <cmath>
#include <map>
#include <string>

#include "description/model/model_keys.h"
#include "description/yaml/read_keys.h"

namespace taut::description {
namespace {

/// Checks that motors with the same supply give the same voltage and resistance.
void CheckSupplies(const ModelText& model, Diagnostics& out) {
  std::map<std::string, const BuilderText*> first;
  for (const BuilderText& builder : model.builders) {
    if (!builder.cable || !builder.cable->actuator.dc_motor) continue;
    const DcMotorDef& motor = *builder.cable->actuator.dc_motor;
    const BuilderText& other = *first.emplace(motor.supply, &builder).first->second;
    const DcMotorDef& there = *other.cable->actuator.dc_motor;
    const auto figures = [](const DcMotorDef& m) {
      return Shown(m.supply_voltage_v) + " V and " + Shown(m.supply_resistance_ohm) + " ohm";
    };
    if (figures(motor) == figures(there)) continue;
    if (std::isnan(motor.supply_voltage_v + motor.supply_resistance_ohm + there.supply_voltage_v +
                   there.supply_resistance_ohm)) {
      continue;  // already reported
    }
    out.Error("motor.supply_differs", builder.at,
              "a dc_motor's supply \"" + motor.supply +
                  "\" differs from the one in the builder of line " +
                  std::to_string(other.at.line) + ": " + figures(motor) + " here, " +
                  figures(there) + " there",
              "make them equal, or give one of them another `supply`");
  }
}

}  // namespace

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
  if (map.Has("apart")) model.apart_at = map.Find("apart")->at;
  for (BuilderText& builder : model.builders) {
    if (!model.actuator_text || !builder.cable || !builder.cable->actuator_text) continue;
    builder.cable->actuator = *model.actuator_text;
  }
  CheckSupplies(model, map.scope().out);
  if (!map.Has("nodes") && !map.Has("structure")) {
    map.scope().out.Error("model.empty", map.at(), "the model has neither nodes nor a structure",
                          map.Has("parts") ? "place the parts in a `structure:` list"
                                           : "add `nodes:`, or `parts:` and a `structure:`");
    model.nodes_complete = false;
  }
}

ModelText ReadModelText(const Value& root, const Scope& scope) {
  ModelText model;
  ReadMapping(root, "", scope, model);
  return model;
}

}  // namespace taut::description
