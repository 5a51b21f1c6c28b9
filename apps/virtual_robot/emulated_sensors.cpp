#include "apps/virtual_robot/emulated_sensors.h"

#include <algorithm>
#include <cmath>

namespace taut::virtual_robot {
namespace {

constexpr double kTurn = 6.283185307179586476925286766559;

}  // namespace

int LoadCellCode(const LoadCellOptions& options, double force_n, double noise) {
  const double counts =
      options.zero_counts + force_n / options.n_per_count + noise * options.noise_counts;
  // The first code begins half a count above zero (data sheet, "ADC Accuracy Definitions").
  const double code = std::floor(std::min(counts, options.saturation_counts) + 0.5);
  return static_cast<int>(std::clamp(code, 0.0, 1023.0));
}

Encoder::Encoder(const EncoderOptions& options, double angle_rad)
    : states_per_rad_(4.0 * options.lines / kTurn),
      position_(angle_rad * states_per_rad_),
      state_(static_cast<std::int64_t>(std::floor(position_))) {}

EncoderEdge Encoder::Edge(std::int64_t state, Time at) {
  const auto phase = static_cast<unsigned>(state & 3);  // A leads B for increasing angle
  return {at, phase == 1 || phase == 2, phase >= 2};
}

std::vector<EncoderEdge> Encoder::Turn(double angle_rad, Time duration, Time at) {
  const double begin = position_;
  position_ = angle_rad * states_per_rad_;
  const auto end = static_cast<std::int64_t>(std::floor(position_));
  std::vector<EncoderEdge> edges;
  while (state_ != end) {
    const bool up = state_ < end;
    const double border = static_cast<double>(up ? state_ + 1 : state_);
    const double part = std::clamp((border - begin) / (position_ - begin), 0.0, 1.0);
    state_ += up ? 1 : -1;
    edges.push_back(Edge(state_, at + static_cast<Time>(part * static_cast<double>(duration))));
  }
  return edges;
}

}  // namespace taut::virtual_robot
