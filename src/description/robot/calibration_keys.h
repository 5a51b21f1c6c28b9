/// Keys of calibration files.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/head_keys.h"
#include "description/yaml/keys.h"
#include "taut/calibration.h"

namespace taut::description {

/// Entry of `cables:`.
struct CableCalibrationText {
  SourceRef at;
  bool good = true;
  Placed cable, measured;
  CableCalibration values;
};
template <class Io>
void Keys(Io& io, Like<CableCalibrationText> auto& c) {
  io.Map("cable", "cables",
         "Measured values of one cable. A missing value leaves the board's parameter unchanged.");
  io("cable", c.cable, kNeeded, "Name of a cable with a motor.");
  io("measured", c.measured, kNeeded, Example{R"("2026-11-23")"}, "Date of the measurement.");
  io("how", c.values.how, "Method of the measurement, in a sentence.");
  io("load_cell_n_per_count", c.values.load_cell_n_per_count, Bound{.least = 0.001, .most = 10},
     "Force per count of the load cell's converter.");
  io("load_cell_counts_at_zero", c.values.load_cell_counts_at_zero, Bound{.least = 0, .most = 1023},
     "Count of the load cell without force.");
  io("encoder_m_per_count", c.values.encoder_m_per_count, Bound{.least = 1e-8, .most = 1e-3},
     "Length of cable per count of the encoder.");
  io("rest_length_at_reference_m", c.values.rest_length_at_reference_m,
     Bound{.least = 0, .most = 2}, "Rest length of the cable at encoder count 0.");
  io("stiffness_n_per_m", c.values.stiffness_n_per_m, Bound{.least = 1, .most = 1e6},
     "Stiffness of cable, spring and frame in series.");
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
  io.Map("", "Calibration",
         "A calibration contains measured values of a robot's load cells, encoders and springs.");
  HeadKeys(
      io, s,
      {"Name of the calibration. Required unless the `base` file has it.",
       "Robot, person and instruments of the measurement.",
       "Another calibration to inherit from, relative to this file's folder. Each key of this file "
       "replaces the whole key of the base, except that `parameters` are merged by name.",
       R"("first_calibration.yaml")",
       "Named numbers for expressions in this file. Parameters may refer to each other, in any "
       "order.",
       R"({"gain_n": "0.1567"})"});
  io("cables", s.cables, kNeeded, "Measured values, one entry per cable, in any order.");
}

}  // namespace taut::description
