#include <cmath>

#include "base/pattern.h"
#include "description/experiment_parts.h"
#include "description/resolved_fields.h"

namespace taut::description {
namespace {

/// The bodies that patterns of names stand for.
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
    scope.out.Error(value.at, what + ": no body is called \"" + patterns[0] + "\"",
                    NameHint(patterns[0], names));
  }
  return bodies;
}

/// A delay in whole periods, so that it does not depend on when samples are looked at.
double ReadDelay(const MapReader& map, double period_s) {
  constexpr double kLongest = 10000;  // samples that have to be kept
  const double delay_s = map.NumberOr("delay_s", 0.0, Bound::kNonNegative);
  const double periods = delay_s / period_s;
  if (std::isnan(periods)) return 0.0;
  if (periods > kLongest) {
    map.Error("delay_s", map.Path("delay_s") + " must not be longer than 10000 sensor periods",
              "the period is " + Shown(period_s) + " s");
  } else if (std::fabs(periods - std::floor(periods + 0.5)) > 1e-6) {
    map.Error(
        "delay_s",
        map.Path("delay_s") + " must be a whole number of sensor periods, got " + Shown(periods),
        "the period is " + Shown(period_s) + " s; give `sensors` another `period_s`");
  }
  return delay_s;
}

/// `bits` and a range, or the quantum itself.
double ReadQuantum(const MapReader& map, const LoadCellSpec& cell, bool has_range) {
  if (!map.Has("bits")) return map.NumberOr("quantum_n", 0.0, Bound::kNonNegative);
  if (map.Has("quantum_n")) {
    map.Error("bits", "sensors.load_cell has bits and quantum_n", "one follows from the other");
    return 0.0;
  }
  const std::optional<int> bits =
      ReadInteger(*map.Find("bits"), map.Path("bits"), 1, 32, map.scope());
  if (!has_range) {
    map.Error("bits", "sensors.load_cell.bits needs the key \"range_n\" beside it",
              "write `range_n: [0, 100]`");
  }
  return bits ? (cell.max_n - cell.min_n) / (std::ldexp(1.0, *bits) - 1.0) : 0.0;
}

LoadCellSpec ReadLoadCell(const Value& value, double period_s, const Scope& scope) {
  const MapReader map(value, "sensors.load_cell",
                      {"noise_n", "bias_n", "range_n", "bits", "quantum_n", "delay_s"}, scope);
  LoadCellSpec cell;
  cell.noise_n = map.NumberOr("noise_n", 0.0, Bound::kNonNegative);
  cell.bias_n = map.NumberOr("bias_n", 0.0, Bound::kNonNegative);
  const Value* range = map.Find("range_n");
  if (range) {
    if (const auto ends = ReadNumbers(*range, map.Path("range_n"), 2, scope)) {
      cell.min_n = (*ends)[0];
      cell.max_n = (*ends)[1];
      if (!(cell.min_n < cell.max_n)) {
        scope.out.Error(range->at,
                        "sensors.load_cell.range_n: " + Shown(cell.min_n) + " is not below " +
                            Shown(cell.max_n),
                        "write [least, greatest]");
      }
    }
  }
  cell.quantum_n = ReadQuantum(map, cell, range != nullptr);
  cell.delay_s = ReadDelay(map, period_s);
  return cell;
}

EncoderSpec ReadEncoder(const Value& value, double period_s, const Scope& scope) {
  const MapReader map(value, "sensors.encoder",
                      {"quantum_m", "counts_per_turn", "spool_radius_m", "delay_s"}, scope);
  EncoderSpec encoder;
  constexpr double kTwoPi = 6.28318530717958647692;
  if (map.Has("counts_per_turn") || map.Has("spool_radius_m")) {
    const double counts = map.Number("counts_per_turn", Bound::kPositive);
    const double radius_m = map.Number("spool_radius_m", Bound::kPositive);
    encoder.quantum_m = kTwoPi * radius_m / counts;
    if (map.Has("quantum_m")) {
      map.Error("quantum_m", "sensors.encoder has quantum_m and counts_per_turn",
                "one follows from the other");
    }
  } else {
    encoder.quantum_m = map.NumberOr("quantum_m", 0.0, Bound::kNonNegative);
  }
  encoder.delay_s = ReadDelay(map, period_s);
  return encoder;
}

}  // namespace

std::vector<ScaleSpec> ReadScales(const Value* list, const RobotSpec* robot, const Scope& scope) {
  std::vector<ScaleSpec> scales;
  for (const ValuePtr& item : Items(list, "scale", scope)) {
    const MapReader map(*item, "scale",
                        {"friction", "mass", "stiffness", "damping", "bodies", "cables"}, scope);
    const std::string key = map.ExactlyOne({"friction", "mass", "stiffness", "damping"});
    ScaleSpec scale;
    for (const auto& [name, quantity] : kScaledQuantities) {
      if (name == key) scale.quantity = quantity;
    }
    if (!key.empty()) scale.factor = map.Number(key, Bound::kPositive);
    const bool of_bodies = key == "mass", of_cables = key == "stiffness" || key == "damping";
    if (const Value* bodies = map.Find("bodies")) {
      scale.index = SelectBodies(*bodies, map.Path("bodies"), robot, scope);
      if (!key.empty() && !of_bodies) {
        map.Error("bodies", "scale: " + key + " has no bodies", "only mass has");
      }
    }
    if (const Value* cables = map.Find("cables")) {
      scale.index = SelectCables(*cables, map.Path("cables"), robot, scope);
      if (!key.empty() && !of_cables) {
        map.Error("cables", "scale: " + key + " has no cables", "stiffness and damping have");
      }
    }
    scales.push_back(std::move(scale));
  }
  return scales;
}

StartNoise ReadStartNoise(const Value& value, const Scope& scope) {
  const MapReader map(value, "start_noise", {"position_m", "heading_rad"}, scope);
  return {map.NumberOr("position_m", 0.0, Bound::kNonNegative),
          map.NumberOr("heading_rad", 0.0, Bound::kNonNegative)};
}

SensorSpec ReadSensors(const Value& value, const Scope& scope) {
  const MapReader map(value, "sensors", {"period_s", "load_cell", "encoder", "length"}, scope);
  SensorSpec sensors;
  sensors.period_s = map.NumberOr("period_s", sensors.period_s, Bound::kPositive);
  if (const Value* cell = map.Find("load_cell")) {
    sensors.load_cell = ReadLoadCell(*cell, sensors.period_s, scope);
  }
  if (const Value* encoder = map.Find("encoder")) {
    sensors.encoder = ReadEncoder(*encoder, sensors.period_s, scope);
  }
  sensors.length_from_tension =
      map.ChoiceOr<bool>("length", false, {{"exact", false}, {"from_tension", true}});
  return sensors;
}

}  // namespace taut::description
