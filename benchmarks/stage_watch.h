/// Time stamps between the stages of a step. The library's step has none: here the step's source is
/// compiled a second time, with a watch.
#pragma once

#include <cstdint>

#include "sim/batch/batch_inside.h"

namespace taut {
namespace sim {

inline constexpr int kStages = 8;
inline constexpr const char* kStageNames[kStages] = {"start",   "kinematics", "cables",    "kick",
                                                     "collide", "solve",      "integrate", "judge"};

/// Clock ticks of the processor spent in each stage so far, by batches with one thread.
extern std::uint64_t g_stage_ticks[kStages];

/// Returns whether the step with a watch was compiled for batches of so many lanes
/// (TAUT_WATCHED_SETS).
bool HasWatch(int lanes);

extern const Kernel kWatchedScalar, kWatchedNeon, kWatchedSse2, kWatchedAvx2, kWatchedAvx512;

}  // namespace sim
}  // namespace taut
