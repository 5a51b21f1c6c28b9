/// Thread pool: each piece is done once, by all threads, without data races (preset tsan).
#include "base/thread_pool.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace taut::base {
namespace {

using namespace std::chrono_literals;

/// Far longer than a thread spins for work before it sleeps
constexpr auto kUntilAllSleep = 5ms;

/// Waits until `good()`; without a time limit, so that ctest ends a test that waits forever.
template <class Good>
void Until(const Good& good) {
  while (!good()) std::this_thread::yield();
}

int Cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

// The written data are not atomic: the pool guarantees their visibility to the caller and to later
// work.
TEST(ThreadPool, EachPieceIsDoneOnceAndSeenByTheCaller) {
  for (const int threads : {1, 2, 3, 4 * Cores()}) {
    ThreadPool pool(threads);
    ASSERT_EQ(pool.threads(), threads);
    for (const std::size_t count : {0u, 1u, 2u, 3u, 16u, 101u}) {
      std::vector<int> done(count);
      std::vector<long> by(static_cast<std::size_t>(threads));
      auto work = [&](int thread, std::size_t piece) {
        ++done[piece];
        ++by[static_cast<std::size_t>(thread)];
      };
      constexpr int kRounds = 200;
      for (int round = 1; round <= kRounds; ++round) {
        pool.ForEach(count, work);
        ASSERT_EQ(done, std::vector<int>(count, round)) << threads << " threads";
      }
      long sum = 0;
      for (const long times : by) sum += times;
      EXPECT_EQ(sum, static_cast<long>(count) * kRounds);
    }
  }
}

// The second thread finishes its first piece only after all others are done, and the caller
// finishes its first only after the second has begun: the caller must take the rest of the second
// thread's share.
TEST(ThreadPool, WhatAThreadHasNotBegunIsDoneByOthers) {
  ThreadPool pool(2);
  constexpr std::size_t kPieces = 16;
  for (int round = 0; round < 100; ++round) {
    std::atomic<std::size_t> others{0};
    std::atomic<bool> begun{false};
    auto work = [&](int thread, std::size_t) {
      if (thread == 1 && !begun.exchange(true)) {
        Until([&] { return others == kPieces - 1; });
      } else {
        Until([&] { return begun.load(); });
        ++others;
      }
    };
    pool.ForEach(kPieces, work);
    ASSERT_EQ(others, kPieces - 1);
  }
}

// Without pauses the threads are still spinning; after a pause they sleep; with more threads than
// cores they sleep at once. The caller waits for all, so that a missed wake-up would hang the test.
TEST(ThreadPool, EveryThreadComesWhetherItLooksOrSleeps) {
  for (const int threads : {2, Cores(), 4 * Cores() + 1}) {
    ThreadPool pool(threads);
    for (int round = 0; round < 60; ++round) {
      if (round % 3 == 0) std::this_thread::sleep_for(kUntilAllSleep);
      std::atomic<int> come{0};
      std::vector<int> calls(static_cast<std::size_t>(threads));
      auto work = [&](int thread) {
        ++calls[static_cast<std::size_t>(thread)];
        ++come;
        if (thread != 0) return;
        Until([&] { return come == threads; });
      };
      pool.Run(work);
      ASSERT_EQ(calls, std::vector<int>(static_cast<std::size_t>(threads), 1)) << "round " << round;
    }
  }
}

// A caller that waits longer than its spin time sleeps, and is woken.
TEST(ThreadPool, TheCallerWaitsForThoseWhoHaveBegun) {
  ThreadPool pool(3);
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> begun{0};
    std::vector<int> ended(3);
    auto work = [&](int thread) {
      ++begun;
      if (thread == 0) {
        Until([&] { return begun == 3; });
      } else {
        std::this_thread::sleep_for(kUntilAllSleep);
      }
      ended[static_cast<std::size_t>(thread)] = 1;
    };
    pool.Run(work);
    ASSERT_EQ(ended, std::vector<int>(3, 1));
  }
}

TEST(ThreadPool, EndsWhateverItsThreadsDo) {
  for (int i = 0; i < 100; ++i) {
    ThreadPool pool(1 + i % 5);
    std::atomic<int> calls{0};
    auto work = [&](int) { ++calls; };
    for (int round = 0; round < i % 3; ++round) pool.Run(work);
    if (i % 10 == 0) std::this_thread::sleep_for(kUntilAllSleep);
    EXPECT_LE(calls, pool.threads() * (i % 3));
    EXPECT_GE(calls, i % 3);
  }
}

// The exception of any thread reaches the caller after all threads have returned; the pool remains
// usable.
TEST(ThreadPool, AnExceptionOfAnyThreadReachesTheCaller) {
  ThreadPool pool(3);
  for (int thrower = 0; thrower < 3; ++thrower) {
    for (int round = 0; round < 20; ++round) {
      std::atomic<int> begun{0}, ended{0};
      auto work = [&](int thread) {
        ++begun;
        Until([&] { return begun == 3; });
        if (thread == thrower) throw std::bad_alloc();
        ++ended;
      };
      EXPECT_THROW(pool.Run(work), std::bad_alloc);
      EXPECT_EQ(ended, 2);
    }
  }
  std::atomic<int> pieces{0};
  auto all = [&](int, std::size_t) { ++pieces; };
  pool.ForEach(100, all);
  EXPECT_EQ(pieces, 100);
}

// Limits the memory of the process, so that thread stacks cannot be allocated; sanitizers need that
// memory, too.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
TEST(ThreadPool, ThreadsThatCannotStartAreAnExceptionThatNamesTheNumber) {
  const auto in_child = [] {
    const rlimit limit{rlim_t{1} << 30, rlim_t{1} << 30};
    setrlimit(RLIMIT_AS, &limit);
    try {
      ThreadPool pool(100000);
    } catch (const std::system_error& error) {
      std::fprintf(stderr, "caught: %s\n", error.what());
      std::_Exit(7);
    }
    std::_Exit(1);
  };
  EXPECT_EXIT(in_child(), testing::ExitedWithCode(7), "cannot start thread [0-9]+ of 100000");
}
#endif

}  // namespace
}  // namespace taut::base
