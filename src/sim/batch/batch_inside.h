/// A batch's inside, for those outside of this folder that must have it.
#pragma once

#include "sim/batch/batch_impl.h"

namespace taut {

struct BatchInside {
  using Impl = Batch::Impl;
  static Impl& Of(Batch& batch) noexcept { return *batch.impl_; }
  /// From now on the batch steps with time stamps between its stages (benchmarks/stage_watch.h).
  static void Watch(Batch& batch);
};

}  // namespace taut
