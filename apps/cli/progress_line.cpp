#include "progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace taut::cli {

std::string Duration(double s) {
  const long long whole = std::llround(std::fmin(std::fmax(s, 0.0), 1e9));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

ProgressLine::ProgressLine(bool quiet, bool at_once)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), at_once_(at_once) {}

bool ProgressLine::Due() const {
  if (quiet_) return false;
  if (at_once_ && !shown_) return true;
  return Clock::now() - last_ >= std::chrono::milliseconds(terminal_ ? 200 : 10'000);
}

void ProgressLine::Show(const std::string& text) {
  fmt::print(stderr, "{}{}{}", terminal_ ? "\r\033[K" : "", text, terminal_ ? "" : "\n");
  std::fflush(stderr);
  shown_ = true;
  last_ = Clock::now();
}

void ProgressLine::Clear() const {
  if (shown_ && terminal_) fmt::print(stderr, "\r\033[K");
}

}  // namespace taut::cli
