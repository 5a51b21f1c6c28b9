/// Confirmed motor power: turns motors off and reports when each board confirmed it. taut reports
/// motors as off only after this confirmation.
///
/// Threads: see `Driver`.
#pragma once

#include <string>
#include <vector>

#include "taut/link/driver.h"

namespace taut::link {

/// Motor power of one board according to its last status.
struct BoardPower {
  enum class Is { kOff, kOn, kUnknown };
  Is is = Is::kUnknown;                  ///< kUnknown: no status arrived after the command.
  board::Mode mode = board::Mode::kOff;  ///< Mode in the last status.
  double age_s = -1;                     ///< Age of the last status; negative without one.
};

struct PowerReport {
  std::vector<BoardPower> boards;
  bool adapter_answers = false;
  double waited_s = 0;  ///< Time from the command to this report.

  int off_count() const;
  /// Returns whether every board has confirmed that its motors are off. False without boards.
  bool all_off() const;
};

/// Commands all motors off. Runs cycles until every board has confirmed the command, but at most
/// `patience_s`.
PowerReport TurnOff(Driver& driver, double patience_s);

/// Returns a text, such as "confirmed by 6 of 6 boards within 23 ms".
std::string DescribeConfirmation(const PowerReport& report);
/// Adds an error for each board without confirmation, with a hint on boards without commands.
void ReportPower(const PowerReport& report, Diagnostics& out);

}  // namespace taut::link
