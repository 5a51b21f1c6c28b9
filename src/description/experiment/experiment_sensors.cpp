// Checks of sensor keys: load cells, encoders, delays.
#include <cmath>

#include "description/experiment/experiment_keys.h"

namespace taut::description {
namespace {

/// Checks that a delay is a whole number of sensor periods, so that the delay does not depend on
/// the times of readings. `what`: the sensor's key in `map`.
void CheckDelay(const MapReader& map, const char* what, double delay_s, double period_s) {
  constexpr double kLongest = 10000;  // largest number of buffered samples
  const Value* sensor = map.Find(what);
  const double periods = delay_s / period_s;
  if (!sensor || std::isnan(periods)) return;
  const std::string path = map.Path(what) + ".delay_s";
  if (periods > kLongest) {
    map.scope().out.Error("sensor.delay_too_long", KeyAt(*sensor, "delay_s"),
                          path + " must not be longer than 10000 sensor periods",
                          "the period is " + Shown(period_s) + " s");
  } else if (std::fabs(periods - std::floor(periods + 0.5)) > 1e-6) {
    map.scope().out.Error(
        "sensor.delay_not_whole", KeyAt(*sensor, "delay_s"),
        path + " must be a whole number of sensor periods, got " + Shown(periods),
        "the period is " + Shown(period_s) + " s; give `sensors` another `period_s`");
  }
}

}  // namespace

void Check(const MapReader& map, LoadCellText& cell) {
  if (cell.counts) {
    for (const char* other : {"range_n", "bits", "quantum_n"}) {
      if (!map.Has(other)) continue;
      map.Error("sensor.counts_given_twice", other,
                map.what() + " has both counts and " + std::string(other),
                "`counts` already defines the range and the bits");
    }
    return;
  }
  cell.min_n = map.Has("range_n") ? cell.range_n.first : 0.0;
  cell.max_n = cell.range_n.second;
  if (cell.min_n >= cell.max_n) {
    map.scope().out.Error(
        "sensor.empty_range", map.Find("range_n")->at,
        map.Path("range_n") + ": " + Shown(cell.min_n) + " is not below " + Shown(cell.max_n),
        "expected [least, greatest]");
  }
  if (!map.Has("bits")) return;
  if (map.Has("quantum_n")) {
    map.Error("sensor.bits_and_quantum", "bits", map.what() + " has both bits and quantum_n",
              "give only one of them: it determines the other");
  }
  if (!map.Has("range_n")) {
    map.Error("sensor.bits_need_range", "bits",
              map.Path("bits") + " needs the key \"range_n\" as well", "write `range_n: [0, 100]`");
  }
  if (cell.bits) cell.quantum_n = (cell.max_n - cell.min_n) / (std::ldexp(1.0, *cell.bits) - 1.0);
}

void Check(const MapReader& map, EncoderText& encoder) {
  constexpr double kTwoPi = 6.28318530717958647692;
  for (const char* key : {"decoding", "gear_ratio", "index"}) {
    if (!map.Has(key) || map.Has("lines")) continue;
    map.Error("sensor.key_needs_lines", key, map.Path(key) + " needs the key \"lines\" as well",
              "it describes an encoder on the motor's shaft");
  }
  if (encoder.decoding == 3) {
    map.Error("sensor.bad_decoding", "decoding", map.Path("decoding") + " must be 1, 2 or 4, got 3",
              "1: one edge per line, 2: both edges of one channel, 4: both edges of both channels");
  }
  const char* const by = map.Has("lines") ? "lines" : "counts_per_turn";
  if (!map.Has(by) && !map.Has("spool_radius_m")) return;
  for (const char* other : {"quantum_m", "counts_per_turn"}) {
    if (!map.Has(other) || std::string(other) == by) continue;
    map.Error("sensor.resolution_given_twice", other,
              map.what() + " has both " + std::string(other) + " and " + by,
              "give only one of them: it determines the other");
  }
  if (!map.Require(by) || !map.Require("spool_radius_m")) return;
  if (!encoder.lines) {
    encoder.quantum_m = kTwoPi * *encoder.spool_radius_m / encoder.counts_per_turn.value_or(NAN);
    return;
  }
  const double turn_m = kTwoPi * *encoder.spool_radius_m / encoder.gear_ratio;
  encoder.quantum_m = turn_m / (*encoder.lines * encoder.decoding);
  if (encoder.index) encoder.index_m = turn_m;
}

void Check(const MapReader& map, SensorText& sensors) {
  sensors.load_cell = sensors.load_cell_text;
  sensors.encoder = sensors.encoder_text;
  if (sensors.load_cell) CheckDelay(map, "load_cell", sensors.load_cell->delay_s, sensors.period_s);
  if (sensors.encoder) CheckDelay(map, "encoder", sensors.encoder->delay_s, sensors.period_s);
}

}  // namespace taut::description
