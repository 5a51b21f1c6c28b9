/// What is shown, on a thread of its own or turn by turn: a live run or a replay. The server asks
/// for the newest frame and never makes the session wait; commands are kept until they are done, or
/// until the session is told to stop.
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

/// A text for one client, or for all.
struct Outgoing {
  int client = 0;  ///< 0: everyone.
  std::string text;
};

class Session {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Session(std::string mode, std::string title);
  virtual ~Session();  ///< A derived class calls Stop in its own destructor.

  const std::string& mode() const noexcept { return mode_; }
  const std::string& title() const noexcept { return title_; }

  /// Starts the thread. `wake` is called from it when there is something to fetch; it must return
  /// at once.
  void Start(std::function<void()> wake);
  /// Instead of a thread: does what commands ask for and goes on for a little while (some
  /// milliseconds). Returns when it wants to be called again at the latest.
  Clock::time_point Turn();
  /// Waits for what is being done just now; commands that wait are forgotten.
  void Stop();
  /// After Stop: completes what the session leaves behind. False if not all of it is there.
  virtual bool Finish() { return true; }

  /// What a client is told first.
  Json Hello(int client, int driver) const;

  // --- for the server, from any thread; none of them waits for the session's work ------------
  /// False if so many commands wait that something must be wrong with who sends them.
  bool Post(int client, Command command);
  std::shared_ptr<const std::string> frame() const;  ///< The newest; nothing before the first.
  std::string scene() const;                         ///< The message; empty if there is none.
  /// The newest of a robot; nothing where there is none.
  std::shared_ptr<const std::string> status() const;
  std::vector<Outgoing> TakeMessages();
  void SetDriver(int client);

 protected:
  // --- for derived classes, on the session's thread -----------------------------------------
  virtual void Handle(int client, const Command& command) = 0;
  /// Goes on for a little while (a few milliseconds) and publishes; returns when it wants to be
  /// called again at the latest.
  virtual Clock::time_point Work() = 0;

  /// What must not wait for the session's work: called on the server's thread, returns at once.
  /// False: the command is handled as all others.
  virtual bool TakeAtOnce(int /*client*/, const Command& /*command*/) { return false; }

  /// Whether Stop was called. What takes long looks at it and ends.
  bool stopping() const noexcept { return stop_; }
  /// Whether no command waits.
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
