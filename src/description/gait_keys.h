/// The keys of a gait file, and what of them is in a resolved experiment.
#pragma once

#include "description/gait_parts.h"
#include "description/head_keys.h"
#include "description/keys.h"

namespace taut::description {

/// A key whose unit follows what the gait drives.
constexpr Spellings Driven(const char* of_velocity, const char* of_rest_length) {
  return {{of_velocity, of_rest_length},
          {"a gait with `drives: velocity`", "a gait with `drives: rest_length`"}};
}

template <class Io>
void Keys(Io& io, Like<SineWave> auto& w) {
  io.Map("waves", "sine.waves", "The wave of some cables.",
         R"({"name": "front_top", "cables": ["outer", "top"], "amplitude_m_per_s": 0.06, )"
         R"("offset_m_per_s": -0.06, "phase_per_segment_rad": "pi / 3"})");
  io("name", w.name, kNeeded, kName,
     "Name of the wave; its numbers are called after it, such as sine.front_top.phase_rad.");
  io("cables", w.cables, kNeeded,
     "Which cables, as in an experiment: by name, by tag, by a list of tags, or by a list of such "
     "lists.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), w.amplitude, kNeeded,
     "Amplitude; negative turns the wave round.");
  io("phase_rad", w.phase_rad, "Phase at t = 0.");
  io(Driven("offset_m_per_s", "offset_m"), w.offset, "Constant part.");
  io("phase_per_segment_rad", w.phase_per_segment_rad,
     "Added to the phase once for every segment further back: cables whose names end in _1 get "
     "none, _2 once, _3 twice. A travelling wave on a spine of any length.");
  io("frequency_hz", w.frequency_hz, Bound::kNonNegative, "A frequency of its own.");
}
template <class Io>
void Keys(Io& io, Like<SineGait> auto& s) {
  io.Map("sine", "sine",
         "Sine waves: signal = offset + amplitude cos(2 pi f t + phase). One of `sine`, `cpg` and "
         "`table` must be there.");
  io("frequency_hz", s.frequency_hz, kNeeded, Bound::kNonNegative,
     "f of all waves that have none of their own.");
  io("waves", s.waves, kNeeded,
     "The waves; a cable has one at most. Cables without one have a signal of 0.");
}
void Check(const MapReader& map, SineGait& sine);

template <class Io>
void Keys(Io& io, Like<CouplingGroup> auto& g) {
  io.Map("groups", "cpg.groups", "One group of couplings.",
         R"({"name": "same.outer_top.inner_top", "weight_per_m": 20, "phase_rad": "pi"})");
  io("name", g.name, kNeeded,
     "As `taut check --couplings` names it, such as behind.outer_top.inner_left: an outer_top is "
     "pulled by an inner_left of the joint behind, and the other way round by roles.");
  io(Driven("weight_per_m", "weight_per_m_s"), g.weight, kNeeded,
     "w: times the neighbour's amplitude it is a rate in rad/s.");
  io("phase_rad", g.phase_rad, kNeeded,
     "phi: how far the neighbour's phase is pulled ahead of the oscillator's own.");
}
template <class Io>
void Keys(Io& io, Like<CpgFeedback> auto& f) {
  io.Map("", "cpg.feedback",
         "A cable's tension acts on the phase of its oscillator: theta' gets gain (T - reference) "
         "cos theta. None if absent.",
         R"({"gain_rad_per_n_s": 0.1, "reference_n": 15})");
  io("gain_rad_per_n_s", f.gain_rad_per_n_s, kNeeded, "Gain.");
  io("reference_n", f.reference_n, "The tension that changes nothing.");
}
template <class Io>
void Keys(Io& io, Like<CpgGait> auto& c) {
  io.Map("cpg", "cpg",
         "A central pattern generator (paper eq. 4-6): an oscillator a cable, coupled to every "
         "other whose cable shares a rigid body with its own. `taut check MODEL --couplings` shows "
         "the network, `taut gait create MODEL` writes a file with all its groups.");
  io("frequency_hz", c.frequency_hz, kNeeded, "Frequency of each oscillator left to itself.");
  io(Driven("amplitude_m_per_s", "amplitude_m"), c.amplitude, kNeeded, Bound::kNonNegative,
     "Amplitude R that each oscillator grows to.");
  io("convergence_per_s", c.convergence_per_s, Bound::kPositive,
     "How fast it does so: a of the critically damped amplitude.");
  io("integrator_step_s", c.integrator_step_s, kFixed, Bound::kPositive,
     "Longest step of the network's integrator; the gait's period is divided into equal steps. It "
     "has nothing to do with the step of the simulation.");
  io("symmetry", c.symmetry, kSymmetries,
     "Which couplings share a weight and a phase. `segments`: those between the same two roles "
     "(the cable's name without its number) with the same one in front. `index`: by NTRT's rule, "
     "from positions in `order`. `none`: each has its own.");
  io("order", c.order,
     "The cables with an oscillator, by name. All cables that have an actuator, in the model's "
     "order, if absent.");
  io("inverted", c.inverted, "Cables whose signal is the negative of their oscillator's.");
  io("feedback", c.feedback);
  io("groups", c.groups,
     "Weight and phase of every group of couplings. None that the robot needs may be missing.");
}
void Check(const MapReader& map, CpgGait& cpg);

struct RowsForm {
  static constexpr const char* kSchema =
      R"("type": "array", "title": "[[time_s, signal, ...], ...]", )"
      R"("items": {"type": "array", "items": {"$ref": "#/$defs/number"}})";
};
struct TableText : TableGait {
  Raw<FileForm> file;
  Raw<RowsForm> rows_text;
  std::vector<std::string> files;  ///< That were read.
};
template <class Io, Either<TableGait, TableText> Table>
void Keys(Io& io, Table& t) {
  io.Map("table", "table",
         "The signals from a table: `taut gait export` writes such files. Either `file`, or "
         "`cables` and `rows`.",
         R"({"file": "commands.csv", "repeat_from_s": 0})");
  if constexpr (!Io::kResolved) {
    io.Rule(R"("oneOf": [{"required": ["rows", "cables"]}, {"required": ["file"]}])");
    io("file", t.file,
       "A text file, seen from this file's folder: a line `time_s,outer_top_1_m_per_s,...` "
       "(`outer_top_1_m` with `drives: rest_length`), then a line a row; lines that begin with # "
       "are "
       "comments.");
  }
  io("cables", t.cables, "Cables by name, one a column.");
  if constexpr (Io::kResolved) {
    io("time_s", t.time_s);
    io("rows", t.rows);
    io("linear", t.linear);
  } else {
    io("rows", t.rows_text,
       "Time and a signal for each cable, in m/s or m; the first time is 0, and times rise.");
    io("interpolation", t.linear, kInterpolations,
       "Between rows: `hold` keeps the last one, `linear` goes straight to the next.");
  }
  io("repeat_from_s", t.repeat_from_s, kFixed, Bound::kNonNegative,
     "At the last row go on from here, again and again. Without it the last row holds.");
}
void Check(const MapReader& map, TableText& table);

struct GaitForm {
  static constexpr const char* kSchema = R"("const": "gait")";
};
struct GaitText : GaitSpec {
  Head<GaitForm> head;
  std::optional<TableText> table_text;
};
template <class Io, Either<GaitSpec, GaitText> Gait>
void Keys(Io& io, Gait& g) {
  io.Map("", "Gait file",
         "What moves a robot: signals to its cables, from sine waves, from a network of "
         "oscillators or from a table. A signal is a velocity V0 that impedance control adds, or a "
         "length that is added to a rest length (`drives`). An experiment plays a gait by a "
         "controller's `velocity_input` or `rest_length_input`; equations are in "
         "docs/theory/gaits.md.");
  HeadKeys(io, g,
           {"Name of the gait. Needed unless `base` has it.",
            "What the gait does and where it comes from, in a sentence or two.",
            "Another gait file, seen from this file's folder. This file then holds only what "
            "differs: each of its keys replaces the base's as a whole, except that `parameters` "
            "are merged by name.",
            R"("hand_tuned_sine.yaml")",
            "Named numbers for expressions in this file. They may refer to each other, in any "
            "order.",
            R"({"amplitude_m_per_s": 0.06})"});
  io("drives", g.drives, kDrives, kLater,
     "What the signals are, and with that the unit of amplitudes, offsets and tables. `velocity`: "
     "V0 of impedance control, in m/s. `rest_length`: what is added to rest lengths, in m.");
  io.SpeltBy("drives", {static_cast<int>(g.drives), WhoDrives(g.drives)});
  io.OneOf({"sine", "cpg", "table"});
  io("sine", g.sine);
  io("cpg", g.cpg);
  if constexpr (Io::kResolved) {
    io("table", g.table);
  } else {
    io("table", g.table_text);
  }
}

}  // namespace taut::description
