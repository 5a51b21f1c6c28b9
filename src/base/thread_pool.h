/// Thread pool for work that is divided into numbered pieces.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace taut::base {

/// Waking a thread takes longer than stepping a few worlds. Therefore an idle thread spins for some
/// tens of microseconds, yielding its core, before it sleeps. With more threads than cores, it
/// sleeps immediately.
class ThreadPool {
 public:
  /// `threads` includes the caller; 0: one per core. If the system cannot start more threads,
  /// throws std::system_error with the number of the thread.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const noexcept { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(thread) on the caller, which is thread 0, and at most once on each other thread
  /// after it wakes. Returns when all started calls have returned. `Run` does not wait for late
  /// threads, so `work` must distribute the pieces dynamically. Allocates no memory. Only one
  /// caller at a time. If calls throw, the first exception is rethrown on the caller after all
  /// calls have returned; pieces that no thread has begun may then be omitted.
  template <class Work>
  void Run(Work& work) {
    RunErased(&work, [](void* context, int thread) { (*static_cast<Work*>(context))(thread); });
  }

  /// Calls work(thread, piece) once for each piece from 0 to count - 1. Each thread starts with its
  /// share of the pieces, always the same one, since their data are still in the cache of its core.
  /// Then it takes pieces from other threads (work stealing).
  template <class Work>
  void ForEach(std::size_t count, Work& work) {
    if (count == 1) return work(0, 0);  // no other thread is needed
    const std::size_t threads = shares_.size();
    for (std::size_t t = 0; t < threads; ++t) {
      shares_[t].next.store(count * t / threads, std::memory_order_relaxed);
      shares_[t].end = count * (t + 1) / threads;
    }
    auto take = [&](int thread) {
      for (std::size_t k = 0; k < threads; ++k) {
        Share& share = shares_[(static_cast<std::size_t>(thread) + k) % threads];
        for (;;) {
          const std::size_t piece = share.next.fetch_add(1, std::memory_order_relaxed);
          if (piece >= share.end) break;
          work(thread, piece);
        }
      }
    };
    Run(take);
  }

 private:
  using Call = void (*)(void*, int);
  /// Share of the pieces for one thread, on its own cache line.
  struct alignas(64) Share {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
  };

  void RunErased(void* context, Call call);
  void Work(int thread);
  /// Calls the work of the round; stores the first exception for the caller.
  void Guarded(int thread) noexcept;
  void Stop() noexcept;
  /// Waits until `good(state_)` is true, first spinning, then sleeping. Returns `state_`.
  template <class Good>
  std::uint64_t WaitUntil(const Good& good, std::atomic<int>& sleepers,
                          std::condition_variable& bell);
  /// Wakes sleeping threads after a change of `state_`.
  void Ring(const std::atomic<int>& sleepers, std::condition_variable& bell);

  /// Bits from 32: number of the round. `kOpen`: threads may join it. `kStop`: the pool ends. Bits
  /// below (`kJoined`): number of threads that are working on the round.
  std::atomic<std::uint64_t> state_{0};
  static constexpr std::uint64_t kOpen = 1u << 30, kStop = 1u << 31, kJoined = kOpen - 1;

  // Work of the round. Written before the round opens; read by threads that have joined.
  void* context_ = nullptr;
  Call call_ = nullptr;
  std::exception_ptr failed_;  ///< Protected by `mutex_` until all threads have returned.

  bool spins_ = false;
  std::mutex mutex_;  ///< Protects `failed_` and the transition to sleep.
  std::condition_variable start_, done_;
  std::atomic<int> idle_sleepers_{0}, caller_sleeps_{0};
  std::vector<Share> shares_;  ///< One per thread.
  std::vector<std::thread> workers_;
};

}  // namespace taut::base
