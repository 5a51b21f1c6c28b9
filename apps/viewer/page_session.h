/// Session for a user's program (taut/page.h): displays the program's states, stores them for
/// looking back, and delays the program to keep the pace.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "history.h"
#include "pace.h"
#include "session.h"

namespace taut::viewer {

class PageSession final : public Session {
 public:
  /// `browser_pauses`, and `speed` without it: see `PageOptions`.
  PageSession(const std::string& title, double speed, double history_period_s, bool browser_pauses);
  ~PageSession() override { Stop(); }

  // --- for the program, from one thread ------------------------------------------------------
  /// Restarts the session: frames now contain the robots of `shown` and the program's channels.
  /// `has_set_point`: per cable.
  void Begin(const ExperimentSpec& shown, const std::vector<bool>& has_set_point,
             const std::vector<ChannelInfo>& values);
  /// Same as `Page::Show`. The session sets the header fields of time and pace.
  void Show(Frame frame);

 private:
  void Handle(int client, const Command& command) override;
  Clock::time_point Work() override;
  bool Drive(const Command& command);
  bool Hold(const Command& command);
  void Wait(std::unique_lock<std::mutex>& lock, double time_s);

  const double history_period_s_;
  const bool browser_pauses_;
  // All members below are protected by the mutex: the program and the session's thread use them.
  std::mutex own_mutex_;
  std::condition_variable goes_on_;
  Pace pace_;
  std::optional<Json> new_scene_;
  std::optional<History> history_;
  std::optional<Frame> now_;  ///< Frame of the last `Show`.
  double asked_s_ = 0;        ///< Time of the last call of `Show`, which may still wait.
  std::optional<std::size_t> past_row_;
  int steps_left_ = 0;  ///< Number of calls of `Show` that may pass while paused.
  int run_ = 0;
  bool changed_ = false;
  Clock::time_point shown_wall_;
};

}  // namespace taut::viewer
