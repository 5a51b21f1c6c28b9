/// Cables of worlds side by side, as controllers see them.
#pragma once

namespace taut::plant {

/// Cable c of lane j is at [c * lanes + j].
struct ReadingRows {
  const double* rest_length_m = nullptr;
  const double* length_m = nullptr;
  const double* rate_m_per_s = nullptr;
  const double* tension_n = nullptr;
  const double* elastic_n = nullptr;
  const double* stiffness_n_per_m = nullptr;
};

}  // namespace taut::plant
