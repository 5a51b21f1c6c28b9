/// Access to the implementation of a batch, for code outside of this folder.
#pragma once

#include "sim/batch/batch_impl.h"

namespace taut {

struct BatchInside {
  using Impl = WorldBatch::Impl;
  static Impl& Of(WorldBatch& batch) noexcept { return *batch.impl_; }
  /// Enables time stamps between the stages of the steps of a batch (benchmarks/stage_watch.h).
  static void Watch(WorldBatch& batch);
};

}  // namespace taut
