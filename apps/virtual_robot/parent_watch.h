/// Ends the program when its parent process ends.
#pragma once

#include <atomic>
#include <thread>

namespace taut::virtual_robot {

/// Sets `stop`, which must outlive the object, within 20 ms of the end of the process that was the
/// parent at construction. The signal at the parent's death (prctl) would also arrive when the
/// thread that started this program ends.
class ParentWatch {
 public:
  explicit ParentWatch(std::atomic<bool>& stop);

 private:
  std::jthread thread_;
};

}  // namespace taut::virtual_robot
