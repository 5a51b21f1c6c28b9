/// Timer that determines when a writer must write buffered rows to the file.
#pragma once

#include <algorithm>
#include <chrono>

namespace taut::trace {

/// Writes the first row at once, so that a run leaves data even if it is killed early. The interval
/// then doubles up to half a second: half of the time that `TraceWriter` guarantees, because the
/// clock is checked only at rows. The content of the file does not depend on the clock.
class FlushClock {
 public:
  bool due() const { return Clock::now() - flushed_ >= wait_; }

  void Flushed() {
    flushed_ = Clock::now();
    wait_ = std::clamp(2 * wait_, kFirstWait, kLongestWait);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kFirstWait{50}, kLongestWait{500};

  std::chrono::milliseconds wait_{0};
  Clock::time_point flushed_;
};

}  // namespace taut::trace
