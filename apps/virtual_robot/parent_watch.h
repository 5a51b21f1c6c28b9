/// Ends a program with the one that started it.
#pragma once

#include <atomic>
#include <thread>

namespace taut::virtual_robot {

/// Sets `stop`, which outlives it, within 20 ms of the end of the process that was the parent when
/// this was made. A signal at the parent's death (prctl) would come with the end of the thread that
/// started this program, too.
class ParentWatch {
 public:
  explicit ParentWatch(std::atomic<bool>& stop);

 private:
  std::jthread thread_;
};

}  // namespace taut::virtual_robot
