#include <cmath>

#include "base/pattern.h"
#include "description/experiment_keys.h"
#include "description/experiment_parts.h"

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

/// A delay in whole periods, so that it does not depend on when samples are looked at. `what` is
/// the sensor, a key of `map`.
void CheckDelay(const MapReader& map, const char* what, double delay_s, double period_s) {
  constexpr double kLongest = 10000;  // samples that have to be kept
  const Value* sensor = map.Find(what);
  const double periods = delay_s / period_s;
  if (!sensor || std::isnan(periods)) return;
  const std::string path = map.Path(what) + ".delay_s";
  if (periods > kLongest) {
    map.scope().out.Error(KeyAt(*sensor, "delay_s"),
                          path + " must not be longer than 10000 sensor periods",
                          "the period is " + Shown(period_s) + " s");
  } else if (std::fabs(periods - std::floor(periods + 0.5)) > 1e-6) {
    map.scope().out.Error(
        KeyAt(*sensor, "delay_s"),
        path + " must be a whole number of sensor periods, got " + Shown(periods),
        "the period is " + Shown(period_s) + " s; give `sensors` another `period_s`");
  }
}

}  // namespace

void Check(const MapReader& map, LoadCellText& cell) {
  cell.min_n = map.Has("range_n") ? cell.range_n.first : 0.0;
  cell.max_n = cell.range_n.second;
  if (cell.min_n >= cell.max_n) {
    map.scope().out.Error(
        map.Find("range_n")->at,
        map.Path("range_n") + ": " + Shown(cell.min_n) + " is not below " + Shown(cell.max_n),
        "write [least, greatest]");
  }
  if (!map.Has("bits")) return;
  if (map.Has("quantum_n")) {
    map.Error("bits", map.what() + " has bits and quantum_n", "one follows from the other");
  }
  if (!map.Has("range_n")) {
    map.Error("bits", map.Path("bits") + " needs the key \"range_n\" beside it",
              "write `range_n: [0, 100]`");
  }
  if (cell.bits) cell.quantum_n = (cell.max_n - cell.min_n) / (std::ldexp(1.0, *cell.bits) - 1.0);
}

void Check(const MapReader& map, EncoderText& encoder) {
  constexpr double kTwoPi = 6.28318530717958647692;
  if (!encoder.counts_per_turn && !encoder.spool_radius_m) return;
  if (map.Has("quantum_m")) {
    map.Error("quantum_m", map.what() + " has quantum_m and counts_per_turn",
              "one follows from the other");
  }
  if (!map.Require("counts_per_turn") || !map.Require("spool_radius_m")) return;
  encoder.quantum_m = kTwoPi * *encoder.spool_radius_m / *encoder.counts_per_turn;
}

void Check(const MapReader& map, SensorText& sensors) {
  sensors.load_cell = sensors.load_cell_text;
  sensors.encoder = sensors.encoder_text;
  if (sensors.load_cell) CheckDelay(map, "load_cell", sensors.load_cell->delay_s, sensors.period_s);
  if (sensors.encoder) CheckDelay(map, "encoder", sensors.encoder->delay_s, sensors.period_s);
}

void Check(const MapReader& map, ScaleText& scale) {
  std::string key;  // one at most: of several none was looked at
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
    map.Error("bodies", "scale: " + key + " has no bodies", "only mass has");
  }
  if (map.Has("cables") && key != "stiffness" && key != "damping") {
    map.Error("cables", "scale: " + key + " has no cables", "stiffness and damping have");
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
