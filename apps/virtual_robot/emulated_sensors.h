/// Encoder on a motor's shaft. The load cells are those of `taut/boards.h`.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/virtual_robot/emulated_board.h"
#include "taut/boards.h"

namespace taut::virtual_robot {

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
  std::int64_t states() const { return state_; }  ///< Number of states since angle 0.

 private:
  static EncoderEdge Edge(std::int64_t state, Time at);

  double states_per_rad_, position_;
  std::int64_t state_;
};

}  // namespace taut::virtual_robot
