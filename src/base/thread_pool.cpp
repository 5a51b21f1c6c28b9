#include "base/thread_pool.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

#include "base/assert.h"

namespace taut::base {
namespace {

/// Spin times of a waiting thread. Sleep and wake-up take 50 us together, so shorter spins cost
/// little. The next call often comes a few microseconds later. After 10 us (kGivingWay), the thread
/// yields its core, which the awaited thread may need; yielding earlier may cost milliseconds.
constexpr std::chrono::microseconds kLooking{60}, kGivingWay{10};

/// Pauses briefly, so that the other hardware thread of the core can run.
void Pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ volatile("yield");
#endif
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (threads <= 0) threads = cores;
  spins_ = threads <= cores;
  shares_ = std::vector<Share>(static_cast<std::size_t>(threads));
  workers_.reserve(static_cast<std::size_t>(threads - 1));
  for (int i = 1; i < threads; ++i) {
    try {
      workers_.emplace_back([this, i] { Work(i); });
    } catch (const std::system_error& error) {
      Stop();
      throw std::system_error(error.code(), "cannot start thread " + std::to_string(i + 1) +
                                                " of " + std::to_string(threads));
    } catch (...) {
      Stop();
      throw;
    }
  }
}

ThreadPool::~ThreadPool() { Stop(); }

void ThreadPool::Stop() noexcept {
  state_.fetch_or(kStop);
  Ring(idle_sleepers_, start_);
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::RunErased(void* context, Call call) {
  if (workers_.empty()) return call(context, 0);
  const std::uint64_t before = state_.load(std::memory_order_relaxed);
  TAUT_ASSERT((before & (kOpen | kJoined)) == 0);  // only one caller at a time
  context_ = context;
  call_ = call;
  state_.store(((before >> 32) + 1) << 32 | kOpen);
  Ring(idle_sleepers_, start_);
  Guarded(0);
  // From now on, no further thread may join: the context of this round becomes invalid.
  state_.fetch_and(~kOpen);
  WaitUntil([](std::uint64_t state) { return (state & kJoined) == 0; }, caller_sleeps_, done_);
  if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
}

void ThreadPool::Guarded(int thread) noexcept {
  try {
    call_(context_, thread);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!failed_) failed_ = std::current_exception();
  }
}

void ThreadPool::Work(int thread) {
  std::uint64_t seen = 0;
  for (;;) {
    std::uint64_t state = WaitUntil(
        [&](std::uint64_t now) {
          return (now & kStop) != 0 || ((now & kOpen) != 0 && now >> 32 != seen);
        },
        idle_sleepers_, start_);
    if ((state & kStop) != 0) return;
    // Fails if the round has ended since, because the whole word is compared.
    if (!state_.compare_exchange_strong(state, state + 1)) continue;
    seen = state >> 32;
    Guarded(thread);
    if (((state_.fetch_sub(1) - 1) & (kOpen | kJoined)) == 0) Ring(caller_sleeps_, done_);
  }
}

template <class Good>
std::uint64_t ThreadPool::WaitUntil(const Good& good, std::atomic<int>& sleepers,
                                    std::condition_variable& bell) {
  std::uint64_t state = state_.load();
  if (good(state)) return state;
  if (spins_) {
    const auto start = std::chrono::steady_clock::now();
    for (;;) {
      for (int i = 0; i < 16; ++i) {
        Pause();
        if (good(state = state_.load())) return state;
      }
      const auto looked = std::chrono::steady_clock::now() - start;
      if (looked > kLooking) break;
      if (looked > kGivingWay) std::this_thread::yield();
    }
  }
  // No wake-up is lost. Both sides first write and then read, in one sequentially consistent order.
  // Therefore the thread that next changes `state_` sees this sleeper and takes the mutex to ring,
  // or this check sees the change.
  std::unique_lock lock(mutex_);
  sleepers.fetch_add(1);
  bell.wait(lock, [&] { return good(state = state_.load()); });
  sleepers.fetch_sub(1);
  return state;
}

void ThreadPool::Ring(const std::atomic<int>& sleepers, std::condition_variable& bell) {
  if (sleepers.load() == 0) return;
  // A thread that counts as a sleeper holds the mutex until it sleeps.
  { const std::lock_guard lock(mutex_); }
  bell.notify_all();
}

}  // namespace taut::base
