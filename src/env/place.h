/// Working memory of a thread, for all groups that it processes.
#pragma once

#include <memory>
#include <utility>

#include "base/assert.h"
#include "env/starts.h"
#include "sim/batch/batch_inside.h"

namespace taut::env {

struct Place {
  std::unique_ptr<Workplace> starts;  ///< Created when the thread prepares its first start.
  Aligned<char> scratch;              ///< Scratch memory for a step of any group's batch.
};

inline Aligned<char> ScratchFor(WorldBatch& batch) {
  const BatchInside::Impl& of = BatchInside::Of(batch);
  return AllocateScratch(*of.kernel, of.view);
}

/// Lends the thread's scratch memory to a group's batch for the lifetime of this object. The memory
/// is still in the core's cache from the previous group. Readers use the batch's memory.
class BorrowedScratch {
 public:
  BorrowedScratch(Place& place, WorldBatch& batch)
      : own_(BatchInside::Of(batch)), lent_(place.scratch) {
    TAUT_ASSERT(lent_ != nullptr);
    std::swap(own_.scratch[0], lent_);
  }
  ~BorrowedScratch() { std::swap(own_.scratch[0], lent_); }
  BorrowedScratch(const BorrowedScratch&) = delete;
  BorrowedScratch& operator=(const BorrowedScratch&) = delete;

 private:
  BatchInside::Impl& own_;
  Aligned<char>& lent_;
};

}  // namespace taut::env
