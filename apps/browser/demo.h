/// Live run for the browser demo, compiled to WebAssembly. A page drives it with the viewer's
/// messages and supplies the files. Single-threaded: the page calls `Turn` repeatedly.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/viewer/live_session.h"

namespace taut::browser {

class Demo {
 public:
  /// Checks an experiment or a model. Returns JSON: {"good": bool, "kind": "experiment" | "model" |
  /// "", "files": [path], "found": [{"file", "line", "column", "error", "what", "hint"}]}. `good`
  /// is false if there are errors; `files` lists all files that were read.
  static std::string Check(const std::string& path);

  /// Runs a file from its start, in place of the previous run. Returns JSON as `Check` does,
  /// including the diagnostics of finding the start; if the file is not good, the previous run
  /// continues.
  std::string Open(const std::string& path, std::vector<double> mark_at_s, bool paused);

  /// Passes a message from the page to the run. Returns an error message, or an empty string if the
  /// message was accepted.
  std::string Post(std::string_view message);

  /// Advances the run for some milliseconds. Returns the time until the next call is due [ms].
  double Turn();

  /// Returns the JSON messages since the last call, in order, as one array.
  std::string TakeMessages();
  /// Returns the bytes of the newest frame; null if there is none since the last call.
  std::shared_ptr<const std::string> TakeFrame();

  /// Returns {"path", "time_s", "hash", "touched", "set": {name: value}, "marks": [{"time_s",
  /// "hash"}]} as JSON, or null if nothing runs.
  std::string State() const;

 private:
  std::unique_ptr<viewer::LiveSession> session_;
  std::string path_;
  std::shared_ptr<const std::string> frame_;
  bool greeted_ = false;
};

}  // namespace taut::browser
