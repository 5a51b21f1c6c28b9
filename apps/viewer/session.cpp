#include "session.h"

#include <utility>

#include "protocol_messages.h"

namespace taut::viewer {

namespace {

/// Limit of waiting commands: more than any user causes, few enough for memory.
constexpr std::size_t kMaxWaiting = 100000;
/// Limit of waiting series requests, with answers of up to a megabyte; a page sends a few at a
/// time.
constexpr int kMaxSeriesWaiting = 256;
/// Longest processing of commands without an update of the display.
constexpr std::chrono::milliseconds kCommandSlice{10};

}  // namespace

Session::Session(std::string mode, std::string title)
    : mode_(std::move(mode)), title_(std::move(title)) {}

Session::~Session() = default;

void Session::Start(std::function<void()> wake) {
  wake_ = std::move(wake);
  thread_ = std::thread([this] { Loop(); });
}

void Session::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  wake_ = nullptr;  // the object that it wakes may be destroyed before the session
}

bool Session::idle() const {
  const std::lock_guard lock(mutex_);
  return commands_.empty();
}

bool Session::Post(int client, Command command) {
  if (TakeAtOnce(client, command)) return true;
  {
    const std::lock_guard lock(mutex_);
    if (commands_.size() >= kMaxWaiting || series_waiting_ >= kMaxSeriesWaiting) return false;
    if (command.type == "want_series") ++series_waiting_;
    commands_.emplace_back(client, std::move(command));
  }
  changed_.notify_all();
  return true;
}

std::shared_ptr<const std::string> Session::frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

std::shared_ptr<const std::string> Session::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::string Session::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

std::vector<Outgoing> Session::TakeMessages() {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

void Session::SetDriver(int client) {
  driver_ = client;
  changed_.notify_all();
}

void Session::Publish(Frame frame) {
  frame.driver = driver_;
  auto bytes = std::make_shared<const std::string>(FrameMessage(frame));
  {
    const std::lock_guard lock(mutex_);
    frame_.swap(bytes);
  }
  if (wake_) wake_();
}

void Session::SetScene(const Json& scene, bool tell) {
  std::string text = Dump({{"type", "scene"}, {"scene", scene}});
  {
    const std::lock_guard lock(mutex_);
    if (tell) messages_.push_back({0, text});
    scene_ = std::move(text);
  }
  if (tell && wake_) wake_();
}

void Session::SetStatus(const Json& message) {
  auto text = std::make_shared<const std::string>(Dump(message));
  {
    const std::lock_guard lock(mutex_);
    status_.swap(text);
  }
  if (wake_) wake_();
}

void Session::Say(int client, const Json& message) {
  std::string text = Dump(message);
  {
    const std::lock_guard lock(mutex_);
    messages_.push_back({client, std::move(text)});
  }
  if (wake_) wake_();
}

void Session::SayError(int client, const std::string& text) {
  Say(client, {{"type", "error"}, {"text", text}});
}

void Session::SayEvent(double time_s, const std::string& text) {
  Say(0, {{"type", "event"}, {"time_s", time_s}, {"text", text}});
}

std::optional<std::pair<int, Command>> Session::NextCommand() {
  const std::lock_guard lock(mutex_);
  if (commands_.empty()) return std::nullopt;
  std::pair<int, Command> next = std::move(commands_.front());
  commands_.pop_front();
  if (next.second.type == "want_series") --series_waiting_;
  return next;
}

Json Session::Hello(int client, int driver) const {
  return {{"type", "hello"},  {"version", kProtocolVersion},
          {"mode", mode_},    {"title", title_},
          {"client", client}, {"driver", driver}};
}

Session::Clock::time_point Session::Turn() {
  const Clock::time_point slice_end = Clock::now() + kCommandSlice;
  while (!stop_ && Clock::now() < slice_end) {
    const auto next = NextCommand();
    if (!next) break;
    Handle(next->first, next->second);
  }
  return stop_ ? Clock::now() : Work();
}

void Session::Loop() {
  while (!stop_) {
    const Clock::time_point until = Turn();
    if (stop_) return;
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, until, [&] { return stop_ || !commands_.empty(); });
  }
}

}  // namespace taut::viewer
