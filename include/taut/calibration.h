/// Calibration files: measured constants of a robot's load cells, encoders and springs
/// (docs/formats/calibration.md).
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

/// Calibration of one cable. Quantities without a measurement are absent.
struct CableCalibration {
  std::string cable;
  std::string measured;  ///< Date of the measurement, for example 2026-11-23.
  std::string how;       ///< Method of the measurement, in a sentence.
  std::optional<double> load_cell_n_per_count{}, load_cell_counts_at_zero{};
  std::optional<double> encoder_m_per_count{}, rest_length_at_reference_m{};
  std::optional<double> stiffness_n_per_m{};
};

struct Calibration {
  std::string name, description;
  std::vector<CableCalibration> cables;
  std::vector<std::string> files{};  ///< All files read; the calibration file is first.
};

/// Reads the calibration file of a robot. `cables`: names of its actuated cables; an empty list
/// allows any cable name. On an error, returns nothing and adds diagnostics.
std::optional<Calibration> LoadCalibration(const std::string& path,
                                           const std::vector<std::string>& cables,
                                           Diagnostics& out);

/// Returns the text of a calibration file. `LoadCalibration` reads exactly the same numbers from
/// it.
std::string CalibrationYaml(const Calibration& calibration);

}  // namespace taut
