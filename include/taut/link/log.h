/// Log of a driver: a trace with one row per cycle (docs/hardware/driver.md).
///
/// Threads: only one thread at a time may use an object.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/link/state.h"
#include "taut/trace.h"

namespace taut::link {

/// Returns a line of events.jsonl with time, origin and text of an event.
std::string EventLine(double time_s, const std::string& who, const std::string& what);

class RobotLog {
 public:
  /// `cables`: names of the cables that the motors wind.
  explicit RobotLog(const std::vector<std::string>& cables);

  const std::vector<ChannelInfo>& channels() const { return channels_; }
  /// Returns the row for a state; valid until the next call.
  const double* Row(const State& state);

 private:
  std::vector<ChannelInfo> channels_;
  std::vector<double> row_;
  std::size_t motors_;
};

}  // namespace taut::link
