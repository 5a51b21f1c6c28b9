/// Helpers for tests of one board with the probe's program
#pragma once

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tests/virtual_robot/probe_fixture.h"

namespace taut::virtual_robot {

inline constexpr Time kBoot = 5 * kMillisecond;  // the probe is running by then

/// Runs the board in the same steps as the robot.
inline void RunTo(Board& board, Time until) {
  for (Time now = board.now(); now < until; now += 20 * kMicrosecond) {
    board.RunUntil(std::min(now + 20 * kMicrosecond, until));
  }
}

/// Returns edges of `count` states from state 0, evenly spread over [from, to].
inline std::vector<EncoderEdge> Edges(int count, Time from, Time to) {
  std::vector<EncoderEdge> edges;
  for (int i = 1; i <= std::abs(count); ++i) {
    const unsigned phase = static_cast<unsigned>(count > 0 ? i : -i) & 3U;
    edges.push_back(
        {from + (to - from) * i / std::abs(count), phase == 1 || phase == 2, phase >= 2});
  }
  return edges;
}

}  // namespace taut::virtual_robot
