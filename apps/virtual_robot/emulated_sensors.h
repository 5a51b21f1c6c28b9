/// Sensor models: load cell with amplifier at a converter input, and encoder on the motor's shaft.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/virtual_robot/emulated_board.h"

namespace taut::virtual_robot {

/// Values of the paper's robot (Mirletz, Park, Quinn, SunSpiral 2015, eq. 7): force = n_per_count
/// (code - zero_counts).
struct LoadCellOptions {
  double n_per_count = 0.1567;
  double zero_counts = 4.9363 / 0.1567;  ///< 31.5
  /// Limit of the amplifier with its 5 V supply, below the converter's range: 111.2 N.
  double saturation_counts = 741;
  double noise_counts = 0.7;  ///< Standard deviation of the noise of a conversion (assumed).
};

/// Returns the converter's code for a force, with a noise of `noise` standard deviations.
int LoadCellCode(const LoadCellOptions& options, double force_n, double noise);

struct EncoderOptions {
  int lines = 16;  ///< Four states each: 64 per turn of the shaft.
};

/// Follows a shaft and computes the edges of its lines.
class Encoder {
 public:
  Encoder(const EncoderOptions& options, double angle_rad);

  /// Turns the shaft to `angle_rad` at a constant rate within `duration`. Returns the edges with
  /// their times, counted from `at`.
  std::vector<EncoderEdge> Turn(double angle_rad, Time duration, Time at);
  /// Returns the present levels of the lines.
  EncoderEdge Now(Time at) const { return Edge(state_, at); }
  std::int64_t states() const { return state_; }  ///< Counted from angle 0.

 private:
  static EncoderEdge Edge(std::int64_t state, Time at);

  double states_per_rad_, position_;
  std::int64_t state_;
};

}  // namespace taut::virtual_robot
