/// Log of a driver as a trace with one row per cycle (docs/hardware/driver.md).
///
/// Threads: use an object from one thread at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/link/state.h"
#include "taut/trace.h"

namespace taut::link {

/// Returns a line of events.jsonl: time, origin and text of an event.
std::string EventLine(double time_s, const std::string& who, const std::string& what);

class RobotLog {
 public:
  /// `cables`: names of the motors' cables.
  explicit RobotLog(const std::vector<std::string>& cables);

  const std::vector<ChannelInfo>& channels() const { return channels_; }
  /// Returns the row of a state; valid until the next call.
  const double* Row(const State& state);

 private:
  std::vector<ChannelInfo> channels_;
  std::vector<double> row_;
  std::size_t motors_;
};

}  // namespace taut::link
