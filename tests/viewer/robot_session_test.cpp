// The page of a robot, from the side of a client and of the driver thread
#include "apps/viewer/robot_session.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>

#include "taut/link/robot_plant.h"
#include "tests/viewer/serving.h"

namespace taut::test {
namespace {

using link::State;
using viewer::RobotCommand;
using viewer::RobotSession;
using viewer::RobotSessionOptions;
using Kind = RobotCommand::Kind;

const std::string kMotors = TAUT_SOURCE_DIR "/share/models/tetraspine3_motors.yaml";

RobotSpec Robot() {
  Diagnostics found;
  auto robot = LoadRobot(kMotors, {}, found);
  EXPECT_TRUE(robot) << found.Format();
  return *robot;
}

RobotSessionOptions OptionsOf(const RobotSpec& robot) {
  RobotSessionOptions options;
  options.robot = robot;
  options.cables = link::MotorNames(robot);
  options.port = "/dev/robot";
  return options;
}

/// Returns a state in which all boards hold, motor m at 10 + m N.
State Holding(double time_s) {
  State state;
  state.time_s = time_s;
  state.stage = link::Stage::kActive;
  state.commanded = board::Mode::kHold;
  state.link.connected = true;
  state.motors.resize(board::kCables);
  state.boards.resize(board::kBoards);
  for (std::size_t m = 0; m < state.motors.size(); ++m) {
    state.motors[m].tension_n = 10.0 + static_cast<double>(m);
    state.motors[m].set_point_n = 12;
    state.motors[m].rest_length_m = 0.2;
    state.motors[m].duty = 0.25;
  }
  for (link::BoardView& board : state.boards) {
    board.there = true;
    board.status.mode = board::Mode::kHold;
    board.status.referenced = true;
  }
  return state;
}

/// A robot session driven by a separate thread, with a server
class RobotPage {
 public:
  explicit RobotPage(RobotSessionOptions options) {
    auto session = std::make_unique<RobotSession>("a robot", std::move(options));
    session_ = session.get();
    serving_ = std::make_unique<Serving>(std::move(session));
    thread_ = std::thread([this] {
      for (double time_s = 100; !ends_; time_s += 0.01) {
        State state;
        {
          const std::lock_guard lock(mutex_);
          state = state_;
        }
        state.time_s = time_s;
        session_->Show(state);
        for (const RobotCommand& command : session_->TakeCommands()) {
          const std::lock_guard lock(mutex_);
          commands_.push_back(command);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~RobotPage() {
    ends_ = true;
    thread_.join();
  }

  std::uint16_t port() const { return serving_->port(); }
  RobotSession& session() { return *session_; }
  void SetState(const State& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
  }
  /// Waits for the next command of a kind.
  RobotCommand Await(Kind kind) {
    for (;;) {
      {
        const std::lock_guard lock(mutex_);
        while (!commands_.empty()) {
          const RobotCommand command = commands_.front();
          commands_.erase(commands_.begin());
          if (command.kind == kind) return command;
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  std::size_t waiting() {
    const std::lock_guard lock(mutex_);
    return commands_.size();
  }

 private:
  RobotSession* session_ = nullptr;
  std::unique_ptr<Serving> serving_;
  std::mutex mutex_;
  State state_ = Holding(0);
  std::vector<RobotCommand> commands_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

Json AwaitStatus(Client& client, const std::function<bool(const Json&)>& wanted) {
  const Json message = client.AwaitText(
      [&](const Json& text) { return text["type"] == "robot" && wanted(text["status"]); });
  return message.is_null() ? message : message["status"];
}

bool Any(const Json&) { return true; }

TEST(RobotSession, ShowsWhatBoardsSayToAllAndInPlots) {
  const RobotSpec robot = Robot();
  RobotPage page(OptionsOf(robot));
  Client client(page.port(), kToWatch);
  EXPECT_EQ(client.Await("hello")["mode"], "robot");
  const Json scene = client.Await("scene")["scene"];
  EXPECT_EQ(scene["robot"]["motors"].size(), 12u);
  EXPECT_EQ(scene["robot"]["gains"].size(), 4u);
  EXPECT_EQ(scene["robot"]["true_pose"], false);
  const Json status = AwaitStatus(client, Any);
  EXPECT_EQ(status["stage"], "active");
  EXPECT_EQ(status["commanded"], "hold");
  EXPECT_EQ(status["boards"].size(), 6u);
  EXPECT_EQ(status["boards"][2]["well"], true);
  EXPECT_EQ(status["motors"][3]["tension_n"], 13.0);
  EXPECT_EQ(status["motors"][3]["gains"][0], nullptr) << "no board has said";
  EXPECT_EQ(status["alarms"], Json::array());

  const ReceivedFrame frame =
      client.AwaitFrame([](const ReceivedFrame& one) { return one[viewer::kFrameTimeS] > 0.05; });
  double most_n = 0;
  for (std::size_t c = 0; c < frame.Count(viewer::kFrameCableCount); ++c) {
    const double n = frame.numbers[frame.cables() + c * viewer::kFrameCablesValues];
    if (n > most_n) most_n = n;
  }
  EXPECT_EQ(most_n, 21.0);
  const std::string cable = scene["robot"]["motors"][0];
  for (const auto& [channel, value] : {std::pair{"cable/" + cable + "/tension_n", 10.0},
                                       {"cable/" + cable + "/duty", 0.25},
                                       {std::string("board/1/mode"), 1.0}}) {
    client.Send({{"type", "want_series"},
                 {"id", 7},
                 {"channel", channel},
                 {"t0", 0},
                 {"t1", 100},
                 {"points", 100}});
    const Json series = client.Await("series")["series"];
    ASSERT_FALSE(series["first"].empty()) << channel;
    EXPECT_EQ(series["first"][0], value) << channel;
  }
}

TEST(RobotSession, OneDrivesAndEverybodyWithTheTokenMayStop) {
  RobotPage page(OptionsOf(Robot()));
  Client driver(page.port()), other(page.port()), watcher(page.port(), kToWatch);
  const int stops = other.Await("hello")["client"];
  driver.Send({{"type", "robot_mode"}, {"mode", "arm"}});
  const int drives = page.Await(Kind::kArm).client;
  other.Send({{"type", "robot_mode"}, {"mode", "hold"}});
  EXPECT_NE(other.Await("error")["text"].get<std::string>().find("take control"),
            std::string::npos);
  watcher.Send({{"type", "stop"}});
  EXPECT_NE(watcher.Await("error")["text"].get<std::string>().find("watching"), std::string::npos);
  EXPECT_EQ(page.waiting(), 0u);

  other.Send({{"type", "stop"}});
  EXPECT_EQ(page.Await(Kind::kStop).client, stops);
  // Sending a stop does not transfer control.
  driver.Send({{"type", "robot_mode"}, {"mode", "impedance"}});
  EXPECT_EQ(page.Await(Kind::kImpedance).client, drives);
}

TEST(RobotSession, AStopForgetsWhatWaits) {
  RobotSession session("a robot", OptionsOf(Robot()));
  viewer::Command hold, stop;
  hold.type = "robot_mode";
  hold.mode = "hold";
  stop.type = "stop";
  EXPECT_TRUE(session.Post(1, hold));
  EXPECT_TRUE(session.Post(2, stop));
  const auto commands = session.TakeCommands();
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].kind, Kind::kStop);
  EXPECT_TRUE(session.TakeCommands().empty());
}

TEST(RobotSession, WhatIsWrongIsSaidInWords) {
  RobotPage page(OptionsOf(Robot()));
  Client client(page.port());
  const auto says = [&](const State& state, const std::string& what) {
    page.SetState(state);
    const Json status = AwaitStatus(client, [&](const Json& one) {
      return one["alarms"].dump().find(what) != std::string::npos;
    });
    EXPECT_FALSE(status.is_null()) << what;
  };
  State state = Holding(0);
  state.boards[3].there = false;
  says(state, "board 3 does not answer");
  state = Holding(0);
  state.motors[2].faults = board::kStall;
  says(state, "stall");
  state = Holding(0);
  state.boards[5].status.timeout = true;
  says(state, "board 5 timed out without a broadcast");
  state = Holding(0);
  state.link.connected = false;
  says(state, "the adapter at /dev/robot is gone");
  state = Holding(0);
  state.stopping = true;
  says(state, "emergency stop");
  page.SetState(Holding(0));
  AwaitStatus(client, [](const Json& one) { return one["alarms"].empty(); });
}

TEST(RobotSession, WhoStopsShowingIsAnAlarm) {
  Serving* serving = nullptr;
  auto session = std::make_unique<RobotSession>("a robot", OptionsOf(Robot()));
  session->Show(Holding(100));
  Serving here(std::move(session));
  serving = &here;
  Client client(serving->port());
  AwaitStatus(client, [](const Json& one) {
    return one["alarms"].dump().find("no cycle for") != std::string::npos;
  });
}

TEST(RobotSession, AGainGoesToItsMotorAndTheAnswerToAll) {
  const RobotSpec robot = Robot();
  RobotPage page(OptionsOf(robot));
  Client driver(page.port()), other(page.port(), kToWatch);
  const std::string cable = link::MotorNames(robot)[5];
  driver.Send({{"type", "robot_gain"},
               {"cable", cable},
               {"gain", "velocity_gain_n_s_per_m"},
               {"value", 42.5}});
  const RobotCommand command = page.Await(Kind::kGain);
  EXPECT_EQ(command.motor, 5);
  EXPECT_EQ(command.gain, board::kVelocityGain);
  EXPECT_EQ(command.value, 42.5);
  page.session().AnswerGain(command, true, "good");
  const Json answer = other.Await("gain_answer");
  EXPECT_EQ(answer["cable"], cable);
  EXPECT_EQ(answer["good"], true);
  AwaitStatus(other, [](const Json& one) { return one["motors"][5]["gains"][3] == 42.5; });

  driver.Send(
      {{"type", "robot_gain"}, {"cable", "none"}, {"gain", "length_offset_m"}, {"value", 1}});
  EXPECT_NE(driver.Await("error")["text"].get<std::string>().find("there is no actuated cable"),
            std::string::npos);
  page.session().Refuse(1, "because");
  EXPECT_EQ(driver.Await("error")["text"], "because");
}

TEST(RobotSession, EventsAreThereForThoseWhoComeLate) {
  RobotPage page(OptionsOf(Robot()));
  page.session().Event(100.5, "board 1: off -> hold");
  Client late(page.port());
  const Json status = AwaitStatus(late, [](const Json& one) { return !one["events"].empty(); });
  EXPECT_EQ(status["events"][0]["text"], "board 1: off -> hold");
}

/// Counts the recorded rows and ends.
class Notes final : public viewer::RobotRecorder {
 public:
  struct Kept {
    std::atomic<int> rows{0}, ends{0};
  };
  explicit Notes(Kept& kept) : kept_(kept) {}
  std::string Begin(double, std::string&) override { return "a/folder"; }
  void Take(const State&) override { ++kept_.rows; }
  void Event(double, const std::string&) override {}
  bool End(std::string&) override { return ++kept_.ends > 0; }

 private:
  Kept& kept_;
};

TEST(RobotSession, RecordsEveryCycleWhileItIsAskedTo) {
  Notes::Kept kept;
  {
    RobotSessionOptions options = OptionsOf(Robot());
    options.recorder = std::make_unique<Notes>(kept);
    RobotPage page(std::move(options));
    Client client(page.port());
    AwaitStatus(client, [](const Json& one) { return one["recording"] == ""; });
    EXPECT_EQ(kept.rows, 0);
    client.Send({{"type", "record"}, {"on", true}});
    AwaitStatus(client,
                [&](const Json& one) { return one["recording"] == "a/folder" && kept.rows > 10; });
    client.Send({{"type", "record"}, {"on", false}});
    AwaitStatus(client, [](const Json& one) { return one["recording"] == ""; });
    EXPECT_EQ(kept.ends, 1);
  }
  EXPECT_EQ(kept.ends, 1);
}

TEST(RobotSession, TheTruePoseComesFromTheSocketAndStaysDescribedWithout) {
  const RobotSpec robot = Robot();
  const std::string path = testing::TempDir() + "taut_truth_" + std::to_string(getpid());
  std::remove(path.c_str());
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof address.sun_path);
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(listener, 1), 0);

  RobotSessionOptions options = OptionsOf(robot);
  options.truth = path;
  RobotPage page(std::move(options));
  Client client(page.port());
  EXPECT_EQ(client.Await("scene")["scene"]["robot"]["true_pose"], false);
  const int caller = accept(listener, nullptr, nullptr);
  Json bodies = Json::array();
  for (std::size_t b = 0; b < robot.def.bodies.size(); ++b) bodies.push_back({7, 8, 9, 1, 0, 0, 0});
  // In two pieces, after a line that contains the names of the numbers.
  const std::string text = "{\"format\":\"taut_truth\",\"bodies\":[]}\n" +
                           Json{{"time_s", 0.02}, {"bodies", bodies}}.dump() + "\n";
  ASSERT_GT(send(caller, text.data(), 60, 0), 0);
  ASSERT_GT(send(caller, text.data() + 60, text.size() - 60, 0), 0);
  client.AwaitText([](const Json& message) {
    return message["type"] == "scene" && message["scene"]["robot"]["true_pose"] == true;
  });
  client.AwaitFrame([](const ReceivedFrame& frame) { return frame.numbers[frame.bodies()] == 7; });
  close(caller);
  client.AwaitText([](const Json& message) {
    return message["type"] == "scene" && message["scene"]["robot"]["true_pose"] == false;
  });
  close(listener);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace taut::test
