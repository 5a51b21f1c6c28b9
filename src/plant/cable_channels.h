/// Table of a cable's channels in a trace, `cable/NAME/...`, with units and rows. Recorder,
/// sensors, environments and replays use it. To add a channel, add a line here and in
/// docs/formats/trace.md.
#pragma once

#include <cstddef>

#include "taut/plant.h"

namespace taut::plant {

struct CableChannel {
  const char* name;
  const char* unit;
  // Row with the values: cable c of lane j is at [c * lanes + j]. One of the two pointers is null.
  const double* ReadingRows::*reading;
  double* Commands::*command;
  bool sensed = false;  ///< Whether sensors also measure the quantity (`sensor/NAME/...`).
  /// Whether the channel is recorded only for cables with a tension set point.
  bool with_set_point = false;

  const double* Row(const ReadingRows& readings, const Commands& commands) const noexcept {
    return reading != nullptr ? readings.*reading : commands.*command;
  }
  double Value(const ReadingRows& readings, const Commands& commands, std::size_t cable,
               int lane) const noexcept {
    return Row(readings, commands)[cable * static_cast<std::size_t>(commands.lanes) +
                                   static_cast<std::size_t>(lane)];
  }
};

inline constexpr CableChannel kCableChannels[] = {
    {"tension_n", "N", &ReadingRows::tension_n, nullptr, true},
    {"elastic_n", "N", &ReadingRows::elastic_n, nullptr},
    {"length_m", "m", &ReadingRows::length_m, nullptr, true},
    {"rate_m_per_s", "m/s", &ReadingRows::rate_m_per_s, nullptr, true},
    {"rest_length_m", "m", &ReadingRows::rest_length_m, nullptr, true},
    {"target_rest_length_m", "m", nullptr, &Commands::rest_length_m},
    {"setpoint_n", "N", nullptr, &Commands::set_point_n, false, true},
    {"velocity_input_m_per_s", "m/s", nullptr, &Commands::velocity_input_m_per_s, false, true},
};

}  // namespace taut::plant
