/// Change detection for the input files of a live run.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace taut::viewer {

/// Compares times and sizes of files at each `Poll`, which needs no operating system's notification
/// and works on every file system. A session polls a few files four times a second.
class FileWatch {
 public:
  /// Watches these files, which may be missing. Files that were polled before count as read in the
  /// state of the last `Poll`: a later change is not missed.
  void Watch(const std::vector<std::string>& files);

  /// Returns true if a file differs from its state at the last `Watch` and has not changed since
  /// the previous `Poll`: an editor may still be writing it.
  bool Poll();

 private:
  struct State {
    std::int64_t time = 0;  ///< Of the last change; 0 with size -1: the file is missing.
    std::int64_t size = -1;
    bool operator==(const State&) const = default;
  };
  using States = std::map<std::string, State>;
  static State StateOf(const std::string& path);

  States watched_, polled_;
};

}  // namespace taut::viewer
