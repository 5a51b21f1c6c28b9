// `taut robot` against the virtual robot. Commands that power motors run in real time, and a busy
// machine may miss a board's deadline: these tests have the label LONG.
#include <sys/prctl.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "taut/calibration.h"
#include "taut/trace.h"
#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

using Json = nlohmann::json;

class RobotCommand : public CommandTest {
 protected:
  ~RobotCommand() override {
    if (robot_ > 0) {
      kill(robot_, SIGTERM);
      waitpid(robot_, nullptr, 0);
    }
  }

  /// Runs `taut robot ...` with a virtual robot of this test only.
  CommandResult Robot(std::vector<std::string> words, const std::string& typed = "") {
    return End(StartCommand(std::move(words), typed));
  }
  pid_t StartCommand(std::vector<std::string> words, const std::string& typed = "") {
    words.insert(words.begin(), "robot");
    Write("typed.txt", typed);
    const std::string folder = folder_.string();
    return Start(words, [&] {
      setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
      setenv("TAUT_VIRTUAL_ROBOT", TAUT_VIRTUAL_ROBOT, 1);
      const int in = open("typed.txt", O_RDONLY);
      dup2(in, STDIN_FILENO);
    });
  }
  /// Starts a virtual robot, just powered on, that runs through several commands.
  std::string StartRobot() {
    const std::string link = Path("robot"), out = Path("robot.txt");
    robot_ = fork();
    if (robot_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const int file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
      dup2(file, STDOUT_FILENO);
      execl(TAUT_VIRTUAL_ROBOT, TAUT_VIRTUAL_ROBOT, "--model",
            TAUT_SOURCE_DIR "/share/models/tetraspine3_motors.yaml", "--link", link.c_str(),
            "--stand", static_cast<char*>(nullptr));
      _exit(97);
    }
    while (Read(out).find('\n') == std::string::npos && waitpid(robot_, nullptr, WNOHANG) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return link;
  }
  /// Waits until a command prints this text.
  void WaitFor(const std::string& text) const {
    for (int i = 0; i < 3000 && Read(Path("out.txt")).find(text) == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  pid_t robot_ = -1;
};

TEST_F(RobotCommand, ScanFindsSixBoards) {
  const CommandResult done = Robot({"scan", "--port", "virtual", "--json"});
  ASSERT_EQ(done.status, 0) << done.errors;
  const Json said = Json::parse(done.output);
  EXPECT_EQ(said["adapter"]["module_id"], 7);
  ASSERT_EQ(said["found"].size(), 6u);
  for (int b = 0; b < 6; ++b) {
    EXPECT_EQ(said["found"][static_cast<std::size_t>(b)]["address"], 0x10 + b);
    EXPECT_EQ(said["found"][static_cast<std::size_t>(b)]["board"], b);
  }
}

TEST_F(RobotCommand, AVirtualRobotOfItsOwnIsWell) {
  const CommandResult done = Robot({"status", "--port", "virtual", "--json"});
  ASSERT_EQ(done.status, 0) << done.errors << done.output;
  const Json said = Json::parse(done.output);
  ASSERT_EQ(said["motors"].size(), 12u);
  EXPECT_NEAR(said["motors"][2]["tension_n"].get<double>(), 20.0, 0.5)
      << "outer_top_1 on its stand";
  EXPECT_NEAR(said["motors"][0]["tension_n"].get<double>(), 7.0, 0.5);
  EXPECT_EQ(said["boards"][5]["referenced"], true);
  EXPECT_EQ(said["boards"][5]["mode"], "off");
}

TEST_F(RobotCommand, AnEmergencyStopLastsUntilSomebodyTakesItBack) {
  const std::string port = StartRobot();
  const CommandResult before = Robot({"status", "--port", port});
  EXPECT_EQ(before.status, 0) << before.output;
  EXPECT_NE(before.output.find("restarted (power_on)"), std::string::npos) << before.output;
  ASSERT_EQ(Robot({"estop", "--port", port}).status, 0);
  const CommandResult refused = Robot({"hold", "--port", port, "--duration_s", "0"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.errors.find("board 0 is not ready: stopped"), std::string::npos)
      << refused.errors;
  EXPECT_NE(refused.errors.find("--clear_faults"), std::string::npos) << refused.errors;
}

TEST_F(RobotCommand, WhatIsSetIsReadAndKept) {
  const std::string port = StartRobot();
  CommandResult done =
      Robot({"set", "tension_limit_n=40", "--cable", "outer_top_1", "--port", port, "--store"});
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_EQ(done.output, "1 values set and stored in the boards' memories.\n");
  done = Robot({"set", "--port", port, "--json"});
  ASSERT_EQ(done.status, 0) << done.errors;
  const Json said = Json::parse(done.output);
  EXPECT_EQ(said["outer_top_1"]["tension_limit_n"], 40.0);
  EXPECT_EQ(said["outer_left_1"]["tension_limit_n"], 50.0);
  EXPECT_EQ(said["board 3"]["supply_v"], 12.0);
}

TEST_F(RobotCommand, ReferencesAreWhatStatusShows) {
  const std::string port = StartRobot();
  ASSERT_EQ(Robot({"reference", "outer_top_1=0.19", "outer_left_1=0.2", "--port", port}).status, 0);
  const Json said = Json::parse(Robot({"status", "--port", port, "--json"}).output);
  // Counts of 13.4 um from 0.2 m, the boards' default.
  EXPECT_NEAR(said["motors"][2]["rest_length_m"].get<double>(), 0.19, 1e-5);
  EXPECT_NEAR(said["motors"][2]["encoder_counts"].get<double>(), 746, 1);
  EXPECT_EQ(said["motors"][1]["encoder_counts"], 0);
  EXPECT_EQ(said["boards"][0]["referenced"], false) << "its other motor is not";
}

TEST_F(RobotCommand, ALoadCellIsCalibratedByWhatHangsOnIt) {
  // The stand applies 7 N to each cable, whatever the requested force: equal readings do not define
  // a line.
  const CommandResult done =
      Robot({"calibrate", "load_cell", "outer_left_1", "--force_n", "0", "10", "--port", "virtual"},
            "\n\n");
  EXPECT_EQ(done.status, 1);
  EXPECT_NE(done.output.find("0 N: 76."), std::string::npos) << done.output;
  EXPECT_NE(done.errors.find("do not rise with the force"), std::string::npos) << done.errors;
  EXPECT_FALSE(std::filesystem::exists(Path("calibration.yaml")));
  EXPECT_EQ(
      Robot({"calibrate", "load_cell", "outer_left_1", "--force_n", "5", "5", "--port", "virtual"})
          .status,
      2);
}

TEST_F(RobotCommand, LogRecordsARowACycle) {
  const CommandResult done =
      Robot({"log", "--port", "virtual", "--duration_s", "0.3", "--out", "log", "--quiet"});
  ASSERT_EQ(done.status, 0) << done.errors;
  Diagnostics found;
  const auto trace = ReadTrace(Path("log/trace.h5"), found);
  ASSERT_TRUE(trace.has_value()) << found.Format();
  EXPECT_GE(trace->time_s.size(), 3u);
  const auto tension = trace->Find("cable/outer_top_1/tension_n");
  ASSERT_TRUE(tension.has_value());
  EXPECT_NEAR(trace->values[*tension].back(), 20.0, 0.5);
  EXPECT_TRUE(std::filesystem::exists(Path("log/events.jsonl")));
}

TEST_F(RobotCommand, SelftestLooksAndMovesNothing) {
  const CommandResult done = Robot({"selftest", "--port", "virtual"});
  EXPECT_EQ(done.status, 0) << done.output << done.errors;
  EXPECT_EQ(done.output.find("wound"), std::string::npos);
}

TEST_F(RobotCommand, AnEmergencyStopReachesBoardsThatNobodyDrives) {
  const std::string port = StartRobot();
  const CommandResult done = Robot({"estop", "--port", port});
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_EQ(done.output, "All 6 boards have stopped.\n");
  const Json said = Json::parse(Robot({"status", "--port", port, "--json"}).output);
  EXPECT_EQ(said["boards"][0]["mode"], "stopped");
  const CommandResult none = Robot({"estop", "--port", "virtual"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.errors.find("no virtual robot is running"), std::string::npos);
}

TEST_F(RobotCommand, WrongInputsAreSaid) {
  struct Wrong {
    std::vector<std::string> words;
    int status;
    std::string says;
  };
  const std::string push = TAUT_SOURCE_DIR "/share/experiments/push_20n_motors.yaml";
  for (const Wrong& one : std::vector<Wrong>{
           {{"scan", "--port", "/dev/nothing"}, 1, "cannot open"},
           {{"set", "duty_limt=0.5", "--port", "virtual"}, 3, "did you mean \"duty_limit\"?"},
           {{"set", "duty_limit=2", "--port", "virtual"}, 3, "the value must be within 0 .. 1"},
           {{"reference", "--port", "virtual"}, 3, "the rest lengths are missing"},
           {{"reference", "outer_top_1=x", "--port", "virtual"}, 3, "CABLE=REST_LENGTH_M"},
           {{"reference", "outer_tp_1=0.2", "--port", "virtual"}, 3, "did you mean"},
           {{"hold", "--on_fault", "pray"}, 2, "pray"},
           {{"flash", "--board", "6"}, 2, "6"},
           {{"flash", "--board", "1", "--hex", "none.hex"}, 3, "the firmware file is missing"},
           {{"run", TAUT_SOURCE_DIR "/share/experiments/hang.yaml"}, 3, "no cable has an actuator"},
           {{"run", "none.yaml"}, 3, "none.yaml"},
           {{"run", push, "--calibration", "none.yaml", "--port", "virtual"}, 3, "none.yaml"},
           {{"status", "--model", "none.yaml"}, 3, "none.yaml"},
           {{"calibrate"}, 2, "load_cell"},
           {{"wave"}, 2, "wave"}}) {
    const CommandResult done = Robot(one.words);
    EXPECT_EQ(done.status, one.status) << one.words[0] << ": " << done.errors;
    EXPECT_NE((done.output + done.errors).find(one.says), std::string::npos)
        << one.words[0] << ": " << done.errors;
  }
}

TEST_F(RobotCommand, ADryRunOpensNothing) {
  const std::string push = TAUT_SOURCE_DIR "/share/experiments/push_20n_motors.yaml";
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"hold", "--dry-run"},
                                             {"release", "--dry_run"},
                                             {"run", push, "--dry-run"},
                                             {"set", "duty_limit=0.5", "--dry_run"},
                                             {"reference", "--as_model", "--dry_run"},
                                             {"selftest", "--move", "--dry_run"}}) {
    const CommandResult done = Robot(words);
    EXPECT_EQ(done.status, 0) << words[0] << ": " << done.errors;
    EXPECT_NE(done.output.find("would"), std::string::npos) << words[0];
  }
  Write("board.hex", "");
  const CommandResult flash =
      Robot({"flash", "--board", "3", "--hex", "board.hex", "--port", "/dev/x", "--dry_run"});
  EXPECT_EQ(flash.output,
            "avrdude -p atmega328p -c arduino -P /dev/x -b 57600 -U flash:w:board.hex:i -U "
            "eeprom:w:0x03:m\n");
}

// --- in real time, with power --------------------------------------------------------------------

using RobotCommandInRealTime = RobotCommand;

TEST_F(RobotCommandInRealTime, HoldsUntilCtrlCAndIsOffThen) {
  const pid_t hold = StartCommand({"hold", "--port", "virtual"});
  WaitFor("1.0 s  hold");
  kill(hold, SIGINT);
  const CommandResult done = End(hold);
  EXPECT_EQ(done.status, 130) << done.errors;
  EXPECT_NE(done.errors.find("board 5: hold -> stopped"), std::string::npos) << done.errors;
  EXPECT_NE(done.output.find("Motors are off."), std::string::npos);
}

TEST_F(RobotCommandInRealTime, IsStoppedFromAnotherTerminal) {
  const pid_t hold = StartCommand({"hold", "--port", "virtual"});
  WaitFor("1.0 s  hold");
  std::filesystem::rename(Path("out.txt"), Path("hold.txt"));
  std::filesystem::rename(Path("err.txt"), Path("hold_errors.txt"));
  const CommandResult second = Robot({"status", "--port", "virtual"});
  EXPECT_EQ(second.status, 1);
  EXPECT_NE(second.errors.find("drives this robot"), std::string::npos) << second.errors;
  const CommandResult stop = Robot({"estop", "--port", "virtual"});
  EXPECT_EQ(stop.status, 0) << stop.errors;
  EXPECT_EQ(End(hold).status, 1);
  EXPECT_NE(Read(Path("hold_errors.txt")).find("hold -> stopped"), std::string::npos);
}

TEST_F(RobotCommandInRealTime, RunsAnExperiment) {
  const CommandResult done =
      Robot({"run", TAUT_SOURCE_DIR "/share/experiments/push_20n_motors.yaml", "--port", "virtual",
             "--duration_s", "2", "--out", "run"});
  ASSERT_EQ(done.status, 0) << done.errors;
  Diagnostics found;
  const auto trace = ReadTrace(Path("run/trace.h5"), found);
  const auto host = ReadTrace(Path("run/host.h5"), found);
  ASSERT_TRUE(trace && host) << found.Format();
  EXPECT_NEAR(trace->time_s.back(), 2.0, 0.01);
  // The spine is off the stand then: this cable carries more than its 20 N of before.
  const std::vector<double>& top = host->values[*host->Find("cable/inner_top_1/tension_n")];
  EXPECT_GT(*std::max_element(top.begin(), top.end()), 25.0);
  EXPECT_NE(Read(Path("run/events.jsonl")).find("hold -> impedance"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(Path("run/summary.json")));
}

}  // namespace
}  // namespace taut::test
