/// Threads that wait for work which splits into numbered pieces.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace taut::base {

class ThreadPool {
 public:
  /// `threads` includes the caller; 0 means one a core.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const noexcept { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(thread) once on every thread, 0 being the caller, and waits for all. Allocates
  /// nothing.
  template <class Work>
  void Run(Work& work) {
    RunErased(&work, [](void* context, int thread) { (*static_cast<Work*>(context))(thread); });
  }

 private:
  using Call = void (*)(void*, int);
  void RunErased(void* context, Call call);
  void Wait(int thread);

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable start_, done_;
  void* context_ = nullptr;
  Call call_ = nullptr;
  std::uint64_t round_ = 0;
  int busy_ = 0;
  bool stop_ = false;
};

}  // namespace taut::base
