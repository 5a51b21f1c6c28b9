/// What runs in a browser: a live run that a page drives by the messages of the viewer, from files
/// that the page gives. One thread, and the page calls again and again.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/viewer/live_session.h"

namespace taut::browser {

class Demo {
 public:
  /// What is wrong with an experiment or a model, as JSON:
  /// {"good": bool, "kind": "experiment" | "model" | "", "files": [path], "found": [{"file",
  /// "line", "column", "error", "what", "hint"}]}. Not good: with errors. `files`: all that was
  /// read.
  static std::string Check(const std::string& path);

  /// Runs a file from its start, in place of what ran before. The answer of `Check`, with what
  /// finding the start said; if it is not good, what ran before goes on.
  std::string Open(const std::string& path, std::vector<double> mark_at_s, bool paused);

  /// A message of the page. Empty, or why it is none.
  std::string Post(std::string_view message);

  /// Goes on for some milliseconds; in how many it wants to be called again [ms].
  double Turn();

  /// JSON texts since the last call, in order: an array of messages.
  std::string TakeMessages();
  /// The newest frame's bytes; null: none since the last call.
  std::shared_ptr<const std::string> TakeFrame();

  /// {"path", "time_s", "hash", "touched", "set": {name: value}, "marks": [{"time_s", "hash"}]}, or
  /// null where nothing runs.
  std::string State() const;

 private:
  std::unique_ptr<viewer::LiveSession> session_;
  std::string path_;
  std::shared_ptr<const std::string> frame_;
  bool greeted_ = false;
};

}  // namespace taut::browser
