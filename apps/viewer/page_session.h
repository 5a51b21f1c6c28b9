/// What a program of a user's own shows: it says what is, the session shows it, keeps it to look
/// back, and makes the program wait.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "history.h"
#include "joined_robots.h"
#include "pace.h"
#include "session.h"

namespace taut::viewer {

class PageSession final : public Session {
 public:
  PageSession(const std::string& title, double speed, double history_period_s);
  ~PageSession() override { Stop(); }

  // --- for the program, from one thread ------------------------------------------------------
  /// From now on frames are of these robots and of channels of the program's own. Begins anew.
  void Begin(const JoinedRobots& robots, const std::vector<ChannelInfo>& values);
  /// As `Page::Show`. Header fields that are about time and pace are the session's.
  void Show(Frame frame);

 private:
  void Handle(int client, const Command& command) override;
  Clock::time_point Work() override;
  bool Drive(const Command& command);
  void Wait(std::unique_lock<std::mutex>& lock, double time_s);

  const double history_period_s_;
  // All below belongs to the lock: the program and the session's thread use it.
  std::mutex own_mutex_;
  std::condition_variable goes_on_;
  Pace pace_;
  std::optional<Json> new_scene_;
  std::optional<History> history_;
  std::optional<Frame> now_;  ///< Of the last `Show`.
  double asked_s_ = 0;        ///< Of the last call of `Show`, which may wait still.
  std::optional<std::size_t> past_row_;
  int steps_left_ = 0;  ///< So many calls pass while paused.
  int run_ = 0;
  bool changed_ = false;
  Clock::time_point shown_wall_;
};

}  // namespace taut::viewer
