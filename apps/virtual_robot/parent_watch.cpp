#include "apps/virtual_robot/parent_watch.h"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace taut::virtual_robot {
namespace {

constexpr std::chrono::milliseconds kWatchPeriod{20};

}  // namespace

ParentWatch::ParentWatch(std::atomic<bool>& stop)
    : thread_([&stop, parent = getppid()](const std::stop_token& ended) {
        std::mutex mutex;
        std::condition_variable_any wake;
        std::unique_lock lock(mutex);
        while (!ended.stop_requested() && !stop) {
          if (getppid() != parent) stop = true;
          wake.wait_for(lock, ended, kWatchPeriod, [] { return false; });
        }
      }) {}

}  // namespace taut::virtual_robot
