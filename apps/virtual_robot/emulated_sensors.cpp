#include "apps/virtual_robot/emulated_sensors.h"

#include <algorithm>
#include <cmath>

namespace taut::virtual_robot {
namespace {

constexpr double kTurn = 6.283185307179586476925286766559;

}  // namespace

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
