/// Confirmed motor power: turns motors off and reports which boards have confirmed it, and when.
/// taut reports motors as off only on this confirmation.
///
/// Threads: as for `Driver`.
#pragma once

#include <string>
#include <vector>

#include "taut/link/driver.h"

namespace taut::link {

/// Motor power of one board by its last status.
struct BoardPower {
  enum class Is { kOff, kOn, kUnknown };
  Is is = Is::kUnknown;                  ///< Unknown: no status arrived after the command.
  board::Mode mode = board::Mode::kOff;  ///< In its last status.
  double age_s = -1;                     ///< Age of that status; negative without one.
};

struct PowerReport {
  std::vector<BoardPower> boards;
  bool adapter_answers = false;
  double waited_s = 0;  ///< From the command to this report.

  int off_count() const;
  /// Whether every board has confirmed that its motors are off. False without boards.
  bool all_off() const;
};

/// Commands all motors off and cycles until every board has confirmed it, at most `patience_s`.
PowerReport TurnOff(Driver& driver, double patience_s);

/// Returns a text such as "confirmed by 6 of 6 boards within 23 ms".
std::string DescribeConfirmation(const PowerReport& report);
/// Adds an error for each board without confirmation, and a hint on boards without commands. Adds
/// nothing if all boards have confirmed.
void ReportPower(const PowerReport& report, Diagnostics& out);

}  // namespace taut::link
