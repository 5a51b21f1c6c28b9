/// Keys of sensors, delays and noise (docs/theory/sensors.md).
#pragma once

#include "description/experiment/experiment_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

inline const Choices<bool> kLengthSources{{"exact", false}, {"from_tension", true}};

template <class Io>
void Keys(Io& io, Like<LoadCellCounts> auto& c) {
  io.Map(
      "", "load_cell.counts",
      "Amplifier and converter of the load cell, instead of a range and a quantum. Readings are "
      "whole counts from 0, rounded down; the board computes the force gain * count + offset. The "
      "defaults, `counts: {}`, are the values of "
      "Tetraspine3 (eq. 7 of Mirletz et al. 2015).");
  io("gain_n_per_count", c.gain_n_per_count, Bound::kPositive, "Force per count [N].");
  io("offset_n", c.offset_n, "Force at count 0.");
  io("bits", c.bits, Bound{.least = 1, .most = 32}, "Converter bits: counts end at 2^bits - 1.");
  io("saturation_count", c.saturation_count, Bound{.least = 1, .most = 2'000'000'000},
     "Count at which the amplifier saturates.");
  io("noise_counts", c.noise_counts, Bound::kNonNegative,
     "Standard deviation of the noise of each sample, in counts, before rounding.");
}

template <class Io, Either<LoadCellSpec, LoadCellText> Cell>
void Keys(Io& io, Cell& c) {
  io.Map(
      "", "load_cell",
      "Load cell: measured tension with bias, noise, range, quantization or counts, and delay. A "
      "load cell "
      "measures spring and damper together, so controllers that use the elastic part receive the "
      "sum of both forces.");
  io("noise_n", c.noise_n, Bound::kNonNegative, "Standard deviation of the noise of each sample.");
  io("bias_n", c.bias_n, Bound::kNonNegative,
     "Standard deviation of each cell's constant error, drawn once per run.");
  io("gain_error", c.gain_error, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation of each cell's relative gain error, drawn once per run.");
  io("drift_n_per_s", c.drift_n_per_s, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation of each cell's zero drift rate, drawn once per run.");
  io("counts", c.counts);
  if constexpr (Io::kResolved) {
    io("min_n", c.min_n);
    io("max_n", c.max_n, kLimit);
  } else {
    io("range_n", c.range_n, "Measuring range, [least, greatest].", Example{"[0, 100]"});
    io("bits", c.bits, Bound{.least = 1, .most = 32},
       "Converter bits: the range has 2^bits - 1 quanta. Requires `range_n`.");
    io.Rule(R"("dependentRequired": {"bits": ["range_n"]})");
  }
  io("quantum_n", c.quantum_n, Bound::kNonNegative,
     "Quantum of the converter, instead of `bits`; 0: none.");
  io("delay_s", c.delay_s, Bound::kNonNegative,
     "Delay of readings, a whole number of sensor periods.");
}
void Check(const MapReader& map, LoadCellText& cell);

template <class Io, Either<EncoderSpec, EncoderText> Encoder>
void Keys(Io& io, Encoder& e) {
  io.Map("", "encoder", "Rest lengths measured in counts of the motor's encoder.");
  io("quantum_m", e.quantum_m, Bound::kNonNegative,
     "Change of the rest length per count; 0: no quantization.");
  if constexpr (!Io::kResolved) {
    io("counts_per_turn", e.counts_per_turn, Bound::kPositive,
       "Counts per turn of the spool, instead of `quantum_m`. Requires `spool_radius_m`.");
    io("spool_radius_m", e.spool_radius_m, Bound::kPositive,
       "Radius of the spool, to the cable's center line.");
    io("lines", e.lines, Bound{.least = 1, .most = 100'000},
       "Lines of a quadrature encoder on the motor's shaft, before the gear, instead of "
       "`quantum_m`. Requires `spool_radius_m`.");
    io("decoding", e.decoding, Bound{.least = 1, .most = 4},
       "Counted edges per line: 1, 2 or 4. With `lines`.");
    io("gear_ratio", e.gear_ratio, Bound::kPositive,
       "Turns of the shaft per turn of the spool. With `lines`.");
    io("index", e.index,
       "Whether the encoder has an index pulse, once per turn of the shaft. From the first pulse "
       "on, the error from `zero_error_m` is rounded to whole turns of the shaft. With `lines`.");
    io.Rule(R"("dependentRequired": {"counts_per_turn": ["spool_radius_m"], )"
            R"("lines": ["spool_radius_m"], "decoding": ["lines"], "gear_ratio": ["lines"], )"
            R"("index": ["lines"]}, "dependentSchemas": {"spool_radius_m": {"anyOf": )"
            R"([{"required": ["counts_per_turn"]}, {"required": ["lines"]}]}})");
    io.Rule(R"("not": {"required": ["decoding"], "properties": {"decoding": {"const": 3}}})");
  } else {
    io("index_m", e.index_m, LaterThan{0.0});
  }
  io("zero_error_m", e.zero_error_m, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation over the cables of the initial rest length error, drawn once per run.");
  io("gain_error", e.gain_error, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation over the cables of the relative error of the rest length per count, drawn "
     "once per run, as caused by a deviation of the spool radius.");
  io("delay_s", e.delay_s, Bound::kNonNegative,
     "Delay of readings, a whole number of sensor periods.");
}
void Check(const MapReader& map, EncoderText& encoder);

template <class Io, Either<SensorSpec, SensorText> Sensors>
void Keys(Io& io, Sensors& s) {
  io.Map("sensors", "sensors",
         "Sensors of the controllers (docs/theory/sensors.md). Without this key, controllers "
         "receive exact values.");
  io("period_s", s.period_s, Bound::kPositive,
     "Time between samples; the first is at t = 0. Controllers receive the last sample.");
  if constexpr (Io::kResolved) {
    io("load_cell", s.load_cell);
    io("encoder", s.encoder);
    io("length_from_tension", s.length_from_tension);
  } else {
    io("load_cell", s.load_cell_text);
    io("encoder", s.encoder_text);
    io("length", s.length_from_tension, kLengthSources,
       "Length of a cable. `exact`: the true length. `from_tension`: computed from rest length and "
       "tension, L + T / k, with the rate from differences of successive samples, as computed by "
       "the boards.");
  }
}
void Check(const MapReader& map, SensorText& sensors);

}  // namespace taut::description
