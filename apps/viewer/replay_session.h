/// Replay of a trace.
#pragma once

#include <memory>

#include "recorded.h"
#include "session.h"

namespace taut::viewer {

class ReplaySession final : public Session {
 public:
  ReplaySession(std::unique_ptr<Recorded> recorded, double speed);
  ~ReplaySession() override { Stop(); }

 private:
  void Handle(int client, const Command& command) override;
  Clock::time_point Work() override;
  Json MakeScene() const;
  /// Opens the trace of another mode, mechanism or state of self-stress of the same analysis.
  void OpenShape(int client, int number);
  void Anchor(double time_s);
  double PlayedTo(Clock::time_point now) const;

  std::unique_ptr<Recorded> recorded_;
  double speed_;
  bool paused_ = true, changed_ = true;
  std::size_t row_ = 0;
  int run_ = 1;
  // The displayed time is `anchor_s_` plus `speed_` times the wall-clock time since `anchor_wall_`.
  Clock::time_point anchor_wall_, shown_wall_;
  double anchor_s_ = 0;
};

}  // namespace taut::viewer
