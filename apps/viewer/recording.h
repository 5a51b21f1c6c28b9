/// What a live session leaves behind: traces with the hands' forces as channels, what was done as
/// events, and the inputs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "live_recorder.h"
#include "taut/files.h"
#include "taut/live.h"

namespace taut::viewer {

/// A folder of parts, each a run from its start to a restart or the end: trace.h5, events.jsonl and
/// inputs.yaml, then trace_2.h5, events_2.jsonl, inputs_2.yaml ... A part in which nothing happened
/// is replaced by the next.
///
/// Where something cannot be written nothing is recorded from then on, and what has been stays; the
/// next restart begins the next part if that is possible again. Both are said, once.
class Recording final : public LiveRecorder {
 public:
  /// However many restarts there are: the last of these parts is replaced by those that follow it.
  static constexpr int kMaxParts = 16;

  /// The first part, in an existing folder. `say` gets what people should know: what is not
  /// recorded, and what is again.
  static std::unique_ptr<Recording> Start(const std::string& folder, LiveRun& run,
                                          const ExperimentSpec& experiment,
                                          std::function<void(const std::string&)> say,
                                          Diagnostics& out);

  void Restart(LiveRun& run, const ExperimentSpec& experiment) override;
  void Take(LiveRun& run) override;
  void Event(double time_s, const std::string& text) override;
  void FlushOld() override;
  bool Finish() override;

  /// Since when and why nothing is recorded; empty while all is well.
  const std::string& failure() const { return failure_; }
  /// That, or in the part after it that there is something missing.
  const std::string& notice() const override { return failure_.empty() ? resumed_ : failure_; }

 private:
  Recording(std::string folder, std::function<void(const std::string&)> say)
      : folder_(std::move(folder)), say_(std::move(say)) {}

  std::string Path(const char* name, const char* end) const;
  bool TakeFolder(Diagnostics& out);
  bool Begin(LiveRun& run, const ExperimentSpec& experiment, Diagnostics& out);
  bool BeginFiles(LiveRun& run, const ExperimentSpec& experiment, Diagnostics& out);
  bool IsThere();
  void Fail(const std::string& why);

  std::string folder_;
  std::function<void(const std::string&)> say_;
  std::unique_ptr<FolderLock> lock_;
  int part_ = 1;
  std::unique_ptr<TraceWriter> writer_;
  std::unique_ptr<NewFile> events_;
  FileIdentity identity_;  ///< Of the trace's file.
  double rate_hz_ = 0, time_s_ = 0;
  std::int64_t rows_ = 0, event_count_ = 0;
  std::string failure_, resumed_;
  std::string since_;  ///< The moment of the failure.
  bool ours_ = false;  ///< No pieces of another run are in the folder.
  bool complete_ = true;
};

/// Recordings in this folder; empty: nothing is recorded.
MakeRecorder RecordInto(const std::string& folder);

}  // namespace taut::viewer
