/// Time at which the threads of an environment pause in a long period, so that the caller can poll
/// `EnvOptions::keep_going`.
#pragma once

#include <chrono>

namespace taut::env {

class Deadline {
 public:
  /// `polls`: false for a deadline that is never reached.
  explicit Deadline(bool polls) : polls_(polls) {
    if (polls) end_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
  }
  bool polls() const noexcept { return polls_; }
  bool Reached() const { return polls_ && std::chrono::steady_clock::now() >= end_; }

 private:
  bool polls_;
  std::chrono::steady_clock::time_point end_{};
};

}  // namespace taut::env
