// Robot control page: commands from browsers to the boards, state to the browsers.
#include "robot_view.h"

#include <fmt/format.h>

#include <bit>
#include <utility>

#include "apps/viewer/web_files.h"
#include "output.h"
#include "taut/link/names.h"
#include "view_server.h"

namespace taut::cli {
namespace {

using board::Mode;
using link::Stage;
using Kind = viewer::RobotCommand::Kind;

/// Time after which arming expires [s], so that an abandoned page leaves nothing armed.
constexpr double kArmed_s = 20;
/// Time for the boards to follow a command [s]: a few cycles.
constexpr double kObey_s = 0.5;
/// Limit of queued gains; one is sent per cycle.
constexpr int kMaxGainsUnderWay = 200;

/// Returns the reason why the motors cannot be powered; empty if they can.
std::string WhyNotWell(const link::State& state) {
  if (!state.link.connected) return "the adapter is gone";
  if (state.stopping) return "an emergency stop has not been cleared";
  for (std::size_t b = 0; b < state.boards.size(); ++b) {
    const link::BoardView& board = state.boards[b];
    const board::Status& is = board.status;
    const char* const what = !board.there                ? "does not answer"
                             : is.mode == Mode::kStopped ? "was stopped; clear faults"
                             : is.timeout                ? "timed out; clear faults"
                             : is.faulty                 ? "has latched faults"
                                                         : nullptr;
    if (what != nullptr) return fmt::format("board {} {}", b, what);
  }
  return {};
}

board::Asking AskingFor(board::Request request, int motor, int gain, double value) {
  return {request, static_cast<std::uint8_t>(gain),
          static_cast<std::uint8_t>(motor % board::kMotors),
          std::bit_cast<std::uint32_t>(static_cast<float>(value)), 0};
}

}  // namespace

bool IsSafeToServe(const viewer::ServerOptions& options) {
  if (viewer::IsLoopback(options.address)) return true;
  fmt::print(stderr,
             "error: --listen {} cannot be combined with a robot: the connection is not encrypted, "
             "so others on the network could move its motors (leave it out, and connect with ssh "
             "-L {}:localhost:{} MACHINE)\n",
             options.address, options.port, options.port);
  return false;
}

std::unique_ptr<RobotView> RobotView::Open(RobotConsole& desk, const std::string& port,
                                           RobotViewOptions options, int& exit) {
  exit = kFailed;
  std::string error;
  const std::optional<std::string> web = viewer::FindWebFolder(error);
  if (!web) {
    fmt::print(stderr, "error: {}\n", error);
    return nullptr;
  }
  std::unique_ptr<RobotView> view(new RobotView(desk, options.experiment));
  viewer::RobotSessionOptions what;
  what.robot = desk.robot();
  what.cables = desk.cables();
  what.port = port;
  if (desk.virtual_robot() != nullptr) what.truth = desk.virtual_robot()->truth();
  what.experiment = options.experiment;
  what.recording = options.recording;
  what.recorder = std::move(options.recorder);
  what.record_at_once = options.record_at_once;
  view->session_ = std::make_shared<viewer::RobotSession>(options.title, std::move(what));
  options.server.ends_on_signals = false;  // the console turns motors off first
  view->server_ =
      std::make_unique<viewer::Server>(*view->session_, viewer::ReadWebFiles(*web), options.server);
  if (!view->server_->Listen(error)) {
    fmt::print(stderr, "error: {}\n", error);
    return nullptr;
  }
  SayAddresses(options.title, options.server, view->server_->port(),
               "Ctrl-C turns the motors off and ends the command; closing the page does not.");
  view->thread_ = std::thread([server = view->server_.get()] { server->Run(); });
  for (int motor = static_cast<int>(desk.cables().size()) - 1; motor >= 0; --motor) {
    for (int gain = 0; gain < board::kGains; ++gain) {
      view->unknown_gains_->emplace_back(motor, gain);
    }
  }
  exit = kOk;
  return view;
}

RobotView::~RobotView() {
  // The console may still turn motors off, but without calls of this view.
  desk_.on_cycle = {};
  desk_.on_event = {};
  End();
}

bool RobotView::End() {
  if (thread_.joinable()) {
    server_->Stop();
    thread_.join();
  }
  return session_->Finish();
}

void RobotView::AfterCycle(const link::State& state) {
  session_->Show(state);
  for (const viewer::RobotCommand& command : session_->TakeCommands()) Obey(command, state);
  Continue(state);
  AskForGain();
}

void RobotView::Obey(const viewer::RobotCommand& command, const link::State& state) {
  link::Driver& driver = desk_.driver();
  if (experiment_ && command.kind != Kind::kStop && command.kind != Kind::kOff &&
      command.kind != Kind::kGain) {
    return session_->Refuse(command.client,
                            "an experiment drives the robot; only off and stop are possible");
  }
  switch (command.kind) {
    case Kind::kStop:
      pending_.reset();
      armed_until_s_.reset();
      driver.Stop(fmt::format("requested by viewer {}", command.client));
      return;
    case Kind::kOff:
      pending_.reset();
      armed_until_s_.reset();
      driver.Off();
      return session_->Event(state.time_s, fmt::format("off, by viewer {}", command.client));
    case Kind::kClearFaults:
      driver.ClearFaults();
      return session_->Event(state.time_s,
                             fmt::format("faults cleared by viewer {}", command.client));
    case Kind::kArm:
      return Arm(command.client, state);
    case Kind::kHold:
    case Kind::kImpedance:
      return GivePower(command.client, command.kind == Kind::kImpedance, state);
    case Kind::kGain:
      return SetGain(command);
  }
}

void RobotView::Arm(int client, const link::State& state) {
  if (state.stage == Stage::kActive) {
    return session_->Refuse(client, "the motors are on; turn them off first");
  }
  if (const std::string why = WhyNotWell(state); !why.empty()) {
    return session_->Refuse(client, "not armed: " + why);
  }
  desk_.driver().Arm();
  armed_until_s_ = state.time_s + kArmed_s;
  session_->Event(state.time_s, fmt::format("armed by viewer {}", client));
}

void RobotView::GivePower(int client, bool impedance, const link::State& state) {
  link::Driver& driver = desk_.driver();
  if (state.stage != Stage::kReady && state.stage != Stage::kActive) {
    return session_->Refuse(client, "arm first: motors are turned on in two steps");
  }
  // From any other mode, hold first: then the offsets are captured at rest.
  if (const std::string why = WhyNotWell(state); !why.empty() || !driver.Go(Mode::kHold)) {
    return session_->Refuse(client, "not enabled: " + (why.empty() ? "boards are not off" : why));
  }
  armed_until_s_.reset();
  pending_ = Pending{client, impedance, state.time_s + kObey_s};
  session_->Event(state.time_s,
                  fmt::format("{} by viewer {}", impedance ? "impedance" : "hold", client));
}

void RobotView::Continue(const link::State& state) {
  link::Driver& driver = desk_.driver();
  if (armed_until_s_ && driver.state().stage == Stage::kReady && state.time_s > *armed_until_s_) {
    driver.Off();
    session_->Event(state.time_s, fmt::format("no longer armed: {:g} s passed", kArmed_s));
  }
  if (driver.state().stage != Stage::kReady) armed_until_s_.reset();
  if (!pending_) return;
  if (driver.state().stage != Stage::kActive) {
    session_->Refuse(pending_->client, "motors were turned off: see the events");
    pending_.reset();
  } else if (link::AllAre(Mode::kHold, state)) {
    if (pending_->impedance) driver.Go(Mode::kImpedance, true);
    pending_.reset();
  } else if (state.time_s > pending_->until_s) {
    driver.Off();
    session_->Refuse(pending_->client, "boards do not follow the command: motors are turned off");
    session_->Event(state.time_s, "boards did not follow the command: all motors off");
    pending_.reset();
  }
}

void RobotView::AskForGain() {
  if (unknown_gains_->empty()) return;
  const auto [motor, gain] = unknown_gains_->back();
  unknown_gains_->pop_back();
  if (!desk_.driver().state().boards[static_cast<std::size_t>(motor / board::kMotors)].there) {
    unknown_gains_->insert(unknown_gains_->begin(), {motor, gain});  // retried later, when the
                                                                     // board may answer again
    return;
  }
  desk_.driver().Request(motor / board::kMotors, AskingFor(board::Request::kAsk, motor, gain, 0),
                         [session = session_, unknown = unknown_gains_, motor = motor,
                          gain = gain](const std::optional<board::Reply>& reply) {
                           if (!reply) {
                             unknown->emplace_back(motor, gain);
                           } else if (reply->answer == board::Answer::kGood) {
                             session->SetGain(
                                 motor, gain,
                                 std::bit_cast<float>(board::internal::Get32(reply->payload)));
                           }
                         });
}

void RobotView::SetGain(const viewer::RobotCommand& command) {
  if (*gains_under_way_ >= kMaxGainsUnderWay) {
    return session_->Refuse(command.client, "boards have not answered the previous requests");
  }
  ++*gains_under_way_;
  desk_.driver().Request(
      command.motor / board::kMotors,
      AskingFor(board::Request::kSet, command.motor, command.gain, command.value),
      [session = session_, under_way = gains_under_way_,
       command](const std::optional<board::Reply>& reply) {
        --*under_way;
        const bool good = reply && reply->answer == board::Answer::kGood;
        session->AnswerGain(command, good,
                            reply ? link::AnswerText(reply->answer) : "the board does not answer");
      });
}

}  // namespace taut::cli
