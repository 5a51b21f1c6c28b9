/// Gaits for the robot of experiment_fixture.h
#pragma once

#include <string>
#include <utility>

namespace taut::test {

inline constexpr const char* kSine = R"(taut: 1
kind: gait
name: waves
parameters: {slow_hz: 0.5}
sine:
  frequency_hz: slow_hz
  waves:
    - {name: a, cables: left, amplitude_m_per_s: -0.08, phase_rad: pi / 2, offset_m_per_s: 0.01}
    - {name: b, cables: [driven, back], amplitude_m_per_s: 0.1, frequency_hz: 2 * slow_hz}
)";

inline constexpr const char* kCpg = R"(taut: 1
kind: gait
name: pair
cpg:
  frequency_hz: 0.75
  amplitude_m_per_s: 0.1
  symmetry: none
  groups:
    - {name: left.right, weight_per_m: 20, phase_rad: 0.1}
    - {name: right.left, weight_per_m: 10, phase_rad: -0.1}
)";

inline constexpr const char* kTable = R"(taut: 1
kind: gait
name: table
table:
  cables: [left, right]
  rows: [[0, 0.1, -0.1], [0.5, 0.2, -0.2]]
)";

/// Returns the gait with the same numbers, in the units of a gait that drives rest lengths.
inline std::string WithLengths(std::string text) {
  for (const auto& [velocity, length] :
       {std::pair("amplitude_m_per_s", "amplitude_m"), std::pair("offset_m_per_s", "offset_m"),
        std::pair("weight_per_m:", "weight_per_m_s:")}) {
    const std::string from = velocity, to = length;
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) {
      text.replace(at, from.size(), to);
    }
  }
  return text.replace(text.find("kind: gait\n"), 11, "kind: gait\ndrives: rest_length\n");
}

}  // namespace taut::test
