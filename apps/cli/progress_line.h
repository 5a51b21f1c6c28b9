/// What long work says of itself on stderr.
#pragma once

#include <chrono>
#include <string>

namespace taut::cli {

/// One line that is rewritten on a terminal, a line every ten seconds elsewhere.
class ProgressLine {
 public:
  /// `at_once`: the first one needs no waiting for.
  ProgressLine(bool quiet, bool at_once);

  /// Whether it is time for another.
  bool Due() const;
  void Show(const std::string& text);
  void Clear() const;

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_, at_once_, shown_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace taut::cli
