/// Deprecated names of taut/world_batch.h; the next release removes them.
#pragma once

#include "taut/world_batch.h"

namespace taut {

using Batch [[deprecated("WorldBatch, without controllers and events; or Simulation")]] =
    WorldBatch;
using BatchOptions [[deprecated("WorldBatchOptions")]] = WorldBatchOptions;

}  // namespace taut
