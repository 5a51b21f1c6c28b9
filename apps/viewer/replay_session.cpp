#include "replay_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace taut::viewer {
namespace {

constexpr std::chrono::microseconds kReplayFramePeriod{16667};
constexpr std::chrono::milliseconds kIdleReplayPeriod{1000};
/// Fastest replay; unlimited speed makes no sense for a recording.
constexpr double kMaxSpeed = 100;

}  // namespace

ReplaySession::ReplaySession(std::unique_ptr<Recorded> recorded, double speed)
    : Session("replay", recorded->title()),
      recorded_(std::move(recorded)),
      speed_(speed == 0 ? kMaxSpeed : speed) {
  SetScene(MakeScene(), false);
  Anchor(recorded_->trace().time_s.front());
}

Json ReplaySession::MakeScene() const {
  Json scene = recorded_->scene();
  if (!recorded_->summary().is_null()) scene["summary"] = recorded_->summary();
  return scene;
}

void ReplaySession::OpenShape(int client, int number) {
  namespace fs = std::filesystem;
  const Json scene = recorded_->scene();
  if (!scene.contains("shape")) return SayError(client, "this trace does not show a shape");
  const fs::path file = recorded_->path();
  const fs::path folder = file.parent_path().parent_path() /
                          fmt::format("{}_{}", scene["shape"]["kind"].get<std::string>(), number);
  Diagnostics found;
  auto other = Recorded::Load((folder / file.filename()).string(), {}, found);
  if (!other) return SayError(client, found.Format());
  recorded_ = std::move(other);
  ++run_;
  SetScene(MakeScene(), true);
  Anchor(recorded_->trace().time_s.front());
}

void ReplaySession::Anchor(double time_s) {
  const std::vector<double>& times = recorded_->trace().time_s;
  anchor_s_ = std::clamp(time_s, times.front(), times.back());
  anchor_wall_ = Clock::now();
  row_ = recorded_->RowAt(anchor_s_);
  changed_ = true;
}

double ReplaySession::PlayedTo(Clock::time_point now) const {
  if (paused_) return anchor_s_;
  return anchor_s_ + speed_ * std::chrono::duration<double>(now - anchor_wall_).count();
}

void ReplaySession::Handle(int client, const Command& command) {
  const std::string& type = command.type;
  const double now_s = PlayedTo(Clock::now());
  const std::vector<double>& times = recorded_->trace().time_s;
  if (type == "want_series") {
    const auto series = recorded_->SeriesOf(command.name, command.source, command.t0, command.t1,
                                            static_cast<std::size_t>(command.points));
    if (!series) {
      SayError(client, fmt::format("there is no channel \"{}\"", command.name));
    } else {
      Say(client, {{"type", "series"},
                   {"id", command.id},
                   {"series", SeriesJson(command.name, command.source, *series)}});
    }
  } else if (type == "pause") {
    Anchor(now_s);
    paused_ = true;
  } else if (type == "resume") {
    Anchor(now_s >= times.back() ? times.front() : now_s);  // at the end, the replay restarts
    paused_ = false;
  } else if (type == "seek") {
    Anchor(command.value);
  } else if (type == "reset") {
    Anchor(times.front());
  } else if (type == "speed") {
    Anchor(now_s);
    speed_ = command.value == 0 ? kMaxSpeed : command.value;
  } else if (type == "open_shape") {
    OpenShape(client, command.count);
  } else if (type == "step") {
    Anchor(now_s);
    const auto row = static_cast<std::int64_t>(row_) + command.count;
    const auto last = static_cast<std::int64_t>(times.size()) - 1;
    Anchor(times[static_cast<std::size_t>(std::clamp<std::int64_t>(row, 0, last))]);
    paused_ = true;
  } else {
    SayError(client, fmt::format("{} is not possible in a replay", type));
  }
}

Session::Clock::time_point ReplaySession::Work() {
  const Clock::time_point now = Clock::now();
  const std::vector<double>& times = recorded_->trace().time_s;
  if (!paused_) {
    const double played_to_s = PlayedTo(now);
    row_ = recorded_->RowAt(played_to_s);
    changed_ = true;
    if (played_to_s >= times.back()) {
      Anchor(times.back());
      paused_ = true;
    }
  }
  if (changed_ || now - shown_wall_ >= kIdleReplayPeriod) {
    Frame frame = recorded_->FrameOf(row_);
    frame.now_s = frame.time_s;
    frame.speed = speed_;
    frame.paused = paused_;
    frame.real_time_factor = paused_ ? 0 : speed_;
    frame.run = run_;
    Publish(std::move(frame));
    shown_wall_ = now;
    changed_ = false;
  }
  return shown_wall_ + (paused_ ? Clock::duration(kIdleReplayPeriod) : kReplayFramePeriod);
}

}  // namespace taut::viewer
