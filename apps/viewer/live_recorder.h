/// What keeps a live run while it goes on; Recording (recording.h) keeps it on the disk.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "taut/live.h"

namespace taut::viewer {

class LiveRecorder {
 public:
  virtual ~LiveRecorder() = default;

  virtual void Restart(LiveRun& run, const ExperimentSpec& experiment) = 0;  ///< The next part.
  virtual void Take(LiveRun& run) = 0;  ///< The present row, if it is due.
  virtual void Event(double time_s, const std::string& text) = 0;
  virtual void FlushOld() = 0;
  /// Completes the present part. False: something is missing, of any part.
  virtual bool Finish() = 0;
  /// What those should know who look at it: since when and why nothing is kept. Empty: all is well.
  virtual const std::string& notice() const = 0;
};

/// Begins to keep a run at its start; nothing and diagnostics if that cannot be. `say` gets what
/// people should know: what is not kept, and what is again.
using MakeRecorder = std::function<std::unique_ptr<LiveRecorder>(
    LiveRun& run, const ExperimentSpec& experiment, std::function<void(const std::string&)> say,
    Diagnostics& out)>;

}  // namespace taut::viewer
