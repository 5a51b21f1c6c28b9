#include "page_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace taut::viewer {
namespace {

constexpr std::chrono::microseconds kFramePeriod{16667};
/// Interval of frames while idle; without them a page assumes that the connection is lost.
constexpr std::chrono::milliseconds kIdlePeriod{250};

}  // namespace

PageSession::PageSession(const std::string& title, double speed, double history_period_s,
                         bool browser_pauses)
    : Session("program", title),
      history_period_s_(history_period_s),
      browser_pauses_(browser_pauses),
      pace_(speed, false) {}

void PageSession::Begin(const ExperimentSpec& shown, const std::vector<bool>& has_set_point,
                        const std::vector<ChannelInfo>& values) {
  const std::lock_guard lock(own_mutex_);
  history_.emplace(shown.robot.def, has_set_point, history_period_s_, values);
  now_.reset();
  past_row_.reset();
  ++run_;
  Json scene = SceneOf(shown);
  for (const ChannelInfo& value : values) scene["values"].push_back(value.name);
  scene["channels"] = ToJson(history_->channels());
  scene["contact_forces"] = true;
  new_scene_ = std::move(scene);
}

void PageSession::Wait(std::unique_lock<std::mutex>& lock, double time_s) {
  while (!stopping()) {
    if (pace_.paused()) {
      if (steps_left_ > 0) {
        --steps_left_;
        return;
      }
      goes_on_.wait_for(lock, kIdlePeriod);
    } else {
      const Clock::time_point due = pace_.DueAt(time_s);
      if (due <= Clock::now()) return;
      goes_on_.wait_until(lock, std::min(due, Clock::now() + kIdlePeriod));
    }
  }
}

void PageSession::Show(Frame frame) {
  std::unique_lock lock(own_mutex_);
  if (now_ && frame.time_s < now_->time_s) {
    ++run_;
    now_.reset();  // the frame belongs to the previous run
  }
  asked_s_ = frame.time_s;
  if (!now_) {
    history_->Clear();
    past_row_.reset();
    pace_.Anchor(asked_s_);
    if (!browser_pauses_) pace_.Resume(asked_s_);
  }
  if (browser_pauses_) Wait(lock, frame.time_s);
  pace_.At(frame.time_s, Clock::now());
  frame.now_s = frame.time_s;
  frame.real_time_factor = pace_.real_time_factor();
  frame.run = run_;
  if (history_->IsDue(frame.time_s)) {
    const double held_s = past_row_ ? history_->time_s(*past_row_) : 0;
    history_->Take(frame, frame.values);
    if (past_row_) past_row_ = history_->RowAt(held_s);  // rows move if memory is full
  }
  now_ = std::move(frame);
  changed_ = true;
}

void PageSession::Handle(int client, const Command& command) {
  if (command.type == "want_series") {
    Json series;
    {
      const std::lock_guard lock(own_mutex_);
      if (history_ && history_->size() > 0 && command.source == 0) {
        series = history_->SeriesOf(command.name, command.t0, command.t1,
                                    static_cast<std::size_t>(command.points));
      }
    }
    if (series.is_null()) {
      return SayError(client, fmt::format("there is no channel \"{}\"", command.name));
    }
    return Say(client, {{"type", "series"}, {"id", command.id}, {"series", std::move(series)}});
  }
  if (Drive(command)) {
    goes_on_.notify_all();
  } else {
    SayError(client,
             fmt::format("{} is not possible in a page that a program has opened", command.type));
  }
}

bool PageSession::Drive(const Command& command) {
  const std::string& type = command.type;
  if (type == "drop") return true;  // a dragging client has left; a page has no drags
  const std::lock_guard lock(own_mutex_);
  changed_ = true;
  if (!browser_pauses_) return Hold(command);
  if (type == "pause") {
    pace_.Pause(asked_s_);
  } else if (type == "resume") {
    pace_.Resume(asked_s_);
    past_row_.reset();
    steps_left_ = 0;
  } else if (type == "speed") {
    pace_.SetSpeed(command.value, asked_s_);
  } else if (type == "step") {
    pace_.Pause(asked_s_);
    if (past_row_ || command.count < 0) {
      if (now_) past_row_ = history_->Step(past_row_, command.count, now_->time_s);
    } else {
      steps_left_ += command.count;
    }
  } else if (type == "seek") {
    pace_.Pause(asked_s_);
    if (now_) past_row_ = history_->PastRow(command.value, now_->time_s);
  } else {
    return false;
  }
  return true;
}

/// Changes the displayed time without a pause of the program. At the present, the page follows
/// again.
bool PageSession::Hold(const Command& command) {
  const std::string& type = command.type;
  if (type != "pause" && type != "resume" && type != "step" && type != "seek") return false;
  if (!now_) return true;
  if (type == "pause") {
    past_row_ = history_->RowAt(now_->time_s);
  } else if (type == "resume") {
    past_row_.reset();
  } else if (type == "step") {
    past_row_ = history_->Step(past_row_, command.count, now_->time_s);
  } else {
    past_row_ = history_->PastRow(command.value, now_->time_s);
  }
  if (past_row_) {
    pace_.Pause(asked_s_);
  } else {
    pace_.Resume(asked_s_);
  }
  return true;
}

Session::Clock::time_point PageSession::Work() {
  const Clock::time_point now = Clock::now();
  std::optional<Json> scene;
  std::optional<Frame> frame;
  {
    const std::lock_guard lock(own_mutex_);
    scene = std::exchange(new_scene_, std::nullopt);
    if (now_ && (changed_ || now - shown_wall_ >= kIdlePeriod)) {
      frame = now_;
      frame->speed = pace_.speed();
      frame->paused = pace_.paused();
      frame->real_time_factor = pace_.real_time_factor();
      if (past_row_) {
        history_->Show(*past_row_, *frame);
        frame->values = history_->Row(*past_row_);
      }
      changed_ = false;
      shown_wall_ = now;
    }
  }
  if (scene) SetScene(*scene, true);
  if (frame) Publish(std::move(*frame));
  return now + kFramePeriod;
}

}  // namespace taut::viewer
