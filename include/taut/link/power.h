/// Motor power as the boards confirm it: turns motors off and reports which boards said so, and
/// when. A statement that motors are off rests on nothing else.
///
/// Threads: as for `Driver`.
#pragma once

#include <string>
#include <vector>

#include "taut/link/driver.h"

namespace taut::link {

/// What one board said last about its motors.
struct BoardPower {
  enum class Is { kOff, kOn, kUnknown };
  Is is = Is::kUnknown;                  ///< Unknown: no status came since the command.
  board::Mode mode = board::Mode::kOff;  ///< In its last status.
  double age_s = -1;                     ///< Of that status; negative: there was none.
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

/// "confirmed by 6 of 6 boards within 23 ms".
std::string DescribeConfirmation(const PowerReport& report);
/// An error for each board that has not confirmed, and how boards behave without commands. Nothing
/// where all have.
void ReportPower(const PowerReport& report, Diagnostics& out);

}  // namespace taut::link
