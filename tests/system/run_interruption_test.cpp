// `taut run` and interruptions: kill, Ctrl-C, full disks, unwritable folders
#include <pty.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <thread>

#include "taut/trace.h"
#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

constexpr double kRowS = 0.005;  // of share/experiments/hang.yaml
const std::string kHang = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";

/// A run that would take hours, with its progress on a terminal. It prints a line at most every 200
/// ms of wall time.
class LongRun {
 public:
  explicit LongRun(const std::string& folder, bool nohup = false) {
    std::vector<std::string> words{TAUT_COMMAND,   "run", kHang,   "--step_s", "1e-5",
                                   "--duration_s", "1e6", "--out", folder};
    pid_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ != 0) {
      // Otherwise other runs would inherit the terminal, and this run would not end with the test.
      fcntl(terminal_, F_SETFD, FD_CLOEXEC);
      return;
    }
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (nohup) signal(SIGHUP, SIG_IGN);
    execv(TAUT_COMMAND, arguments.data());
    _exit(97);
  }
  ~LongRun() {
    if (pid_ > 0) End(SIGKILL);
    if (terminal_ >= 0) close(terminal_);
  }

  /// Reads lines until there are `count`, or the run has ended.
  void ReadLines(std::size_t count) {
    char block[4096];
    while (times_.size() < count) {
      const ssize_t size = read(terminal_, block, sizeof block);
      if (size <= 0) return;
      text_.append(block, static_cast<std::size_t>(size));
      for (std::size_t at; (at = text_.find(" of 1e+06 s")) != text_.npos;) {
        const std::size_t from = text_.rfind("t = ", at);
        times_.push_back(std::strtod(text_.c_str() + from + 4, nullptr));
        text_.erase(0, at + 1);
      }
    }
  }

  void Send(int number) const { kill(pid_, number); }

  /// Sends the signal, reads the remaining output, and returns the exit status, or 128 + signal.
  int End(int number) {
    Send(number);
    ReadLines(SIZE_MAX);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }

  /// Returns the simulated times of the progress lines, as printed.
  const std::vector<double>& times() const { return times_; }

 private:
  pid_t pid_ = -1;
  int terminal_ = -1;
  std::string text_;
  std::vector<double> times_;
};

class Survival : public CommandTest {
 protected:
  /// Checks that rows are complete from the first on. Returns their number; nothing if the trace is
  /// invalid.
  static std::optional<std::size_t> Rows(const std::string& path) {
    Diagnostics out;
    const auto trace = ReadTrace(path, out);
    EXPECT_TRUE(trace) << out.Format();
    if (!trace) return std::nullopt;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < trace->time_s.size(); ++i) {
      wrong += !(std::fabs(trace->time_s[i] - static_cast<double>(i) * kRowS) < 1.01e-5);
      for (const auto& column : trace->values) wrong += !std::isfinite(column.at(i));
    }
    EXPECT_EQ(wrong, 0u) << "of " << trace->time_s.size() << " rows";
    return trace->time_s.size();
  }

  /// The fifth line before the last was printed at least one second before the last by the run's
  /// clock: rows up to its time must be in the trace.
  void ExpectAllButTheLastSecond(const LongRun& run, const std::string& path) {
    const auto rows = Rows(path);
    ASSERT_TRUE(rows);
    rows_read_ += *rows;
    if (run.times().size() < 6) return;
    const double shown_s = run.times()[run.times().size() - 6] - 0.005;  // printed to 0.01 s
    EXPECT_GE(static_cast<double>(*rows) * kRowS, shown_s);
  }

  /// Kills runs after random times of up to `longest_s`, several at a time.
  void Kill(int count, int at_once, double longest_s) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> life_s(0.2, longest_s);
    for (int done = 0; done < count; done += at_once) {
      std::vector<std::thread> threads;
      for (int i = done; i < std::min(count, done + at_once); ++i) {
        const auto lines = static_cast<std::size_t>(life_s(random) / 0.2);
        threads.emplace_back([this, i, lines] {
          const std::string folder = Path("run_" + std::to_string(i));
          LongRun run(folder);
          run.ReadLines(std::max<std::size_t>(lines, 1));
          // not only directly after a line
          std::this_thread::sleep_for(std::chrono::milliseconds(37 * i % 200));
          EXPECT_EQ(run.End(SIGKILL), 128 + SIGKILL);
          ExpectAllButTheLastSecond(run, folder + "/trace.h5");
          std::filesystem::remove_all(folder);
        });
      }
      for (std::thread& thread : threads) thread.join();
    }
    EXPECT_GT(rows_read_, 0u);
  }

  std::atomic<std::size_t> rows_read_{0};
};

TEST_F(Survival, AKilledRunLeavesAllButItsLastSecond) { Kill(4, 2, 4); }

TEST_F(Survival, LongTwentyKilledRunsOfUpToAMinuteLeaveAllButTheirLastSecond) { Kill(20, 5, 60); }

TEST_F(Survival, AnInterruptedRunIsSaved) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    LongRun run(Path("run"));
    run.ReadLines(2);
    ASSERT_EQ(run.times().size(), 2u);
    EXPECT_EQ(run.End(number), 130);
    const auto rows = Rows(Path("run/trace.h5"));
    ASSERT_TRUE(rows);
    EXPECT_GE(static_cast<double>(*rows) * kRowS, run.times().back() - 0.005);
    const auto summary = nlohmann::json::parse(Read(Path("run/summary.json")));
    EXPECT_EQ(summary.at("interrupted"), true);
    EXPECT_NEAR(summary.at("simulated_s").get<double>(), static_cast<double>(*rows) * kRowS, kRowS);
  }
}

TEST_F(Survival, UnderNohupARunOutlivesItsTerminal) {
  LongRun run(Path("run"), true);
  run.ReadLines(1);
  run.Send(SIGHUP);
  run.ReadLines(4);  // an interrupted run prints at most one more line
  EXPECT_EQ(run.times().size(), 4u);
}

TEST_F(Survival, AFullDiskIsSaidAndWhatFitsIsReadable) {
  // A limit of the file size acts like a disk that fills up. The trace's head needs 9 kB, and every
  // 1024 rows 150 kB.
  const auto at_most = [](rlim_t bytes) {
    return [bytes] {
      const rlimit size{bytes, bytes};
      setrlimit(RLIMIT_FSIZE, &size);
    };
  };
  const CommandResult small = Taut({"run", kHang, "--quiet", "--out", "a"}, at_most(500));
  EXPECT_EQ(small.status, 1);
  EXPECT_EQ(small.errors,
            "error: a/trace.h5: cannot write: File too large\n"
            "a/inputs.yaml: error: cannot write: File too large\n");
  const CommandResult larger =
      Taut({"run", kHang, "--duration_s", "30", "--quiet", "--out", "b"}, at_most(500'000));
  EXPECT_EQ(larger.status, 1);
  EXPECT_EQ(larger.errors, "error: b/trace.h5: cannot write: File too large\n");
  Diagnostics out;
  const auto trace = ReadTrace(Path("b/trace.h5"), out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_GT(trace->time_s.size(), 0u);
  EXPECT_LT(trace->time_s.size(), 6001u);
  EXPECT_FALSE(std::filesystem::exists(Path("b/summary.json")));
}

TEST_F(Survival, AFolderThatCannotBeMadeIsAFailure) {
  Write("file", "");
  for (const char* const out : {"file", "file/run"}) {
    const CommandResult result = Taut({"run", kHang, "--quiet", "--out", out});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.errors,
              std::string(out) + ": error: cannot create the folder: Not a directory\n");
  }
}

TEST_F(Survival, AFileThatCannotBeWrittenIsAFailure) {
  std::filesystem::create_directories(Path("run/inputs.yaml"));  // a folder of that name
  const CommandResult result = Taut({"run", kHang, "--quiet", "--out", "run"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, "error: run/inputs.yaml: cannot write: Is a directory\n");
}

}  // namespace
}  // namespace taut::test
