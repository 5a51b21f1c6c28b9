/// Interface for recorders of a live run; Recording (recording.h) writes files.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "taut/live.h"

namespace taut::viewer {

class LiveRecorder {
 public:
  virtual ~LiveRecorder() = default;

  virtual void Restart(LiveRun& run,
                       const ExperimentSpec& experiment) = 0;  ///< Begins the next part.
  virtual void Take(LiveRun& run) = 0;  ///< Records the present row, if it is due.
  virtual void Event(double time_s, const std::string& text) = 0;
  virtual void FlushOld() = 0;
  /// Completes the present part. Returns false if data of any part are missing.
  virtual bool Finish() = 0;
  /// Returns a notice for viewers: since when and why nothing is recorded. Empty: recording works.
  virtual const std::string& notice() const = 0;
};

/// Starts to record a run from its start. Returns null, with errors in the diagnostics, on failure.
/// `say` receives notices for the user: recording has stopped, or has resumed.
using MakeRecorder = std::function<std::unique_ptr<LiveRecorder>(
    LiveRun& run, const ExperimentSpec& experiment, std::function<void(const std::string&)> say,
    Diagnostics& out)>;

}  // namespace taut::viewer
