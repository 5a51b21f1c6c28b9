/// Files of a `taut robot` command: trace and events.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "taut/files.h"
#include "taut/link/log.h"
#include "taut/run_folder.h"
#include "taut/trace.h"

namespace taut::cli {

/// Records one trace row per cycle, and the events in events.jsonl. Both files replace those of the
/// previous run when the run begins (RunFolder), so a killed program never leaves a folder without
/// a run. Until then, they are temporary files and rows in memory.
///
/// The threads that write traces call `NoteBegin`; all other functions are for one thread.
class RobotRecording {
 public:
  /// Creates the files of a recording whose trace, `trace.h5`, begins the run. Returns null, with
  /// an error in `out`, on failure. `folder` must outlive the recording. Times count from the time
  /// given to `BeginAt` on the driver's clock.
  static std::unique_ptr<RobotRecording> Start(RunFolder& folder,
                                               const std::vector<std::string>& cables,
                                               const TraceMetadata& metadata, Diagnostics& out);
  /// Same as `Start`, but for a recording `host.h5` in a run that begins with another trace. Wrap
  /// the writer of the other trace with `Announcing`.
  static std::unique_ptr<RobotRecording> StartHost(RunFolder& folder,
                                                   const std::vector<std::string>& cables,
                                                   const TraceMetadata& metadata, Diagnostics& out);

  /// Returns a writer that calls `NoteBegin` as soon as `trace`, a writer of the file `name` from
  /// `RunFolder::BeginWith`, has begun the run. The recording must outlive it.
  std::unique_ptr<TraceWriter> Announcing(std::unique_ptr<TraceWriter> trace,
                                          const std::string& name);
  /// Publishes the events, since the run has begun.
  void NoteBegin();
  /// Returns whether the run has begun, for the threads that write traces.
  bool has_begun() const { return has_begun_; }

  void BeginAt(double time_s) { begun_s_ = time_s; }
  void Take(const link::State& state);
  void Event(double time_s, const std::string& text);
  /// Returns false, with an error in `out`, if not everything could be written. Without an error, a
  /// recording `host.h5` of a run that has not begun leaves no files.
  bool Finish(Diagnostics& out);
  std::int64_t rows() const { return rows_; }

 private:
  RobotRecording(RunFolder& folder, const std::vector<std::string>& cables)
      : folder_(folder), log_(cables), events_(folder.Path("events.jsonl")) {}
  bool Create(const std::string& name, const TraceMetadata& metadata, Diagnostics& out);

  RunFolder& folder_;
  link::RobotLog log_;
  std::mutex events_mutex_;
  std::string events_before_;  ///< Events before the publication of `events_`.
  NewFile events_;
  bool events_good_ = true, events_published_ = false;
  std::atomic<bool> has_begun_{false};
  double begun_s_ = 0;
  std::int64_t rows_ = 0;
  std::unique_ptr<TraceWriter> trace_;  ///< Last member, because its thread uses the others.
};

}  // namespace taut::cli
