/// Calibration files: what was measured of a robot's load cells, encoders and springs
/// (docs/formats/calibration.md).
///
/// Threads: any number may call these functions at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

/// Of one cable; what was not measured is absent.
struct CableCalibration {
  std::string cable;
  std::string measured;  ///< The day, as 2026-11-23.
  std::string how;       ///< In a sentence.
  std::optional<double> load_cell_n_per_count{}, load_cell_counts_at_zero{};
  std::optional<double> encoder_m_per_count{}, rest_length_at_reference_m{};
  std::optional<double> stiffness_n_per_m{};
};

struct Calibration {
  std::string name, description;
  std::vector<CableCalibration> cables;
  std::vector<std::string> files{};  ///< That were read, the file itself first.
};

/// Reads a calibration of a robot with these actuated cables; empty: whatever they are called.
/// Nothing if there was any error.
std::optional<Calibration> LoadCalibration(const std::string& path,
                                           const std::vector<std::string>& cables,
                                           Diagnostics& out);

/// The text of a file that `LoadCalibration` reads as the same numbers.
std::string CalibrationYaml(const Calibration& calibration);

}  // namespace taut
