// Scale factors of an experiment on friction, masses, stiffnesses and dampings.
#include <cmath>

#include "base/pattern.h"
#include "description/experiment/experiment_keys.h"
#include "description/experiment/experiment_parts.h"

namespace taut::description {
namespace {

/// Returns the bodies whose names match one of the patterns.
std::vector<int> SelectBodies(const Value& value, const std::string& what, const RobotSpec* robot,
                              const Scope& scope) {
  std::vector<std::string> patterns;
  if (value.kind == Value::Kind::kSequence) {
    for (const ValuePtr& item : value.items) patterns.push_back(ReadText(*item, what, scope));
  } else {
    patterns.push_back(ReadText(value, what, scope));
  }
  std::vector<int> bodies;
  if (!robot) return bodies;
  std::vector<std::string> names;
  for (std::size_t b = 0; b < robot->def.bodies.size(); ++b) {
    names.push_back(robot->def.bodies[b].name);
    if (base::FitsAny(patterns, names.back())) bodies.push_back(static_cast<int>(b));
  }
  if (bodies.empty() && !patterns.empty()) {
    scope.out.Error("scale.unknown_body", value.at,
                    what + ": no body is called \"" + patterns[0] + "\"",
                    NameHint(patterns[0], names));
  }
  return bodies;
}

}  // namespace

void Check(const MapReader& map, ScaleText& scale) {
  std::string key;  // if several keys are present, the reader has reported an error and set none
  const std::optional<double> factors[] = {scale.friction, scale.mass, scale.stiffness,
                                           scale.damping};
  for (std::size_t i = 0; i < kScaledQuantities.size(); ++i) {
    if (!factors[i]) continue;
    key = kScaledQuantities[i].first;
    scale.quantity = kScaledQuantities[i].second;
    scale.factor = *factors[i];
  }
  if (key.empty()) return;
  if (map.Has("bodies") && key != "mass") {
    map.Error("scale.no_bodies", "bodies", "scale: " + key + " cannot be limited to `bodies`",
              "only mass can");
  }
  if (map.Has("cables") && key != "stiffness" && key != "damping") {
    map.Error("scale.no_cables", "cables", "scale: " + key + " cannot be limited to `cables`",
              "only stiffness and damping can");
  }
}

std::vector<ScaleSpec> ToScales(const std::vector<ScaleText>& texts, const RobotSpec* robot,
                                const Scope& scope) {
  std::vector<ScaleSpec> scales;
  for (const ScaleText& text : texts) {
    ScaleSpec& scale = scales.emplace_back(ScaleSpec{text.quantity, {}, text.factor});
    if (text.bodies.value)
      scale.index = SelectBodies(*text.bodies.value, "scale.bodies", robot, scope);
    if (text.cables.value)
      scale.index = SelectCables(*text.cables.value, "scale.cables", robot, scope);
  }
  return scales;
}

}  // namespace taut::description
