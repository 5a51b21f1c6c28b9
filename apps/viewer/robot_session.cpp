#include "robot_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "taut/board/parameters.h"
#include "taut/link/names.h"

namespace taut::viewer {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRobotFramePeriod{50}, kStatusPeriod{100};
/// Shorter than a cycle, so that every cycle is stored.
constexpr double kHistoryPeriod_s = 0.005;
/// Limit of unsaved states, a minute of cycles, while the disk is blocked.
constexpr std::size_t kMaxStates = 6000;
constexpr std::size_t kMaxCommands = 1000;
constexpr std::size_t kEvents = 40;

int GainOf(const std::string& key) {
  for (int gain = 0; gain < board::kGains; ++gain) {
    if (link::MotorParameters()[static_cast<std::size_t>(gain)].key == key) return gain;
  }
  return -1;
}

}  // namespace

RobotSession::RobotSession(const std::string& title, RobotSessionOptions options)
    : Session("robot", title),
      options_(std::move(options)),
      gains_(options_.cables.size(), std::vector<double>(board::kGains, Frame::kUnknown)),
      log_(options_.cables),
      truth_(options_.truth, options_.robot.def.bodies.size()) {
  const ModelDef& def = options_.robot.def;
  has_set_point_.assign(def.cables.size(), false);
  for (const std::string& name : options_.cables) {
    const auto cable = std::find_if(def.cables.begin(), def.cables.end(),
                                    [&](const CableDef& one) { return one.name == name; });
    cable_of_motor_.push_back(static_cast<std::size_t>(cable - def.cables.begin()));
    has_set_point_[cable_of_motor_.back()] = true;
  }
  for (const BodyDef& body : def.bodies) described_.push_back({body.com_m, Quat{}});
  StartHistory();
  SetScene(MakeScene(), false);
}

RobotSession::~RobotSession() {
  Stop();
  Finish();
}

bool RobotSession::Finish() {
  TakeWhatIsLeft();
  Record(false);
  return all_recorded_;
}

void RobotSession::StartHistory() {
  history_.emplace(options_.robot.def, has_set_point_, kHistoryPeriod_s, log_.channels());
}

// --- the driving thread
// ----------------------------------------------------------------------------

void RobotSession::Show(const link::State& state) {
  const std::lock_guard lock(own_mutex_);
  if (!handover_.states.empty() && handover_.states.back().time_s == state.time_s) {
    handover_.states.back() = state;
    return;
  }
  if (handover_.states.size() >= kMaxStates) {
    ++handover_.lost;
    return;
  }
  handover_.states.push_back(state);
}

void RobotSession::Event(double time_s, const std::string& text) {
  const std::lock_guard lock(own_mutex_);
  handover_.events.push_back({time_s, text});
}

void RobotSession::BeginAt(double time_s) {
  const std::lock_guard lock(own_mutex_);
  handover_.begins_s = time_s;
}

std::vector<RobotCommand> RobotSession::TakeCommands() {
  const std::lock_guard lock(own_mutex_);
  return std::exchange(commands_, {});
}

void RobotSession::Refuse(int client, const std::string& why) {
  const std::lock_guard lock(own_mutex_);
  handover_.errors.push_back({client, why});
}

void RobotSession::SetGain(int motor, int gain, double value) {
  const std::lock_guard lock(own_mutex_);
  gains_[static_cast<std::size_t>(motor)][static_cast<std::size_t>(gain)] = value;
}

void RobotSession::AnswerGain(const RobotCommand& command, bool good, const std::string& text) {
  if (good) SetGain(command.motor, command.gain, command.value);
  const Json answer = {
      {"type", "gain_answer"},
      {"cable", options_.cables[static_cast<std::size_t>(command.motor)]},
      {"gain", link::MotorParameters()[static_cast<std::size_t>(command.gain)].key},
      {"value", command.value},
      {"good", good},
      {"text", text}};
  const std::lock_guard lock(own_mutex_);
  handover_.answers.push_back(answer);
}

// --- the server's thread
// ---------------------------------------------------------------------------

std::optional<RobotCommand> RobotSession::RobotCommandOf(int client, const Command& command) const {
  using Kind = RobotCommand::Kind;
  RobotCommand out;
  out.client = client;
  if (command.type == "stop") {
    out.kind = Kind::kStop;
    return out;
  }
  if (command.type == "robot_mode") {
    out.kind = command.mode == "off"         ? Kind::kOff
               : command.mode == "arm"       ? Kind::kArm
               : command.mode == "hold"      ? Kind::kHold
               : command.mode == "impedance" ? Kind::kImpedance
                                             : Kind::kClearFaults;
    return out;
  }
  if (command.type != "robot_gain") return std::nullopt;
  const auto cable = std::find(options_.cables.begin(), options_.cables.end(), command.name);
  if (cable == options_.cables.end()) return std::nullopt;
  out.kind = Kind::kGain;
  out.motor = static_cast<int>(cable - options_.cables.begin());
  out.gain = GainOf(command.gain);
  out.value = command.value;
  return out;
}

bool RobotSession::TakeAtOnce(int client, const Command& command) {
  const std::optional<RobotCommand> wanted = RobotCommandOf(client, command);
  if (!wanted) return false;
  const bool stop = wanted->kind == RobotCommand::Kind::kStop;
  const std::lock_guard lock(own_mutex_);
  if (stop) {
    // A stop cancels all earlier commands.
    commands_.clear();
  } else if (commands_.size() >= kMaxCommands) {
    return true;  // the client no longer drives
  }
  commands_.push_back(*wanted);
  return true;
}

// --- the session's thread
// --------------------------------------------------------------------------

void RobotSession::Handle(int client, const Command& command) {
  if (command.type == "want_series") {
    Json series;
    if (command.source == 0 && history_->size() > 0) {
      series = history_->SeriesOf(command.name, command.t0, command.t1,
                                  static_cast<std::size_t>(command.points));
    }
    if (!series.is_null()) {
      return Say(client, {{"type", "series"}, {"id", command.id}, {"series", std::move(series)}});
    }
    return SayError(client, fmt::format("there is no channel \"{}\"", command.name));
  }
  if (command.type == "drop") return;  // a dragging client has left; a robot has no drags
  if (command.type == "robot_gain") {
    return SayError(client, fmt::format("there is no actuated cable \"{}\"", command.name));
  }
  if (command.type != "record") {
    return SayError(client, fmt::format("{} is not possible with a robot", command.type));
  }
  if (!options_.recorder)
    return SayError(client, "this recording was configured at the start and cannot be changed");
  if (!now_) return SayError(client, "there is nothing to record yet");
  Record(command.on);
}

void RobotSession::Record(bool on) {
  if (!options_.recorder || on == !recording_.empty()) return;
  std::string why;
  const double time_s = now_ ? now_->time_s : 0;
  if (on) {
    recording_ = options_.recorder->Begin(time_s, why);
    Happened({time_s, recording_.empty() ? "NOT recorded: " + why : "recorded to " + recording_});
    all_recorded_ = all_recorded_ && !recording_.empty();
    return;
  }
  const bool whole = options_.recorder->End(why);
  const std::string folder = std::exchange(recording_, {});
  Happened({time_s, whole ? "recorded: " + folder : "NOT all recorded: " + why});
  all_recorded_ = all_recorded_ && whole;
}

void RobotSession::Happened(const LogEvent& event) {
  if (!recording_.empty()) options_.recorder->Event(event.time_s, event.text);
  last_events_.push_back(event);
  if (last_events_.size() > kEvents) last_events_.erase(last_events_.begin());
  SayEvent(event.time_s - begun_s_, event.text);
}

void RobotSession::Take(const link::State& state) {
  if (!std::exchange(begun_, true)) {
    begun_s_ = state.time_s;
    if (options_.record_at_once) {
      now_ = state;
      Record(true);
    }
  }
  const bool is_new = !now_ || state.time_s > now_->time_s || history_->size() == 0;
  now_ = state;
  if (!is_new) return;
  shown_at_ = Clock::now().time_since_epoch().count();
  if (!recording_.empty()) options_.recorder->Take(state);

  moment_.time_s = moment_.now_s = state.time_s - begun_s_;
  moment_.run = run_;
  moment_.real_time_factor = 1;
  moment_.cables.assign(options_.robot.def.cables.size(), {});
  for (std::size_t m = 0; m < state.motors.size(); ++m) {
    const link::MotorView& motor = state.motors[m];
    moment_.cables[CableOf(m)] = {motor.tension_n, motor.length_m, motor.rest_length_m,
                                  motor.set_point_n};
  }
  const std::vector<Frame::Body>* const pose = truth_.Read();
  moment_.bodies = pose != nullptr ? *pose : described_;
  if (moment_.time_s < 0 || !history_->IsDue(moment_.time_s)) return;
  const double* const row = log_.Row(state);
  history_->Take(moment_, std::vector<double>(row, row + log_.channels().size()));
}

void RobotSession::ShowFrame() {
  if (!now_ || moment_.bodies.size() != described_.size()) return;
  const bool true_pose = truth_.Read() != nullptr;
  if (true_pose != std::exchange(true_pose_, true_pose)) SetScene(MakeScene(), true);
  Publish(moment_);
}

void RobotSession::ShowStatus() {
  if (!now_) return;
  Gains gains;
  {
    const std::lock_guard lock(own_mutex_);
    gains = gains_;
  }
  const double age_s =
      std::chrono::duration<double>(Clock::now().time_since_epoch() - Clock::duration(shown_at_))
          .count();
  Json status = StatusJson(*now_, options_.cables, gains);
  status["time_s"] = now_->time_s - begun_s_;
  status["alarms"] = AlarmsOf(*now_, options_.cables, options_.port, age_s);
  status["recording"] = options_.recorder ? recording_ : options_.recording;
  status["events"] = Json::array();
  for (const LogEvent& event : last_events_) {
    status["events"].push_back({{"time_s", event.time_s - begun_s_}, {"text", event.text}});
  }
  SetStatus({{"type", "robot"}, {"status", std::move(status)}});
}

void RobotSession::TakeWhatIsLeft() {
  Handover left;
  {
    const std::lock_guard lock(own_mutex_);
    std::swap(left, handover_);
  }
  if (left.begins_s) {
    begun_s_ = *left.begins_s;
    begun_ = true;
    ++run_;
    StartHistory();
    moment_ = {};
  }
  for (const link::State& state : left.states) Take(state);
  for (const LogEvent& event : left.events) Happened(event);
  if (left.lost > 0) {
    Happened({now_ ? now_->time_s : 0,
              fmt::format("{} cycles were not recorded: this computer is overloaded", left.lost)});
  }
  for (const Outgoing& error : left.errors) SayError(error.client, error.text);
  for (const Json& answer : left.answers) Say(0, answer);
}

Session::Clock::time_point RobotSession::Work() {
  TakeWhatIsLeft();
  const Clock::time_point now = Clock::now();
  ShowFrame();
  if (now - status_wall_ >= kStatusPeriod - milliseconds(5)) {
    status_wall_ = now;
    ShowStatus();
  }
  return now + kRobotFramePeriod;
}

Json RobotSession::MakeScene() const {
  ExperimentSpec experiment;
  experiment.robot = options_.robot;
  Json scene = SceneOf(experiment);
  std::vector<ChannelInfo> channels;
  for (const ChannelInfo& channel : history_->channels()) {
    const auto begins = [&](const char* word) { return channel.name.rfind(word, 0) == 0; };
    // These quantities are not measured on a robot; bodies and nodes are available only from a
    // virtual robot.
    if (begins("system/") || begins("real_time_factor")) continue;
    if (options_.truth.empty() && (begins("body/") || begins("node/"))) continue;
    if (begins("cable/")) {
      const std::string name = channel.name.substr(6, channel.name.rfind('/') - 6);
      const auto& cables = options_.cables;
      if (std::find(cables.begin(), cables.end(), name) == cables.end()) continue;
    }
    channels.push_back(channel);
  }
  scene["channels"] = ToJson(channels);
  Json gains = Json::array();
  for (std::size_t gain = 0; gain < board::kGains; ++gain) {
    const link::ParameterInfo& info = link::MotorParameters()[gain];
    gains.push_back({{"key", info.key}, {"min", info.range.least}, {"max", info.range.greatest}});
  }
  scene["robot"] = {{"port", options_.port},
                    {"motors", options_.cables},
                    {"gains", gains},
                    {"true_pose", true_pose_},
                    {"experiment", options_.experiment},
                    {"may_record", options_.recorder != nullptr}};
  return scene;
}

}  // namespace taut::viewer
