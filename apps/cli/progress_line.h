/// Progress line on stderr for long commands.
#pragma once

#include <chrono>
#include <string>

namespace taut::cli {

/// Formats a duration as m:ss or h:mm:ss.
std::string Duration(double s);

/// Progress line: rewritten in place on a terminal, printed every ten seconds elsewhere.
class ProgressLine {
 public:
  /// `at_once`: the first line is due immediately.
  ProgressLine(bool quiet, bool at_once);

  /// Returns whether the next line is due.
  bool Due() const;
  void Show(const std::string& text);
  void Clear() const;

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_, at_once_, shown_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace taut::cli
