/// What a thread has for itself, whichever group it works on.
#pragma once

#include <memory>
#include <utility>

#include "base/assert.h"
#include "env/starts.h"
#include "sim/batch/batch_inside.h"

namespace taut::env {

struct Place {
  std::unique_ptr<Workplace> starts;  ///< Made when the thread first prepares one.
  Aligned<char> scratch;              ///< For a step of any group's batch.
};

inline Aligned<char> ScratchFor(Batch& batch) {
  const BatchInside::Impl& of = BatchInside::Of(batch);
  return AllocateAligned<char>(of.kernel->scratch_bytes(of.view));
}

/// While it lives a group's batch steps in the thread's scratch, which is still in the core's cache
/// from the group before; its own is for who reads.
class BorrowedScratch {
 public:
  BorrowedScratch(Place& place, Batch& batch) : own_(BatchInside::Of(batch)), lent_(place.scratch) {
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
