#include "live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "live_parameters.h"

namespace taut::viewer {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr microseconds kFramePeriod{16667};
/// Duration of stepping between checks for commands.
constexpr milliseconds kSlice{5};
constexpr milliseconds kIdlePeriod{250};
/// Simulated time between stored moments. At full speed fewer are stored, so that their cost is
/// negligible.
constexpr double kHistoryPeriodS = 0.01, kFastHistoryPeriodS = 0.02;

}  // namespace

std::unique_ptr<LiveSession> LiveSession::Create(const std::string& mode,
                                                 const ExperimentSpec& experiment,
                                                 const LiveOptions& options, Diagnostics& out) {
  auto run = LiveRun::Start(experiment, out);
  if (!run) return nullptr;
  std::unique_ptr<LiveSession> session(new LiveSession(mode, std::move(run), options));
  session->experiment_ = experiment;
  if (mode == "model") session->model_ = experiment;
  session->given_ = ParametersOfFiles(experiment);
  if (options.record) {
    const auto say = [self = session.get()](const std::string& text) {
      self->SayEvent(self->run_->time_s(), text);
      self->scene_changed_ = true;  // the scene contains the notice, for clients that connect later
      self->options_.tell(text);
    };
    session->recording_ = options.record(*session->run_, experiment, say, out);
    if (!session->recording_) return nullptr;
  }
  if (options.watch) session->watch_.Watch(experiment.files);
  session->StartHistory();
  for (const Diagnostic& warning : Sorted(out.warnings())) {
    session->SayEvent(0, "warning: " + warning.what);
  }
  session->SetScene(session->MakeScene(), false);
  return session;
}

LiveSession::LiveSession(const std::string& mode, std::unique_ptr<LiveRun> run, LiveOptions options)
    : Session(mode, run->experiment().name),
      options_(std::move(options)),
      restarts_(options_.inputs),
      run_(std::move(run)),
      pace_(options_.speed, options_.paused) {
  Anchor();
}

LiveSession::~LiveSession() {
  Stop();
  Finish();
}

bool LiveSession::Finish() { return !recording_ || recording_->Finish(); }

void LiveSession::StartHistory() {
  has_set_point_.assign(experiment_.robot.def.cables.size(), false);
  for (const LiveControl& control : run_->Controls()) {
    has_set_point_[static_cast<std::size_t>(control.cable)] = control.impedance.has_value();
  }
  history_.emplace(experiment_.robot.def, has_set_point_,
                   pace_.speed() == 0 ? kFastHistoryPeriodS : kHistoryPeriodS, run_->channels());
  past_row_.reset();
  Fill(moment_);
  history_->Take(moment_, run_->Row());
}

void LiveSession::Handle(int client, const Command& command) {
  std::string error;
  if (command.type == "want_series") {
    Json series = history_->SeriesOf(command.name, command.t0, command.t1,
                                     static_cast<std::size_t>(command.points));
    if (command.source == 0 && !series.is_null()) {
      return Say(client, {{"type", "series"}, {"id", command.id}, {"series", std::move(series)}});
    }
    return SayError(client, fmt::format("there is no channel \"{}\"", command.name));
  }
  changed_ = true;
  if (!Drive(client, command, error)) SayError(client, error);
}

bool LiveSession::Drive(int client, const Command& command, std::string& error) {
  const std::string& type = command.type;
  // Changes of parameters accumulate. Any other command refers to the run that results from them.
  if (type == "set_parameter") return SetParameter(client, command, error);
  if (type == "reset") {
    restarts_.Reset(client);
    return true;
  }
  Restart();
  if (type == "start") return StartModelAs(command.mode, error);
  if (type == "analyze") return Analyze(error);
  if (type == "pause" || type == "resume") {
    if (type == "pause") {
      Pause();
    } else {
      pace_.Resume(run_->time_s());
      past_row_.reset();
    }
  } else if (type == "step") {
    Pause();
    if (past_row_ || command.count < 0) {
      past_row_ = history_->Step(past_row_, command.count, run_->time_s());
    } else {
      for (int i = 0; i < command.count && !stopping(); ++i) StepOnce();
    }
  } else if (type == "seek") {
    past_row_ = history_->PastRow(command.value, run_->time_s());
    Pause();
  } else if (type == "speed") {
    pace_.SetSpeed(command.value, run_->time_s());
  } else if (type == "drop") {
    if (dragging_) Log("released");
    dragging_ = false;
    run_->SetHand({});
  } else if (type == "drag" || type == "push") {
    const std::optional<int> node = FindNode(command.name);
    if (!node) {
      error = fmt::format("there is no node \"{}\"", command.name);
      return false;
    }
    const Vec3& v = command.vector;
    past_row_.reset();  // drags act on the present, not on a past moment
    if (type == "drag") {
      if (!dragging_) Log(fmt::format("drag {}", command.name));
      dragging_ = touched_ = true;
      run_->SetHand(HandSpec{*node, v});
    } else {
      run_->Push({*node, v}, command.value);
      touched_ = true;
      Log(fmt::format("push {} with ({:.4g}, {:.4g}, {:.4g}) N for {:g} s", command.name, v.x, v.y,
                      v.z, command.value));
    }
  } else if (type == "set_setpoint" || type == "set_gain") {
    return SetControl(command, error);
  } else {
    error = fmt::format("{} is not possible in a live run", type);
    return false;
  }
  return true;
}

bool LiveSession::SetParameter(int client, const Command& command, std::string& error) {
  if (!given_.contains(command.name)) Restart();  // the name may be a parameter of the next run
  const std::optional<LiveParameter> parameter =
      FindParameter(*run_, experiment_, given_, command.name);
  if (!parameter) {
    error = fmt::format("there is no parameter \"{}\"", command.name);
    return false;
  }
  if (!(command.value >= parameter->min && command.value <= parameter->max)) {
    error =
        fmt::format("{} must be within {:g} to {:g}", command.name, parameter->min, parameter->max);
    return false;
  }
  if (parameter->restarts) {
    restarts_.Set(client, command.name, command.value);
  } else {
    Restart();
    run_->SetParameter(parameter->kind, parameter->index, command.value);
    touched_ = true;
    Log(fmt::format("{} = {:g}", command.name, command.value));
    scene_changed_ = true;
  }
  return true;
}

bool LiveSession::SetControl(const Command& command, std::string& error) {
  for (LiveControl& control : run_->Controls()) {
    const CableDef& cable = experiment_.robot.def.cables[static_cast<std::size_t>(control.cable)];
    if (cable.name != command.name) continue;
    if (!(command.value >= 0)) {
      error = "set points and gains must not be negative";
      return false;
    }
    if (command.type == "set_setpoint") {
      (control.impedance ? control.impedance->tension_offset_n : control.rest_length_m) =
          command.value;
    } else if (!control.impedance) {
      error = fmt::format("{} has no gains", command.name);
      return false;
    } else if (command.gain == "length_offset_m") {
      control.impedance->length_offset_m = command.value;
    } else if (command.gain == "position_gain_n_per_m") {
      control.impedance->position_gain_n_per_m = command.value;
    } else {
      control.impedance->velocity_gain_n_s_per_m = command.value;
    }
    run_->SetControl(control);
    touched_ = true;
    Log(fmt::format("{} of {} = {:g}",
                    command.type == "set_gain" ? command.gain
                    : control.impedance        ? "tension_offset_n"
                                               : "rest_length_m",
                    command.name, command.value));
    scene_changed_ = true;
    return true;
  }
  error = fmt::format("there is no actuated cable \"{}\"", command.name);
  return false;
}

std::optional<StateMark> LiveSession::State() const {
  const World* const world = run_->world();
  if (world == nullptr) return std::nullopt;
  return StateMark{run_->time_s(), world->Hash(0)};
}

void LiveSession::MarkAt(std::vector<double> times_s) {
  mark_at_s_ = std::move(times_s);
  marks_.clear();
}

void LiveSession::Mark() {
  if (const auto state = State()) marks_.push_back(*state);
}

void LiveSession::Log(const std::string& text) {
  SayEvent(run_->time_s(), text);
  if (recording_) recording_->Event(run_->time_s(), text);
}

void LiveSession::TellOverloads() {
  const std::vector<Overload> overloads = run_->Overloads();
  if (overloads.size() <= overloads_told_) return;
  overloads_told_ = overloads.size();
  Log(Describe(overloads));
}

bool LiveSession::StepOnce() {
  if (!run_->Step()) {
    if (!std::exchange(broken_told_, true)) Log("the state is no longer finite");
    Pause();
    return false;
  }
  if (history_->IsDue(run_->time_s())) {
    Fill(moment_);
    history_->Take(moment_, run_->Row());
    TellOverloads();
  }
  if (recording_) recording_->Take(*run_);
  if (marks_.size() < mark_at_s_.size() && run_->time_s() >= mark_at_s_[marks_.size()]) Mark();
  if (!end_told_ && run_->time_s() >= experiment_.duration_s && mode() == "live") {
    end_told_ = true;
    Log("end of the experiment; resume to continue");
    Pause();
    return false;
  }
  return true;
}

void LiveSession::StepUntil(double time_s, Clock::time_point deadline) {
  for (int steps = 0; run_->time_s() < time_s && !stopping(); ++steps) {
    if (!StepOnce()) return;
    if ((steps & 15) == 15 && Clock::now() >= deadline) return;
  }
}

Session::Clock::time_point LiveSession::Work() {
  const Clock::time_point start = Clock::now();
  // At most one restart per displayed frame, for any number of requests.
  if (idle() && start - shown_wall_ >= kFramePeriod) Restart(start + kFramePeriod);
  ReloadChangedFiles(start);
  if (std::exchange(scene_changed_, false)) SetScene(MakeScene(), true);
  if (!pace_.paused()) {
    StepUntil(pace_.WantedAt(start), std::min(start + kSlice, shown_wall_ + kFramePeriod));
    changed_ = true;
  }
  const Clock::time_point now = Clock::now();
  pace_.At(run_->time_s(), now);
  if (now - shown_wall_ >= (changed_ ? Clock::duration(kFramePeriod) : kIdlePeriod)) {
    if (recording_) recording_->FlushOld();
    Show();
    shown_wall_ = now;
    changed_ = false;
  }
  if (restarts_.pending()) changed_ = true;
  if (pace_.paused()) return shown_wall_ + (changed_ ? Clock::duration(kFramePeriod) : kIdlePeriod);
  return pace_.speed() == 0 ? now : std::min(shown_wall_ + kFramePeriod, now + microseconds(4000));
}

void LiveSession::Fill(Frame& frame) const {
  const World* const world =
      run_->world();  // null: no simulation; energies and contacts are unknown
  const Observation& now = run_->Observe();
  const ModelDef& def = experiment_.robot.def;
  frame.time_s = frame.now_s = run_->time_s();
  frame.real_time_factor = pace_.real_time_factor();
  frame.speed = pace_.speed();
  frame.paused = pace_.paused();
  frame.run = run_number_;
  if (world != nullptr) frame.energy = world->TotalEnergy(0);
  frame.bodies.clear();
  for (int b = 0; now.bodies != nullptr && b < static_cast<int>(def.bodies.size()); ++b) {
    const BodyState body = now.bodies->Body(0, b);
    frame.bodies.push_back({body.position_m, body.orientation});
  }
  frame.cables.clear();
  frame.bends.clear();
  frame.spans.clear();
  for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
    const CableState cable = now.Cable(c);
    const auto place = static_cast<std::size_t>(c);
    if (world != nullptr && def.cables[place].touches != CableTouches::kNone) {
      for (const Vec3& bend : world->CableBendPlaces(0, c)) frame.bends.push_back({c, bend});
    }
    if (world != nullptr && HasFriction(def.cables[place])) {
      for (const double tension_n : world->CableSpanTensions(0, c)) {
        frame.spans.push_back({c, tension_n});
      }
    }
    frame.cables.push_back(
        {cable.tension_n, cable.length_m, cable.rest_length_m,
         has_set_point_[place] ? run_->commands().set_point_n[place] : Frame::kUnknown});
  }
  frame.contacts.clear();
  if (world != nullptr) {
    for (const ContactState& contact : world->Contacts(0)) {
      frame.contacts.push_back({contact.point_m, contact.force_n});
    }
  }
  frame.contact_count = static_cast<double>(frame.contacts.size());
  frame.pushes = run_->ExternalForces();
}

void LiveSession::Show() {
  Frame frame;
  Fill(frame);
  if (past_row_) history_->Show(*past_row_, frame);
  Publish(std::move(frame));
}

Json LiveSession::MakeScene() const {
  Json scene = SceneOf(experiment_);
  scene["parameters"] = ParametersJson(*run_, experiment_, given_);
  scene["controls"] = ControlsJson(*run_);
  scene["channels"] = ToJson(history_->channels());
  scene["drag_stiffness_n_per_m"] = run_->DragStiffness();
  scene["contact_forces"] = run_->world() != nullptr;
  std::string notice = files_notice_;
  if (recording_ && !recording_->notice().empty()) {
    notice += (notice.empty() ? "" : "\n") + recording_->notice();
  }
  if (!notice.empty()) scene["notice"] = notice;
  if (!statics_.is_null()) scene["statics"] = statics_;
  return scene;
}

std::optional<int> LiveSession::FindNode(const std::string& name) const {
  const auto& nodes = experiment_.robot.def.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

}  // namespace taut::viewer
