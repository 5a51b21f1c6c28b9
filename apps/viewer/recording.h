/// Files of a live session: traces with the users' forces as channels, user actions as events, and
/// the inputs.
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

/// A folder of parts, each from a start to a restart or the end: trace.h5, events.jsonl and
/// inputs.yaml, then trace_2.h5, events_2.jsonl, inputs_2.yaml ... A part without any event is
/// replaced by the next.
///
/// If a file cannot be written, recording stops and existing files stay. The next restart begins a
/// new part if writing is possible again. The stop and the resumption are each reported once.
class Recording final : public LiveRecorder {
 public:
  /// Maximum number of parts; each further part replaces the last one.
  static constexpr int kMaxParts = 16;

  /// Starts the first part, in an existing folder. `say` receives notices for the user: recording
  /// has stopped, or has resumed.
  static std::unique_ptr<Recording> Start(const std::string& folder, LiveRun& run,
                                          const ExperimentSpec& experiment,
                                          std::function<void(const std::string&)> say,
                                          Diagnostics& out);

  void Restart(LiveRun& run, const ExperimentSpec& experiment) override;
  void Take(LiveRun& run) override;
  void Event(double time_s, const std::string& text) override;
  void FlushOld() override;
  bool Finish() override;

  /// Returns since when and why nothing is recorded; empty while recording works.
  const std::string& failure() const { return failure_; }
  /// Returns the failure, or in the part after it a notice that data are missing.
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
  FileIdentity identity_;  ///< Identity of the trace's file.
  double rate_hz_ = 0, time_s_ = 0;
  std::int64_t rows_ = 0, event_count_ = 0;
  std::string failure_, resumed_;
  std::string since_;  ///< Time of the failure, as text.
  bool ours_ = false;  ///< The folder contains no files of another run.
  bool complete_ = true;
};

/// Returns a factory of recordings in this folder; an empty folder: no recording.
MakeRecorder RecordInto(const std::string& folder);

}  // namespace taut::viewer
