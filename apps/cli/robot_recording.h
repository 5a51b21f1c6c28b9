/// What a command of `taut robot` leaves in a folder.
#pragma once

#include <memory>
#include <string>

#include "taut/files.h"
#include "taut/link/log.h"
#include "taut/trace.h"

namespace taut::cli {

/// A row a cycle into a trace, what happens into events.jsonl beside it.
class RobotRecording {
 public:
  /// Null and a complaint if the files cannot be made. Times count from `begun_s` of the driver's
  /// clock.
  static std::unique_ptr<RobotRecording> Start(const std::string& trace_path,
                                               const std::string& events_path,
                                               const std::vector<std::string>& cables,
                                               const TraceMetadata& metadata, Diagnostics& out);

  void BeginAt(double time_s) { begun_s_ = time_s; }
  void Take(const link::State& state);
  void Event(double time_s, const std::string& text);
  /// False and a complaint if anything of it could not be written.
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
