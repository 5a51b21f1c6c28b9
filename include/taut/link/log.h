/// What a driver hears, as a trace (docs/hardware/driver.md): a row a cycle.
///
/// Threads: belongs to one at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/link/state.h"
#include "taut/trace.h"

namespace taut::link {

/// A line of events.jsonl: who says what, and when.
std::string EventLine(double time_s, const std::string& who, const std::string& what);

class RobotLog {
 public:
  /// Names of the motors' cables.
  explicit RobotLog(const std::vector<std::string>& cables);

  const std::vector<ChannelInfo>& channels() const { return channels_; }
  /// The row of a state; valid until the next call.
  const double* Row(const State& state);

 private:
  std::vector<ChannelInfo> channels_;
  std::vector<double> row_;
  std::size_t motors_;
};

}  // namespace taut::link
