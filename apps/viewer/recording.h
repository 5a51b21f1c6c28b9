/// What a live session leaves behind: traces with the hands' forces as channels, what was done as
/// events, and the inputs.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "taut/files.h"
#include "taut/live.h"

namespace taut::viewer {

/// A file descriptor that closes itself.
class File {
 public:
  explicit File(int descriptor = -1) : descriptor_(descriptor) {}
  File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~File();
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Lines that are there whole or not at all, at any moment.
class LineFile {
 public:
  bool Create(const std::string& path);  ///< Removes what is there. False: see errno.
  bool Append(const std::string& line);  ///< False: see errno.

 private:
  File file_;
  off_t size_ = 0;
};

/// A folder of parts, each a run from its start to a restart or the end: trace.h5, events.jsonl and
/// inputs.yaml, then trace_2.h5, events_2.jsonl, inputs_2.yaml ... A part in which nothing happened
/// is replaced by the next.
///
/// What cannot be written is said once; from then on nothing is recorded, and what has been stays.
class Recording {
 public:
  /// However many restarts there are: the last of these parts is replaced by those that follow it.
  static constexpr int kMaxParts = 16;

  /// The first part, in an existing folder. `say` gets what people should know: what is not
  /// recorded.
  static std::unique_ptr<Recording> Start(const std::string& folder, LiveRun& run,
                                          const ExperimentSpec& experiment,
                                          std::function<void(const std::string&)> say,
                                          Diagnostics& out);

  void Restart(LiveRun& run, const ExperimentSpec& experiment);  ///< The next part.
  void Take(LiveRun& run);                                       ///< The present row, if it is due.
  void Event(double time_s, const std::string& text);
  void FlushOld();
  bool Finish();  ///< Completes the present part. False: something is missing.

  /// Why nothing is recorded any more; empty while all is well.
  const std::string& failure() const { return failure_; }

 private:
  Recording(std::string folder, std::function<void(const std::string&)> say)
      : folder_(std::move(folder)), say_(std::move(say)) {}

  std::string Path(const char* name, const char* end) const;
  bool Begin(LiveRun& run, const ExperimentSpec& experiment, Diagnostics& out);
  bool IsThere();
  void Fail(const std::string& why);

  std::string folder_;
  std::function<void(const std::string&)> say_;
  std::unique_ptr<FolderLock> lock_;
  int part_ = 1;
  std::unique_ptr<TraceWriter> writer_;
  LineFile events_;
  std::pair<dev_t, ino_t> identity_;  ///< Of the trace's file.
  double rate_hz_ = 0, time_s_ = 0;
  std::int64_t rows_ = 0, event_count_ = 0;
  std::string failure_;
};

}  // namespace taut::viewer
