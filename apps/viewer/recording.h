/// What a live run leaves behind: a trace with the hands' forces as channels, what was done as
/// events, and the inputs.
#pragma once

#include <fstream>
#include <memory>
#include <string>

#include "live_session.h"
#include "taut/trace.h"

namespace taut::viewer {

/// One run from its start to a reset or the end. The first is trace.h5, events.jsonl and
/// inputs.yaml; a later one trace_2.h5, events_2.jsonl, inputs_2.yaml ...
class LiveSession::Recording {
 public:
  static std::unique_ptr<Recording> Start(const std::string& folder, int number, LiveRun& run,
                                          const ExperimentSpec& experiment, Diagnostics& out);

  /// Takes the present row if one is due. False: the trace cannot be written, see `error`.
  bool Take(LiveRun& run);
  void Event(double time_s, const std::string& text);
  void FlushOld() { writer_->FlushOld(); }
  void Finish() { writer_->Finish(); }
  const std::string& error() const { return writer_->error(); }

 private:
  std::unique_ptr<TraceWriter> writer_;
  std::ofstream events_;
  double rate_hz_ = 0;
  std::int64_t rows_ = 0;
};

}  // namespace taut::viewer
