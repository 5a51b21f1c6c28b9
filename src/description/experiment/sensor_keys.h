/// The keys of what stands between a robot and its controllers (docs/theory/sensors.md).
#pragma once

#include "description/experiment/experiment_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

inline const Choices<bool> kLengthSources{{"exact", false}, {"from_tension", true}};

template <class Io>
void Keys(Io& io, Like<LoadCellCounts> auto& c) {
  io.Map(
      "", "load_cell.counts",
      "The cell's amplifier and converter, instead of a range and a quantum: whole counts from 0 "
      "on, rounded down, and the force that the board takes them for, gain * count + offset. The "
      "defaults are those of Tetraspine3 (the paper's eq. 7): `counts: {}`.");
  io("gain_n_per_count", c.gain_n_per_count, Bound::kPositive, "Force per count [N].");
  io("offset_n", c.offset_n, "The force of count 0.");
  io("bits", c.bits, Bound{.least = 1, .most = 32}, "Of the converter: it ends at 2^bits - 1.");
  io("saturation_count", c.saturation_count, Bound{.least = 1, .most = 2'000'000'000},
     "The count at which the amplifier ends.");
  io("noise_counts", c.noise_counts, Bound::kNonNegative,
     "Standard deviation of each sample, before it is rounded.");
}

template <class Io, Either<LoadCellSpec, LoadCellText> Cell>
void Keys(Io& io, Cell& c) {
  io.Map("", "load_cell",
         "Tensions are read with bias and noise, limited to a range, rounded to a quantum or as "
         "counts of a converter, and late. A cell cannot tell the spring from the damper: "
         "controllers that use the spring's part get the whole.");
  io("noise_n", c.noise_n, Bound::kNonNegative, "Standard deviation of each sample.");
  io("bias_n", c.bias_n, Bound::kNonNegative,
     "Standard deviation of each cell's constant error, drawn once a run.");
  io("gain_error", c.gain_error, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation of each cell's error of its gain, as a share of it, drawn once a run.");
  io("drift_n_per_s", c.drift_n_per_s, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation of the rate at which each cell's zero drifts, drawn once a run.");
  io("counts", c.counts);
  if constexpr (Io::kResolved) {
    io("min_n", c.min_n);
    io("max_n", c.max_n, kLimit);
  } else {
    io("range_n", c.range_n, "What the cell can tell, [least, greatest].", Example{"[0, 100]"});
    io("bits", c.bits, Bound{.least = 1, .most = 32},
       "Of the converter: the range in 2^bits - 1 quanta. Wants `range_n`.");
    io.Rule(R"("dependentRequired": {"bits": ["range_n"]})");
  }
  io("quantum_n", c.quantum_n, Bound::kNonNegative,
     "The converter's step itself, instead of `bits`; 0: none.");
  io("delay_s", c.delay_s, Bound::kNonNegative,
     "How late readings are, a whole number of sensor periods.");
}
void Check(const MapReader& map, LoadCellText& cell);

template <class Io, Either<EncoderSpec, EncoderText> Encoder>
void Keys(Io& io, Encoder& e) {
  io.Map("", "encoder", "Rest lengths are read in counts of the motor's encoder.");
  io("quantum_m", e.quantum_m, Bound::kNonNegative, "Rest length of a count; 0: exact.");
  if constexpr (!Io::kResolved) {
    io("counts_per_turn", e.counts_per_turn, Bound::kPositive,
       "Counts of a turn of the spool, instead of `quantum_m`; with `spool_radius_m`.");
    io("spool_radius_m", e.spool_radius_m, Bound::kPositive,
       "Radius of the spool to the cable's middle.");
    io("lines", e.lines, Bound{.least = 1, .most = 100'000},
       "Lines of a quadrature encoder on the motor's shaft, before the gear, instead of "
       "`quantum_m`; with `spool_radius_m`.");
    io("decoding", e.decoding, Bound{.least = 1, .most = 4},
       "Edges that are counted per line: 1, 2 or 4. With `lines`.");
    io("gear_ratio", e.gear_ratio, Bound::kPositive,
       "Turns of the shaft a turn of the spool. With `lines`.");
    io("index", e.index,
       "Whether the encoder has an index, once a turn of the shaft. From the first one on "
       "`zero_error_m` is a whole number of turns, the nearest. With `lines`.");
    io.Rule(R"("dependentRequired": {"counts_per_turn": ["spool_radius_m"], )"
            R"("lines": ["spool_radius_m"], "decoding": ["lines"], "gear_ratio": ["lines"], )"
            R"("index": ["lines"]}, "dependentSchemas": {"spool_radius_m": {"anyOf": )"
            R"([{"required": ["counts_per_turn"]}, {"required": ["lines"]}]}})");
    io.Rule(R"("not": {"required": ["decoding"], "properties": {"decoding": {"const": 3}}})");
  } else {
    io("index_m", e.index_m, LaterThan{0.0});
  }
  io("zero_error_m", e.zero_error_m, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation, over the cables, of the error of the rest length that counts begin with, "
     "drawn once a run.");
  io("gain_error", e.gain_error, LaterThan{0.0}, Bound::kNonNegative,
     "Standard deviation, over the cables, of the error of the rest length per count, as a share "
     "of "
     "it, drawn once a run: a spool of another radius.");
  io("delay_s", e.delay_s, Bound::kNonNegative,
     "How late readings are, a whole number of sensor periods.");
}
void Check(const MapReader& map, EncoderText& encoder);

template <class Io, Either<SensorSpec, SensorText> Sensors>
void Keys(Io& io, Sensors& s) {
  io.Map("sensors", "sensors",
         "What controllers see of the robot, docs/theory/sensors.md. Without this key they see "
         "exact values.");
  io("period_s", s.period_s, Bound::kPositive,
     "Time between samples; the first is at t = 0. Controllers see the last sample.");
  if constexpr (Io::kResolved) {
    io("load_cell", s.load_cell);
    io("encoder", s.encoder);
    io("length_from_tension", s.length_from_tension);
  } else {
    io("load_cell", s.load_cell_text);
    io("encoder", s.encoder_text);
    io("length", s.length_from_tension, kLengthSources,
       "A cable's length as it is, or worked out from rest length and tension, L + T / k, with its "
       "rate from successive samples, as a board must do it.");
  }
}
void Check(const MapReader& map, SensorText& sensors);

}  // namespace taut::description
