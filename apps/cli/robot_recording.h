/// Files of a `taut robot` command: trace and events.
#pragma once

#include <memory>
#include <string>

#include "taut/files.h"
#include "taut/link/log.h"
#include "taut/trace.h"

namespace taut::cli {

/// Records one trace row per cycle, and the events in events.jsonl.
class RobotRecording {
 public:
  /// Creates the files. Returns null, with an error in `out`, on failure. Times count from
  /// `begun_s` on the driver's clock.
  static std::unique_ptr<RobotRecording> Start(const std::string& trace_path,
                                               const std::string& events_path,
                                               const std::vector<std::string>& cables,
                                               const TraceMetadata& metadata, Diagnostics& out);

  void BeginAt(double time_s) { begun_s_ = time_s; }
  void Take(const link::State& state);
  void Event(double time_s, const std::string& text);
  /// Returns false, with an error in `out`, if not everything could be written.
  bool Finish(Diagnostics& out);
  std::int64_t rows() const { return rows_; }

 private:
  RobotRecording(const std::vector<std::string>& cables, const std::string& events_path)
      : log_(cables), events_(events_path) {}

  link::RobotLog log_;
  NewFile events_;
  std::unique_ptr<TraceWriter> trace_;
  double begun_s_ = 0;
  std::int64_t rows_ = 0;
  bool events_good_ = true;
};

}  // namespace taut::cli
