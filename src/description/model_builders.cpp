#include <limits>

#include "description/laws.h"
#include "description/material.h"
#include "description/model_text.h"

namespace taut::description {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

std::vector<std::string> With(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

/// Exactly one of the mass keys. `per_length` allows mass_kg_per_m, for what has a length.
MassText ReadMass(const MapReader& map, bool per_length) {
  std::vector<std::string> keys{"mass_kg", "density_kg_per_m3"};
  if (per_length) keys.push_back("mass_kg_per_m");
  const std::string key = map.ExactlyOne(keys);
  MassText mass;
  if (key.empty()) return mass;
  mass.value = map.Number(key, Bound::kNonNegative);
  mass.kind = key == "mass_kg"         ? MassText::Kind::kTotal
              : key == "mass_kg_per_m" ? MassText::Kind::kPerLength
                                       : MassText::Kind::kDensity;
  return mass;
}

RodBuilder ReadRod(const Value& value, const Scope& scope) {
  const MapReader map(
      value, "rod",
      With({"radius_m", "mass_kg", "density_kg_per_m3", "mass_kg_per_m", "collides"},
           kMaterialKeys),
      scope);
  RodBuilder rod;
  rod.radius_m = map.Number("radius_m", Bound::kPositive);
  rod.mass = ReadMass(map, true);
  rod.material = ReadMaterial(map);
  rod.collides = map.BoolOr("collides", true);
  return rod;
}

SphereBuilder ReadSphere(const Value& value, const Scope& scope) {
  const MapReader map(value, "sphere",
                      With({"radius_m", "mass_kg", "density_kg_per_m3", "collides"}, kMaterialKeys),
                      scope);
  SphereBuilder sphere;
  sphere.radius_m = map.Number("radius_m", Bound::kPositive);
  sphere.mass = ReadMass(map, false);
  sphere.material = ReadMaterial(map);
  sphere.collides = map.BoolOr("collides", true);
  return sphere;
}

PointMassBuilder ReadPointMass(const Value& value, const Scope& scope) {
  const MapReader map(value, "point_mass", {"mass_kg", "radius_m"}, scope);
  return {map.Number("mass_kg", Bound::kPositive),
          map.NumberOr("radius_m", 0.0, Bound::kNonNegative)};
}

/// `width_m` and `height_m`: along pairs. `size_m` or `half_extents_m`: at nodes.
void ReadBox(const Value& value, BuilderText& builder, const Scope& scope) {
  const MapReader map(value, "box",
                      With({"size_m", "half_extents_m", "width_m", "height_m", "mass_kg",
                            "density_kg_per_m3", "mass_kg_per_m", "collides"},
                           kMaterialKeys),
                      scope);
  if (map.Has("width_m") || map.Has("height_m")) {
    BeamBuilder beam;
    for (const char* other : {"size_m", "half_extents_m"}) {
      if (!map.Has(other)) continue;
      map.Error(other, "box has both width_m and " + std::string(other),
                "width_m and height_m along a pair, size_m or half_extents_m at a node");
    }
    beam.width_m = map.Number("width_m", Bound::kPositive);
    beam.height_m = map.Number("height_m", Bound::kPositive);
    beam.mass = ReadMass(map, true);
    beam.material = ReadMaterial(map);
    beam.collides = map.BoolOr("collides", true);
    builder.build = beam;
    return;
  }
  BoxBuilder box;
  const std::string key = map.ExactlyOne({"size_m", "half_extents_m", "width_m"});
  if (!key.empty()) {
    const Vec3 given = map.Vector(key);
    const double factor = key == "size_m" ? 1.0 : 2.0;
    box.size_m = {factor * given.x, factor * given.y, factor * given.z};
    if (given.x <= 0.0 || given.y <= 0.0 || given.z <= 0.0) {
      map.Error(key, map.Path(key) + " must be three positive numbers");
    }
  }
  box.mass = ReadMass(map, false);
  if (map.Has("mass_kg_per_m")) {
    map.Error("mass_kg_per_m", "a box at a node has no length", "mass_kg or density_kg_per_m3");
  }
  box.material = ReadMaterial(map);
  box.collides = map.BoolOr("collides", true);
  builder.build = box;
}

ActuatorDef ReadActuator(const Value& value, const Scope& scope) {
  const std::vector<std::string> limits{"max_speed_m_per_s", "max_acceleration_m_per_s2",
                                        "max_force_n", "min_rest_length_m", "min_length_m"};
  const MapReader map(value, "cable.actuator", With({"ideal"}, limits), scope);
  ActuatorDef actuator;
  if (!map.is_map()) return actuator;
  bool limited = false;
  for (const std::string& limit : limits) limited = limited || map.Has(limit);
  const bool ideal = map.BoolOr("ideal", false);
  if (ideal && limited) {
    map.Error("ideal", "an ideal actuator has no limits", "leave out `ideal`, or the limits");
  } else if (!ideal && !limited) {
    scope.out.Error(value.at, "cable.actuator needs limits, or `ideal: true`",
                    "without an actuator the rest length is fixed");
  }
  actuator.kind = ideal ? ActuatorDef::Kind::kIdeal : ActuatorDef::Kind::kLimited;
  actuator.max_speed_m_per_s = map.NumberOr(limits[0], kInf, Bound::kPositive);
  actuator.max_acceleration_m_per_s2 = map.NumberOr(limits[1], kInf, Bound::kPositive);
  actuator.max_force_n = map.NumberOr(limits[2], kInf, Bound::kPositive);
  actuator.min_rest_length_m = map.NumberOr(limits[3], 0.0, Bound::kNonNegative);
  actuator.min_length_m = map.NumberOr(limits[4], 0.0, Bound::kNonNegative);
  return actuator;
}

CableBuilder ReadCable(const Value& value, DampingLaw damping_law, const Scope& scope) {
  const MapReader map(value, "cable",
                      {"stiffness_n_per_m", "damping_n_s_per_m", "prestress_n", "rest_length_m",
                       "rest_length_ratio", "damping_law", "ends", "actuator"},
                      scope);
  CableBuilder cable;
  cable.stiffness_n_per_m = map.Number("stiffness_n_per_m", Bound::kPositive);
  cable.damping_n_s_per_m = map.NumberOr("damping_n_s_per_m", 0.0, Bound::kNonNegative);
  const std::string rest = map.ExactlyOne({"prestress_n", "rest_length_m", "rest_length_ratio"});
  if (!rest.empty()) {
    cable.rest = rest == "prestress_n"     ? CableBuilder::Rest::kPrestress
                 : rest == "rest_length_m" ? CableBuilder::Rest::kLength
                                           : CableBuilder::Rest::kRatio;
    cable.rest_value =
        map.Number(rest, rest == "prestress_n" ? Bound::kNonNegative : Bound::kPositive);
    cable.rest_at = map.Find(rest)->at;
  }
  cable.damping_law = map.ChoiceOr("damping_law", damping_law, kDampingLaws);
  cable.ends_on_surface = map.ChoiceOr<bool>("ends", false, {{"node", false}, {"surface", true}});
  if (map.Has("ends")) cable.ends_at = map.Find("ends")->at;
  if (const Value* actuator = map.Find("actuator")) cable.actuator = ReadActuator(*actuator, scope);
  return cable;
}

}  // namespace

std::vector<BuilderText> ReadBuilders(const Value* list, DampingLaw damping_law, bool& complete,
                                      const Scope& scope) {
  std::vector<BuilderText> builders;
  if (list && list->kind != Value::Kind::kSequence) complete = false;
  const std::vector<std::string> kinds{"rod", "sphere", "point_mass", "box", "cable", "anchor"};
  const std::vector<ValuePtr>& items = Items(list, "builders", scope);
  if (items.size() > static_cast<std::size_t>(kMaxBuilders)) {
    scope.out.Error(list->at, "more than " + std::to_string(kMaxBuilders) + " builders",
                    "match by tags that many nodes or pairs share");
    complete = false;
    return builders;
  }
  for (const ValuePtr& item : items) {
    const MapReader map(*item, "builder", With({"match"}, kinds), scope);
    BuilderText builder;
    builder.at = item->at;
    const Value* match = map.Require("match");
    if (match) {
      builder.match_at = match->at;
      builder.match = ReadMatch(*match, "match", scope);
    }
    builder.kind = map.ExactlyOne(kinds);
    if (builder.match.empty() || builder.kind.empty()) {
      complete = false;
      continue;
    }
    const Value& build = *map.Find(builder.kind);
    if (builder.kind == "rod") builder.build = ReadRod(build, scope);
    if (builder.kind == "sphere") builder.build = ReadSphere(build, scope);
    if (builder.kind == "point_mass") builder.build = ReadPointMass(build, scope);
    if (builder.kind == "box") ReadBox(build, builder, scope);
    if (builder.kind == "cable") builder.build = ReadCable(build, damping_law, scope);
    if (builder.kind == "anchor") {
      const MapReader nothing_inside(build, "anchor", {}, scope);
      builder.build = AnchorBuilder{};
    }
    builders.push_back(std::move(builder));
  }
  return builders;
}

}  // namespace taut::description
