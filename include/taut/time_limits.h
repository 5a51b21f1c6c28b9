/// Limits of time steps and simulated times, common to files, the command and the libraries.
#pragma once

namespace taut {

/// Shortest and longest step of an experiment [s]. Steps that end at a tick may be shorter.
inline constexpr double kShortestStep_s = 1e-9, kLongestStep_s = 1;

/// Longest simulated time [s]. Far beyond this time, a step no longer changes the time of a world.
inline constexpr double kLongestTime_s = 1e9;

}  // namespace taut
