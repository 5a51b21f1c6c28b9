/// When the rows that a writer holds in memory are due to be written.
#pragma once

#include <algorithm>
#include <chrono>

namespace taut::trace {

/// The first row is due at once, so that a run that is killed early has left something. The waits
/// then double up to half a second: half of what the interface promises, because the next look at
/// the clock is at the next row. What is written is the same whatever the clock says.
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
