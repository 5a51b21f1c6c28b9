/// Timer that determines when a writer must write the rows in its memory.
#pragma once

#include <algorithm>
#include <chrono>

namespace taut::trace {

/// The first row is due at once, so that a run that is killed early leaves some data. The waits
/// then double up to half a second: half of the interface's guarantee, because the clock is checked
/// again only at the next row. The content of the file does not depend on the clock.
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
