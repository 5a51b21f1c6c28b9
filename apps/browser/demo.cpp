#include "demo.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/viewer/live_inputs.h"
#include "findings.h"

namespace taut::browser {
namespace {

using viewer::Json;
using viewer::Session;

/// Client number of the only page, which is also the driver of the run.
constexpr int kClient = 1;

std::string Answer(const std::optional<viewer::LiveInputs>& inputs, bool good,
                   const Diagnostics& out) {
  Json files = Json::array();
  if (inputs) files = inputs->experiment.files;
  const char* kind = !inputs ? "" : inputs->model ? "model" : "experiment";
  return viewer::Dump(
      {{"good", good}, {"kind", kind}, {"files", files}, {"found", FindingsOf(out)}});
}

Json ToJson(const viewer::StateMark& mark) {
  return {{"time_s", mark.time_s}, {"hash", fmt::format("{:016x}", mark.hash)}};
}

}  // namespace

std::string Demo::Check(const std::string& path) {
  Diagnostics out;
  const auto inputs = viewer::LoadLiveInputs(path, {}, false, out);
  return Answer(inputs, inputs && out.ok(), out);
}

std::string Demo::Open(const std::string& path, std::vector<double> mark_at_s, bool paused) {
  Diagnostics out;
  const auto inputs = viewer::LoadLiveInputs(path, {}, false, out);
  if (!inputs || !out.ok()) return Answer(inputs, false, out);
  viewer::LiveOptions options;
  options.inputs = {path, {}, 0, std::nullopt};
  options.paused = paused || inputs->model;
  auto session = viewer::LiveSession::Create(inputs->model ? "model" : "live", inputs->experiment,
                                             options, out);
  if (session) {
    session->MarkAt(std::move(mark_at_s));
    session->SetDriver(kClient);
    session_ = std::move(session);
    path_ = path;
    frame_.reset();
    greeted_ = false;
  }
  return Answer(inputs, session_ != nullptr && out.ok(), out);
}

std::string Demo::Post(std::string_view message) {
  if (!session_) return "there is no running simulation";
  std::string reason;
  auto command = viewer::ParseCommand(message, reason);
  if (!command) return reason;
  if (command->type == "take_control") return {};
  return session_->Post(kClient, std::move(*command)) ? std::string() : "too many messages";
}

double Demo::Turn() {
  if (!session_) return 1000;
  const auto until = session_->Turn();
  const std::chrono::duration<double, std::milli> wait = until - Session::Clock::now();
  return std::max(0.0, wait.count());
}

std::string Demo::TakeMessages() {
  if (!session_) return "[]";
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "[" : ",") + text; };
  std::vector<viewer::Outgoing> messages = session_->TakeMessages();
  if (!std::exchange(greeted_, true)) {
    // Send the current scene, because earlier messages may contain an older scene.
    add(viewer::Dump(session_->Hello(kClient, kClient)));
    add(session_->scene());
  }
  for (const viewer::Outgoing& message : messages) add(message.text);
  return out.empty() ? "[]" : out + "]";
}

std::shared_ptr<const std::string> Demo::TakeFrame() {
  if (!session_) return nullptr;
  auto newest = session_->frame();
  if (newest == frame_) return nullptr;
  return frame_ = std::move(newest);
}

std::string Demo::State() const {
  const auto state = session_ ? session_->State() : std::nullopt;
  if (!state) return "null";
  Json set = Json::object(), marks = Json::array();
  for (const auto& [name, value] : session_->overrides()) set[name] = value;
  for (const viewer::StateMark& mark : session_->marks()) marks.push_back(ToJson(mark));
  Json json = ToJson(*state);
  json["path"] = path_;
  json["touched"] = session_->touched();
  json["set"] = std::move(set);
  json["marks"] = std::move(marks);
  return viewer::Dump(json);
}

}  // namespace taut::browser
