// Commands of `taut robot` with adapters that fail while motors have power: their power messages
// are correct, and they end.

#include "link/hostile_adapter.h"

#include <sys/resource.h>

#include <chrono>

#include "taut/files.h"
#include "taut/run_folder.h"
#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

using link::HostileAdapter, link::Hostility;
using Clock = std::chrono::steady_clock;

/// Timeout for an end within a second, with margin for busy machines.
constexpr double kSoon_s = 20;
/// Timeout for a command to start and to notice an attack, for which nothing is promised.
constexpr double kEventually_s = 120;
/// Number of trials of a test that counts only if the machine does not delay adapter and command.
constexpr int kTries = 20;
/// Frames with power before an attack: some cycles of one broadcast and two reads.
constexpr int kFrames = 30;
/// Frames of any command before an attack, and frames, answered or not, after it.
constexpr int kFirstFrames = 5, kFurtherFrames = 3;

class HostileRobot : public CommandTest {
 protected:
  pid_t StartRobot(const HostileAdapter& adapter, std::vector<std::string> words,
                   const std::string& runtime = "runtime",
                   const std::function<void()>& before = {}) {
    words.insert(words.begin(), "robot");
    words.insert(words.end(), {"--port", adapter.device()});
    const std::string folder = Path(runtime);
    std::filesystem::create_directories(folder);
    return Start(words, [&] {
      setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
      std::signal(SIGINT, SIG_DFL);  // ignored if a script started the test in the background
      if (before) before();
    });
  }
  CommandResult Robot(const HostileAdapter& adapter, std::vector<std::string> words,
                      const std::string& runtime = "runtime") {
    return End(StartRobot(adapter, std::move(words), runtime));
  }
  pid_t StartHold(const HostileAdapter& adapter, std::vector<std::string> more = {}) {
    const CommandResult reference = Robot(adapter, {"reference", "--as_model"});
    EXPECT_EQ(reference.status, 0) << reference.errors;
    more.insert(more.begin(), "hold");
    return StartRobot(adapter, more);
  }
  /// Starts `taut robot hold`, returns once motors have had power.
  pid_t Hold(const HostileAdapter& adapter) {
    const pid_t hold = StartHold(adapter);
    Await([&] { return adapter.HadPower(); });
    return hold;
  }
  template <class F>
  void Await(const F& done, double patience_s = kSoon_s) {
    const auto begun = Clock::now();
    while (!done() && std::chrono::duration<double>(Clock::now() - begun).count() < patience_s) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_TRUE(done());
  }
  static bool HasEnded(pid_t pid) {
    siginfo_t ended{};
    return waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOWAIT | WNOHANG) == 0 &&
           ended.si_pid == pid;
  }
  /// Waits for the end of a process, at most kSoon_s.
  CommandResult EndSoon(pid_t pid) {
    Await([&] { return HasEnded(pid); });
    if (!HasEnded(pid)) kill(pid, SIGKILL);
    return End(pid);
  }
  /// Number of lines that a command has printed.
  int Lines() const { return Count(Read(Path("out.txt")) + Read(Path("err.txt")), "\n"); }
  static int Count(const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  }
};

TEST_F(HostileRobot, SaysOffOnceWhenAllBoardsHaveConfirmedIt) {
  for (int tries = 0; tries < kTries; ++tries) {
    HostileAdapter adapter(Hostility::kNone);
    const CommandResult done = EndSoon(StartHold(adapter, {"--duration_s", "0.3"}));
    const int says_off = Count(done.output, "Motors are off.");
    EXPECT_EQ(says_off, Count(done.output, "confirmed by 6 of 6 boards")) << done.output;
    EXPECT_FALSE(says_off > 0 && adapter.AnyPower());
    if (done.status == 0) {
      EXPECT_EQ(says_off, 1) << done.output;
      return;
    }
    EXPECT_GT(adapter.delays(), 0) << done.output << done.errors;
  }
  ADD_FAILURE() << "the machine delayed all of " << kTries << " trials";
}

class HostileHold : public HostileRobot, public testing::WithParamInterface<Hostility> {};

TEST_P(HostileHold, EndsByItsDurationAndSaysNothingUnconfirmed) {
  for (int tries = 0; tries < kTries; ++tries) {
    HostileAdapter adapter(GetParam());
    adapter.AttackAfterFramesWithPower(kFrames);
    const CommandResult done = EndSoon(StartHold(adapter, {"--duration_s", "1.5"}));
    if (!adapter.HasAttackedPower()) continue;  // so busy that the duration ended before
    EXPECT_EQ(done.status, 1) << done.errors;
    EXPECT_EQ(Count(done.output + done.errors, "Motors are off."), 0) << done.output;
    EXPECT_NE(done.errors.find("has not confirmed that its motors are off"), std::string::npos)
        << done.errors;
    EXPECT_NE(done.errors.find("holds its motors with power"), std::string::npos) << done.errors;
    return;
  }
  ADD_FAILURE() << "the machine delayed all of " << kTries << " trials";
}

TEST_P(HostileHold, EndsByAnInterrupt) {
  for (const int signal : {SIGINT, SIGTERM}) {
    HostileAdapter adapter(GetParam());
    adapter.AttackAfterFramesWithPower(kFrames);
    const pid_t hold = StartHold(adapter);
    Await([&] { return adapter.HasAttackedPower() || HasEnded(hold); });
    EXPECT_TRUE(adapter.HasAttackedPower() || adapter.delays() > 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    kill(hold, signal);
    const CommandResult done = EndSoon(hold);
    if (!adapter.HasAttackedPower()) continue;  // the machine was so busy that the hold ended
    EXPECT_EQ(done.status, 1) << done.errors;   // not 130: motors may have power
    EXPECT_EQ(Count(done.output + done.errors, "Motors are off."), 0) << done.output;
  }
}

TEST_P(HostileHold, LogEndsByItsDuration) {
  HostileAdapter adapter(GetParam());
  const pid_t log = StartRobot(adapter, {"log", "--duration_s", "1", "--out", "log"});
  Await([&] { return std::filesystem::exists(Path("log/events.jsonl")); });
  adapter.Attack();
  EXPECT_GE(EndSoon(log).status, 0);
}

INSTANTIATE_TEST_SUITE_P(Adapters, HostileHold,
                         testing::Values(Hostility::kSilent, Hostility::kUnplugged));
INSTANTIATE_TEST_SUITE_P(Long, HostileHold,
                         testing::Values(Hostility::kGarbage, Hostility::kHalf, Hostility::kFlood,
                                         Hostility::kUnread));

/// Arguments of a command of `taut robot`; `experiment`: it also gets an experiment file.
struct RobotCommand {
  std::vector<std::string> words;
  bool experiment = false;
};

class HostileCommand
    : public HostileRobot,
      public testing::WithParamInterface<std::tuple<RobotCommand, Hostility, bool>> {};

TEST_P(HostileCommand, EndsByAnInterruptAndSaysNothingUnconfirmed) {
  const auto& [command, hostility, from_start] = GetParam();
  HostileAdapter adapter(hostility);
  std::vector<std::string> words = command.words;
  if (command.experiment) {
    CommandResult reference;
    for (int tries = 0; tries < kTries && reference.status != 0; ++tries) {
      reference = Robot(adapter, {"reference", "--as_model"});  // fails if the machine delays it
    }
    EXPECT_EQ(reference.status, 0) << reference.errors;
    words.push_back(
        Write("drive.yaml",
              "taut: 1\nkind: experiment\nname: drive\nduration_s: 60\nbase: " TAUT_SOURCE_DIR
              "/share/experiments/push_20n_motors.yaml\n"));
  }
  if (from_start) adapter.Attack();
  const int frames_before = adapter.frames();
  const pid_t robot = StartRobot(adapter, words);
  if (!from_start) {
    Await([&] { return adapter.frames() >= frames_before + kFirstFrames || HasEnded(robot); },
          kEventually_s);
    adapter.Attack();
  }
  // The command has noticed the attack if it has sent further frames, printed a line or ended.
  const int frames = adapter.frames(), lines = Lines();
  Await(
      [&] {
        return adapter.frames() >= frames + kFurtherFrames || Lines() > lines || HasEnded(robot);
      },
      kEventually_s);
  const int further = adapter.frames() - frames;
  kill(robot, SIGINT);
  const CommandResult done = EndSoon(robot);
  SCOPED_TRACE(std::to_string(further) + " further frames\n" + done.output + done.errors);
  const bool says_off = Count(done.output + done.errors, "Motors are off.") > 0;
  EXPECT_FALSE(says_off && adapter.AnyPower()) << done.output << done.errors;
  if (from_start) {  // nothing was ever confirmed
    EXPECT_NE(done.status, 0) << done.output << done.errors;
    EXPECT_FALSE(says_off) << done.output << done.errors;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Adapters, HostileCommand,
    testing::Combine(
        testing::Values(RobotCommand{{"scan"}}, RobotCommand{{"status"}},
                        RobotCommand{{"run", "--quiet", "--out", "drive"}, true},
                        RobotCommand{{"hold"}}, RobotCommand{{"log", "--out", "log"}},
                        RobotCommand{{"calibrate", "encoder", "outer_top_1", "--way_m", "0.1"}},
                        RobotCommand{{"calibrate", "load_cell", "outer_top_1"}},
                        RobotCommand{{"reference", "--as_model"}}, RobotCommand{{"release"}},
                        RobotCommand{{"set", "duty_limit=0.5"}},
                        RobotCommand{{"selftest", "--move"}}, RobotCommand{{"estop"}}),
        testing::Values(Hostility::kSilent, Hostility::kUnplugged), testing::Bool()));

/// Recordings that replace a finished run of the robot in the same folder.
class ReplacedRobotRun : public HostileRobot {
 protected:
  const std::vector<std::vector<std::string>> recording_{
      {"log", "--quiet", "--duration_s", "0.3", "--out", "one"},
      {"run", "drive.yaml", "--quiet", "--out", "one"}};

  /// Leaves a finished run in the folder `one`.
  void FinishRun(const HostileAdapter& adapter) {
    Write("drive.yaml",
          "taut: 1\nkind: experiment\nname: drive\nduration_s: 0.3\nbase: " TAUT_SOURCE_DIR
          "/share/experiments/push_20n_motors.yaml\n"
          "timeline: {phases: {before: [0, 0.1], during: [0.1, 0.2], after: [0.2, 0.3]}}\n");
    CommandResult done;
    for (int tries = 0; tries < kTries && done.status != 0; ++tries) {
      if (Robot(adapter, {"reference", "--as_model"}).status == 0) {
        done = Robot(adapter, recording_.back());
      }
    }
    EXPECT_EQ(done.status, 0) << done.errors;
    EXPECT_TRUE(std::filesystem::exists(Path("one/host.h5")));
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(Path("one"))) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(ReplacedRobotRun, IsTheOldOrTheNewAfterAKill) {
  for (const std::vector<std::string>& words : recording_) {
    bool replaced = false;
    for (int tries = 0; tries < kTries && !replaced; ++tries) {
      std::filesystem::remove_all(Path("one"));
      HostileAdapter adapter(Hostility::kNone);
      FinishRun(adapter);
      const std::string trace = Path("one/trace.h5");
      const FileIdentity before = IdentityOf(trace);
      const pid_t robot = StartRobot(adapter, words);
      while (IdentityOf(trace) == before && !HasEnded(robot)) {
        std::this_thread::sleep_for(std::chrono::microseconds(50));
      }
      kill(robot, SIGKILL);
      replaced = End(robot).status == 128 + SIGKILL;
      Diagnostics found;
      const auto read = ReadTraceOfRun(Path("one"), found);
      ASSERT_TRUE(read) << words[0] << ": " << found.Format();
      EXPECT_GE(read->time_s.size(), 1u);
      const bool has_experiment = std::filesystem::exists(Path("one/inputs.yaml"));
      EXPECT_EQ(has_experiment, words[0] == "run");
      EXPECT_FALSE(std::filesystem::exists(Path("one/summary.json")));
    }
    EXPECT_TRUE(replaced) << words[0];
  }
}

TEST_F(ReplacedRobotRun, IsTheOldIfTheNewCannotBegin) {
  HostileAdapter adapter(Hostility::kNone);
  FinishRun(adapter);
  const std::vector<std::string> names = Names();
  const FileIdentity before = IdentityOf(Path("one/trace.h5"));
  for (const std::vector<std::string>& words : recording_) {
    const CommandResult full = End(StartRobot(adapter, words, "runtime", [] {
      const rlimit size{1000, 1000};  // acts like a full disk
      setrlimit(RLIMIT_FSIZE, &size);
    }));
    EXPECT_EQ(full.status, 1) << full.errors;
    EXPECT_EQ(Names(), names) << words[0];
    EXPECT_TRUE(IdentityOf(Path("one/trace.h5")) == before);
  }
}

TEST_F(ReplacedRobotRun, IsGoneAfterTheNewOne) {
  HostileAdapter adapter(Hostility::kNone);
  FinishRun(adapter);
  const std::string events = Read(Path("one/events.jsonl"));
  EXPECT_NE(events, "");
  const FileIdentity before = IdentityOf(Path("one/trace.h5"));
  const CommandResult done = Robot(adapter, recording_.front());
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_FALSE(IdentityOf(Path("one/trace.h5")) == before);
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "events.jsonl", "trace.h5"}));
}

TEST_F(HostileRobot, OneProgramDrivesWhateverTheRuntimeFolder) {
  HostileAdapter adapter(Hostility::kNone);
  const pid_t hold = Hold(adapter);
  std::filesystem::rename(Path("out.txt"), Path("hold.txt"));
  std::filesystem::rename(Path("err.txt"), Path("hold_errors.txt"));
  const CommandResult second = Robot(adapter, {"status"}, "elsewhere");
  EXPECT_EQ(second.status, 1);
  EXPECT_NE(second.errors.find("process " + std::to_string(hold) + " drives this robot"),
            std::string::npos)
      << second.errors;
  // If the machine delays the driving process by a second, the command stops the boards directly.
  CommandResult stop;
  for (int tries = 0; tries < kTries && stop.status != 0; ++tries) {
    stop = Robot(adapter, {"estop"}, "elsewhere");
  }
  EXPECT_EQ(stop.status, 0) << stop.errors;
  const bool driver_stopped = stop.output.find("All boards have stopped") != std::string::npos;
  EXPECT_TRUE(driver_stopped || stop.output.find("All 6 boards have stopped") != std::string::npos)
      << stop.output;
  EXPECT_FALSE(adapter.AnyPower());
  EXPECT_EQ(EndSoon(hold).status, 1);
}

TEST_F(HostileRobot, AnEmergencyStopIsAnsweredWhileTheAdapterIsSilent) {
  HostileAdapter adapter(Hostility::kSilent);
  const pid_t hold = Hold(adapter);
  std::filesystem::rename(Path("out.txt"), Path("hold.txt"));
  std::filesystem::rename(Path("err.txt"), Path("hold_errors.txt"));
  adapter.Attack();
  const CommandResult stop = EndSoon(StartRobot(adapter, {"estop"}, "elsewhere"));
  EXPECT_EQ(stop.status, 1) << stop.output;
  EXPECT_NE(stop.errors.find("cut the motors' supply"), std::string::npos) << stop.errors;
  EXPECT_EQ(EndSoon(hold).status, 1);
}

}  // namespace
}  // namespace taut::test
