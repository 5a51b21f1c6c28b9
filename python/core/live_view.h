/// Live view: a page of a local server that shows one world while the program steps it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "taut/page.h"
#include "taut/spec.h"

namespace taut::python {

/// Settings of a live view. `web_folder`: folder of the viewer's pages.
struct LiveOptions {
  std::string title, web_folder;
  std::uint16_t port = 0;
};

/// Sends the states of one world to a page, at most 60 per second of wall time. While the world is
/// idle, a thread of the view reads the states. During a call that steps the world, the view
/// requests each state from the stepping thread, which reads it between two steps. So a program
/// without a view has no cost, and a slow browser delays no step.
///
/// Threads: all functions are thread-safe; none needs the GIL.
class LiveView {
 public:
  struct State {
    RobotMoment moment;
    double time_s = 0;
  };
  /// Access to the world. The functions are called without the GIL.
  struct Source {
    /// Returns a number that every change of the world changes; odd while the world is in use.
    std::function<std::uint64_t()> changes;
    /// Reads the state; returns false if the world is in use.
    std::function<bool(State&)> read;
    /// Requests a call of `Take` from the thread that steps the world.
    std::function<void()> request;
  };

  /// Starts the server and the thread. Returns null, with errors in `out`, if the page cannot be
  /// opened. The GIL must be held.
  static std::shared_ptr<LiveView> Open(const ExperimentSpec& experiment, Source source,
                                        const LiveOptions& options, Diagnostics& out);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  const std::string& url() const { return url_; }
  bool closed() const;
  /// Ends the server and the thread. No effect in a forked child, which has neither.
  void Close();
  /// Shows a state.
  void Take(const State& state);
  /// Ends all access to the world, which is about to be destroyed. The page keeps its last state.
  void Detach();

 private:
  struct Shared;
  LiveView();

  std::unique_ptr<Shared> shared_;
  std::string url_;
};

/// Closes all views, before the program destroys its static variables. The GIL must be held.
void CloseLiveViews();

}  // namespace taut::python
