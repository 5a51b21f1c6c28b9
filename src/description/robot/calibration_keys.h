/// The keys of a calibration.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/head_keys.h"
#include "description/yaml/keys.h"
#include "taut/calibration.h"

namespace taut::description {

/// An entry of `cables:`.
struct CableCalibrationText {
  SourceRef at;
  bool good = true;
  Placed cable, measured;
  CableCalibration values;
};
template <class Io>
void Keys(Io& io, Like<CableCalibrationText> auto& c) {
  io.Map("cable", "cables", "What was measured of one cable. What is absent is as it was before.");
  io("cable", c.cable, kNeeded, "Which cable, by its name in the model; it has to have a motor.");
  io("measured", c.measured, kNeeded, Example{R"("2026-11-23")"},
     "The day on which it was measured.");
  io("how", c.values.how, "How it was measured, in a sentence.");
  io("load_cell_n_per_count", c.values.load_cell_n_per_count, Bound{.least = 0.001, .most = 10},
     "Force of a count of the load cell's converter.");
  io("load_cell_counts_at_zero", c.values.load_cell_counts_at_zero, Bound{.least = 0, .most = 1023},
     "What it shows without force.");
  io("encoder_m_per_count", c.values.encoder_m_per_count, Bound{.least = 1e-8, .most = 1e-3},
     "Cable that a count of the encoder winds in.");
  io("rest_length_at_reference_m", c.values.rest_length_at_reference_m,
     Bound{.least = 0, .most = 2}, "The cable's rest length where the encoder is at 0.");
  io("stiffness_n_per_m", c.values.stiffness_n_per_m, Bound{.least = 1, .most = 1e6},
     "Of cable, spring and frame in series.");
}
void Check(const MapReader& map, CableCalibrationText& cable);

struct CalibrationForm {
  static constexpr const char* kSchema = R"("const": "calibration")";
};
struct CalibrationFileText {
  Head<CalibrationForm> head;
  std::string name, description;
  std::vector<CableCalibrationText> cables;
};
template <class Io>
void Keys(Io& io, Like<CalibrationFileText> auto& s) {
  io.Map("", "Calibration", "What was measured of a robot's load cells, encoders and springs.");
  HeadKeys(
      io, s,
      {"Name of the calibration. Needed unless `base` has it.",
       "Which robot, who measured, with what.",
       "Another calibration, seen from this file's folder. This file then holds only what differs: "
       "each of its keys replaces the base's as a whole, except that `parameters` are merged by "
       "name.",
       R"("first_calibration.yaml")",
       "Named numbers for expressions in this file. They may refer to each other, in any order.",
       R"({"gain_n": "0.1567"})"});
  io("cables", s.cables, kNeeded, "What was measured, a cable each, in any order.");
}

}  // namespace taut::description
