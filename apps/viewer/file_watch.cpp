#include "file_watch.h"

#include <filesystem>
#include <utility>

namespace taut::viewer {

namespace fs = std::filesystem;

FileWatch::State FileWatch::StateOf(const std::string& path) {
  std::error_code failed;
  const auto time = fs::last_write_time(path, failed);
  if (failed) return {};
  const auto size = fs::file_size(path, failed);
  if (failed) return {};
  // The count has 128 bits in the libc++ of emscripten.
  const auto count = static_cast<std::int64_t>(time.time_since_epoch().count());
  return {count, static_cast<std::int64_t>(size)};
}

void FileWatch::Watch(const std::vector<std::string>& files) {
  watched_.clear();
  for (const std::string& path : files) {
    const auto polled = polled_.find(path);
    watched_[path] = polled != polled_.end() ? polled->second : StateOf(path);
  }
  polled_ = watched_;
}

bool FileWatch::Poll() {
  States now;
  for (const auto& [path, state] : watched_) now[path] = StateOf(path);
  const bool stable = now == polled_;
  polled_ = std::move(now);
  return stable && polled_ != watched_;
}

std::vector<std::string> FileWatch::files() const {
  std::vector<std::string> files;
  for (const auto& [path, state] : watched_) files.push_back(path);
  return files;
}

}  // namespace taut::viewer
