/// Thread pool for work that is split into numbered pieces.
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

/// Waking a thread takes longer than stepping a few worlds, so an idle thread spins for some tens
/// of microseconds before it sleeps, and yields its core meanwhile. With more threads than cores it
/// sleeps at once.
class ThreadPool {
 public:
  /// `threads` includes the caller; 0 means one per core. Throws std::system_error with the number
  /// of the thread if the system cannot start more threads.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const noexcept { return static_cast<int>(workers_.size()) + 1; }

  /// Calls work(thread) on the caller, which is thread 0, and at most once on each other thread,
  /// once it is awake; returns when all calls that began have returned. It does not wait for late
  /// threads, so `work` must distribute the pieces dynamically. Allocates nothing. One caller at a
  /// time. If calls throw, rethrows the first exception on the caller after all have returned;
  /// pieces that no thread has begun by then may be left out.
  template <class Work>
  void Run(Work& work) {
    RunErased(&work, [](void* context, int thread) { (*static_cast<Work*>(context))(thread); });
  }

  /// Calls work(thread, piece) once for each piece from 0 to count - 1. A thread begins with its
  /// share of the pieces, the same ones each time (their data are still in that core's cache), and
  /// then takes pieces that others have not begun (work stealing).
  template <class Work>
  void ForEach(std::size_t count, Work& work) {
    if (count == 1) return work(0, 0);  // no other thread needs to wake
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
  /// Share of pieces of a thread; on a separate cache line.
  struct alignas(64) Share {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
  };

  void RunErased(void* context, Call call);
  void Work(int thread);
  /// Calls the round's work; keeps the first exception for the caller.
  void Guarded(int thread) noexcept;
  void Stop() noexcept;
  /// Spins, then sleeps, until `good(state_)` is true; returns `state_`.
  template <class Good>
  std::uint64_t WaitUntil(const Good& good, std::atomic<int>& sleepers,
                          std::condition_variable& bell);
  /// Wakes sleeping threads after a change of `state_`.
  void Ring(const std::atomic<int>& sleepers, std::condition_variable& bell);

  /// Number of the round from bit 32 on; `kOpen` while threads may join it, `kStop` at the end; in
  /// the bits below, number of threads that have joined and are not done.
  std::atomic<std::uint64_t> state_{0};
  static constexpr std::uint64_t kOpen = 1u << 30, kStop = 1u << 31, kJoined = kOpen - 1;

  // Of the round; written before it opens, read by threads that have joined.
  void* context_ = nullptr;
  Call call_ = nullptr;
  std::exception_ptr failed_;  ///< Guarded by `mutex_` until all have returned.

  bool spins_ = false;
  std::mutex mutex_;  ///< Guards falling asleep and `failed_`.
  std::condition_variable start_, done_;
  std::atomic<int> idle_sleepers_{0}, caller_sleeps_{0};
  std::vector<Share> shares_;  ///< One per thread.
  std::vector<std::thread> workers_;
};

}  // namespace taut::base
