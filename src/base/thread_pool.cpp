#include "base/thread_pool.h"

#include <algorithm>

#include "base/assert.h"

namespace taut::base {

ThreadPool::ThreadPool(int threads) {
  if (threads <= 0) threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  workers_.reserve(static_cast<std::size_t>(threads - 1));
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this, i] { Wait(i); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::RunErased(void* context, Call call) {
  if (workers_.empty()) return call(context, 0);
  {
    const std::lock_guard lock(mutex_);
    TAUT_ASSERT(busy_ == 0);  // one caller at a time
    context_ = context;
    call_ = call;
    busy_ = static_cast<int>(workers_.size());
    ++round_;
  }
  start_.notify_all();
  call(context, 0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadPool::Wait(int thread) {
  std::uint64_t seen = 0;
  for (;;) {
    std::unique_lock lock(mutex_);
    start_.wait(lock, [&] { return stop_ || round_ != seen; });
    if (stop_) return;
    seen = round_;
    const Call call = call_;
    void* const context = context_;
    lock.unlock();
    call(context, thread);
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

}  // namespace taut::base
