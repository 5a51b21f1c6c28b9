/// Change detection for the input files of a live run.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace taut::viewer {

/// Compares times and sizes of files at each `Poll`. This needs no notifications from the operating
/// system and works on every file system. A session polls a few files four times a second.
class FileWatch {
 public:
  /// Watches these files, which may be missing. For files that were polled before, the reference is
  /// their state at the last `Poll`, so later changes are not missed.
  void Watch(const std::vector<std::string>& files);

  /// Returns true if a file differs from its state at the last `Watch` and has not changed since
  /// the previous `Poll`: an editor may still be writing it.
  bool Poll();
  std::vector<std::string> files() const;  ///< Files of the last `Watch`.

 private:
  struct State {
    std::int64_t time = 0;  ///< Time of the last change. A missing file has time 0, size -1.
    std::int64_t size = -1;
    bool operator==(const State&) const = default;
  };
  using States = std::map<std::string, State>;
  static State StateOf(const std::string& path);

  States watched_, polled_;
};

}  // namespace taut::viewer
