/// The sensors of a motor's cable: a load cell with its amplifier at an input of the converter, and
/// an encoder on the motor's shaft.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/virtual_robot/board.h"

namespace taut::virtual_robot {

/// Numbers of the robot of the paper (Mirletz, Park, Quinn, SunSpiral 2015, eq. 7):
/// force = n_per_count (code - zero_counts).
struct LoadCellOptions {
  double n_per_count = 0.1567;
  double zero_counts = 4.9363 / 0.1567;  ///< 31.5
  /// Where the amplifier on its 5 V ends, not the converter: 111.2 N.
  double saturation_counts = 741;
  double noise_counts = 0.7;  ///< Standard deviation of a conversion [?].
};

/// What the converter makes of a force, with noise `noise` standard deviations away.
int LoadCellCode(const LoadCellOptions& options, double force_n, double noise);

struct EncoderOptions {
  int lines = 16;  ///< Four states each: 64 a turn of the shaft.
};

/// Follows a shaft and says when its lines change.
class Encoder {
 public:
  Encoder(const EncoderOptions& options, double angle_rad);

  /// The shaft has turned to `angle_rad` at a steady rate from `from` to `to`; the changes come as
  /// late as they did in between, from `at` on.
  std::vector<EncoderEdge> Turn(double angle_rad, Time duration, Time at);
  /// The lines as they are.
  EncoderEdge Now(Time at) const { return Edge(state_, at); }
  std::int64_t states() const { return state_; }  ///< Counted from angle 0.

 private:
  static EncoderEdge Edge(std::int64_t state, Time at);

  double states_per_rad_, position_;
  std::int64_t state_;
};

}  // namespace taut::virtual_robot
