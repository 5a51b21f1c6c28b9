/// Base of the viewer's sessions (live run, replay, page, robot), on a separate thread or turn by
/// turn. The server fetches the newest frame and never makes the session wait; commands are queued
/// until they are executed or the session stops.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "command.h"
#include "frame.h"
#include "scene.h"

namespace taut::viewer {

/// A text for one client or for all.
struct Outgoing {
  int client = 0;  ///< Number of the receiving client; 0: all clients.
  std::string text;
};

class Session {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Session(std::string mode, std::string title);
  virtual ~Session();  ///< A derived class must call Stop in its destructor.

  const std::string& mode() const noexcept { return mode_; }
  const std::string& title() const noexcept { return title_; }

  /// Starts the thread, which calls `wake` when there is something to fetch; `wake` must return at
  /// once.
  void Start(std::function<void()> wake);
  /// Replaces the thread in programs without one: executes commands and advances for some
  /// milliseconds. Returns the latest time of the next call.
  Clock::time_point Turn();
  /// Waits for the operation in progress; discards waiting commands.
  void Stop();
  /// After Stop: completes the session's output. Returns false if data are missing.
  virtual bool Finish() { return true; }

  /// Returns the first message for a client.
  Json Hello(int client, int driver) const;

  // --- for the server, thread-safe; none of them waits for the session's work ---------------
  /// Queues a command. Returns false if the queue is full.
  bool Post(int client, Command command);
  std::shared_ptr<const std::string> frame() const;  ///< The newest frame; null before the first.
  std::string scene() const;                         ///< The scene message; empty if there is none.
  /// Returns the newest robot status; null without a robot.
  std::shared_ptr<const std::string> status() const;
  std::vector<Outgoing> TakeMessages();
  void SetDriver(int client);

 protected:
  // --- for derived classes, on the session's thread -----------------------------------------
  virtual void Handle(int client, const Command& command) = 0;
  /// Advances for a few milliseconds and publishes; returns the latest time of the next call.
  virtual Clock::time_point Work() = 0;

  /// Handles commands that must not wait for the session's work. Called on the server's thread;
  /// must return at once. Returns false if the command is to be queued.
  virtual bool TakeAtOnce(int /*client*/, const Command& /*command*/) { return false; }

  /// Returns whether Stop was called. Long operations poll it and end.
  bool stopping() const noexcept { return stop_; }
  /// Returns whether no command waits.
  bool idle() const;

  void Publish(Frame frame);
  void SetScene(const Json& scene, bool tell);
  void SetStatus(const Json& message);
  void Say(int client, const Json& message);
  void SayError(int client, const std::string& text);
  void SayEvent(double time_s, const std::string& text);

 private:
  void Loop();
  std::optional<std::pair<int, Command>> NextCommand();

  const std::string mode_, title_;
  std::thread thread_;
  std::function<void()> wake_;
  std::atomic<int> driver_{0};

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> stop_{false};
  std::deque<std::pair<int, Command>> commands_;
  int series_waiting_ = 0;
  std::shared_ptr<const std::string> frame_, status_;
  std::string scene_;
  std::vector<Outgoing> messages_;
};

}  // namespace taut::viewer
