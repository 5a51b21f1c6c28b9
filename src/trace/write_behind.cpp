#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "taut/trace.h"

namespace taut {
namespace {

/// Longest time between two flushes of rows.
constexpr auto kFlush = std::chrono::milliseconds(250);

class WriterBehind final : public TraceWriter {
 public:
  WriterBehind(std::unique_ptr<TraceWriter> writer, std::size_t channels)
      : writer_(std::move(writer)), channels_(channels), thread_([this] { Work(); }) {}
  ~WriterBehind() override { End(); }

  bool Append(double time_s, const double* values) override {
    const std::lock_guard lock(mutex_);
    rows_.emplace_back(time_s, std::vector<double>(values, values + channels_));
    changed_.notify_one();
    return good_;
  }
  bool FlushOld() override {
    const std::lock_guard lock(mutex_);
    return good_;
  }
  bool Finish() override {
    End();
    if (!finished_) good_ = writer_->Finish() && good_;
    finished_ = true;
    if (!good_) error_ = writer_->error();
    return good_;
  }
  const std::string& error() const override { return error_; }

 private:
  void End() {
    {
      const std::lock_guard lock(mutex_);
      end_ = true;
      changed_.notify_one();
    }
    if (thread_.joinable()) thread_.join();
  }

  void Work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait_for(lock, kFlush, [this] { return end_ || !rows_.empty(); });
      std::deque<Row> rows = std::exchange(rows_, {});
      const bool end = end_;
      lock.unlock();
      bool good = true;
      for (const auto& [time_s, values] : rows)
        good = good && writer_->Append(time_s, values.data());
      good = good && writer_->FlushOld();
      lock.lock();
      good_ = good_ && good;
      if (end && rows_.empty()) return;
    }
  }

  using Row = std::pair<double, std::vector<double>>;
  std::unique_ptr<TraceWriter> writer_;  ///< Used by the thread until the thread ends.
  const std::size_t channels_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Row> rows_;
  bool end_ = false, good_ = true, finished_ = false;
  std::string error_;
  std::thread thread_;  ///< Last member, because the thread uses all others.
};

}  // namespace

std::unique_ptr<TraceWriter> WriteBehind(std::unique_ptr<TraceWriter> writer,
                                         std::size_t channels) {
  return std::make_unique<WriterBehind>(std::move(writer), channels);
}

}  // namespace taut
