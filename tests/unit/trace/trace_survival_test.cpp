// Traces and failures: killed writers, full disks, damaged files
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <iostream>
#include <random>
#include <thread>

#include "tests/unit/trace/hdf5_old_layout.h"
#include "tests/unit/trace/trace_fixture.h"
#include "trace/child_process.h"

namespace taut::test {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t kChannelCount = 5;
constexpr std::chrono::hours kNoLimit{
    1};  ///< For tests that must not depend on the load of the machine.

double Now() { return duration<double>(steady_clock::now().time_since_epoch()).count(); }

std::unique_ptr<TraceWriter> Create(const std::string& path, Diagnostics& out) {
  return path.ends_with(".h5") ? CreateHdf5Trace(path, Channels(kChannelCount), {}, out)
                               : CreateCsvTrace(path, Channels(kChannelCount), out);
}

/// Runs `work` in a child process that exits normally. Returns its wait status.
int InChild(const std::function<int()>& work) {
  const pid_t pid = fork();
  if (pid == 0) std::exit(work());
  int status = 0;
  waitpid(pid, &status, 0);
  return status;
}

struct Survival : TraceFolder {
  /// Writes to `path`, `rows_at_once` each half millisecond, kills the writer after `life`, and
  /// reads.
  void KillAfter(const std::string& path, milliseconds life, std::size_t rows_at_once);
  std::size_t rows_read = 0;
};

void Survival::KillAfter(const std::string& path, milliseconds life, std::size_t rows_at_once) {
  // Times on the steady clock that all processes share: 0 until the first row.
  struct Progress {
    volatile double appended, longest;
  };
  void* shared =
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* progress = new (shared) Progress{0.0, 0.0};
  const pid_t pid = fork();
  if (pid == 0) {
    Diagnostics out;
    const auto writer = Create(path, out);
    double last = 0.0;
    for (std::size_t row = 0; writer; ++row) {
      double now = Now();
      while (!(now > last)) now = Now();
      if (row > 0 && now - last > progress->longest) progress->longest = now - last;
      last = now;
      if (!AppendRow(*writer, row, kChannelCount, now)) break;
      progress->appended = now;
      if (row % rows_at_once == 0) std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    _exit(1);
  }
  while (progress->appended == 0.0) std::this_thread::sleep_for(milliseconds(1));
  std::this_thread::sleep_for(life);
  Diagnostics while_writing;
  EXPECT_TRUE(ReadTrace(path, while_writing)) << while_writing.Format();
  kill(pid, SIGKILL);
  int status = 0;
  waitpid(pid, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the writer gave up by itself";

  Diagnostics out;
  const auto trace = ReadTrace(path, out);
  ASSERT_TRUE(trace) << out.Format();
  ExpectPattern(*trace, kChannelCount);
  ASSERT_FALSE(trace->time_s.empty()) << "the first row is there at once";
  // Half a second, plus the longest time of a row: the interval starts at the end of a flush.
  EXPECT_GT(trace->time_s.back(), progress->appended - 0.5 - progress->longest)
      << trace->time_s.size() << " rows";
  rows_read += trace->time_s.size();
  munmap(shared, sizeof(Progress));
}

TEST_F(Survival, AKilledWriterLeavesAllButTheLastSecond) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> life_ms(0, 1300);
  KillAfter(Path("at_once.h5"), milliseconds(0), 64);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    KillAfter(Path("t.h5"), milliseconds(life_ms(random)), 64);
  }
  // slowly, so that time and not the amount of text triggers writing
  for (int i = 0; i < 4; ++i) KillAfter(Path("t.csv"), milliseconds(1100 + 150 * i), 1);
  EXPECT_GT(rows_read, 0u);
}

TEST_F(Survival, RowsThatAreSeldomAreWrittenInBetween) {
  for (const std::string name : {"t.h5", "t.csv"}) {
    Diagnostics out;
    const auto writer = Create(Path(name), out);
    ASSERT_TRUE(writer) << out.Format();
    ASSERT_TRUE(AppendRow(*writer, 0, kChannelCount, 0.0));
    std::this_thread::sleep_for(milliseconds(600));  // at least
    ASSERT_TRUE(writer->FlushOld());
    const auto trace = ReadTrace(Path(name), out);
    ASSERT_TRUE(trace) << out.Format();
    EXPECT_EQ(trace->time_s.size(), 1u);
    ASSERT_TRUE(writer->Finish());
    EXPECT_TRUE(writer->FlushOld()) << "there is nothing to write";
  }
}

TEST_F(Survival, ATraceInAFolderThatIsNotThereIsAnErrorAndSilent) {
  testing::internal::CaptureStderr();
  for (const std::string name : {"none/t.h5", "none/t.csv"}) {
    Diagnostics out;
    EXPECT_FALSE(Create(Path(name), out));
    EXPECT_EQ(out.Format(), "error: " + Path(name) + ": cannot write: No such file or directory\n");
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Survival, AFullDiskIsAnErrorInCsv) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "this machine has no /dev/full";
  Diagnostics out;
  EXPECT_FALSE(Create("/dev/full", out));
  EXPECT_EQ(out.Format(), "error: /dev/full: cannot write: No space left on device\n");
}

TEST_F(Survival, AFullDiskIsAnErrorAndWhatWasFlushedStaysReadable) {
  // A limit of the file size acts like a full disk for the library.
  std::mt19937 random(2);
  std::size_t complaints_at_start = 0;
  for (int i = 0; i < 60; ++i) {
    const std::string path = Path(i % 6 == 0 ? "t.csv" : "t.h5");
    std::filesystem::remove(path);
    const rlim_t limit =
        std::uniform_int_distribution<rlim_t>(0, i % 2 == 0 ? 30000 : 600000)(random);
    SCOPED_TRACE(path + " limited to " + std::to_string(limit) + " bytes");
    constexpr int kRefusedAtStart = 10, kRefusedLater = 11;
    const int status = InChild([&] {
      const rlimit size{limit, limit};
      setrlimit(RLIMIT_FSIZE, &size);
      signal(SIGXFSZ, SIG_IGN);
      Diagnostics out;
      auto writer = Create(path, out);
      if (!writer) {
        return out.Format() == "error: " + path + ": cannot write: File too large\n"
                   ? kRefusedAtStart
                   : 1;
      }
      std::size_t row = 0;
      while (row < 100000 && AppendRow(*writer, row, kChannelCount, static_cast<double>(row))) {
        ++row;
      }
      if (row == 100000) return 2;
      const bool sane = writer->error() == path + ": cannot write: File too large" &&
                        !AppendRow(*writer, row, kChannelCount, 1e9) && !writer->Finish();
      writer.reset();
      if (row == 0 && sane) return std::filesystem::exists(path) ? 4 : kRefusedAtStart;
      return sane ? kRefusedLater : 3;
    });
    ASSERT_TRUE(WIFEXITED(status)) << strsignal(WTERMSIG(status));
    if (WEXITSTATUS(status) == kRefusedAtStart) {
      ++complaints_at_start;
      continue;
    }
    ASSERT_EQ(WEXITSTATUS(status), kRefusedLater);
    Diagnostics out;
    const auto trace = ReadTrace(path, out);
    ASSERT_TRUE(trace) << out.Format();
    ExpectPattern(*trace, kChannelCount);
    rows_read += trace->time_s.size();
  }
  EXPECT_GT(rows_read, 1000u);
  EXPECT_GT(complaints_at_start, 1u);
}

TEST_F(Survival, AWriterThatFailedHoldsNoFile) {
  const auto open_files = [] {
    const std::filesystem::directory_iterator files("/proc/self/fd");
    return std::distance(begin(files), end(files));
  };
  const int status = InChild([&] {
    signal(SIGXFSZ, SIG_IGN);
    const auto before = open_files();
    for (rlim_t limit = 200; limit < 300'000; limit += limit / 2) {
      const std::string path = Path("t" + std::to_string(limit) + ".h5");
      const rlimit size{limit, RLIM_INFINITY}, none{RLIM_INFINITY, RLIM_INFINITY};
      setrlimit(RLIMIT_FSIZE, &size);
      Diagnostics out;
      auto writer = Create(path, out);
      for (std::size_t row = 0; writer && writer->error().empty(); ++row) {
        AppendRow(*writer, row, kChannelCount, static_cast<double>(row));
      }
      setrlimit(RLIMIT_FSIZE, &none);
      writer.reset();
      if (open_files() != before) return 1;
      // Its name, and possibly its inode number, are free for another file.
      std::filesystem::remove(path);
      const auto next = Create(path, out);
      if (!next || !AppendRow(*next, 0, kChannelCount, 0.0) || !next->Finish()) return 2;
    }
    return open_files() == before ? 10 : 3;
  });
  ASSERT_TRUE(WIFEXITED(status)) << strsignal(WTERMSIG(status));
  EXPECT_EQ(WEXITSTATUS(status), 10);
}

TEST_F(Survival, AFullDiskFoundOnlyAtTheEndIsAnError) {
  for (const std::string name : {"t.h5", "t.csv"}) {
    const int status = InChild([&] {
      Diagnostics out;
      auto writer = Create(Path(name), out);
      for (std::size_t row = 0; row < 100; ++row) {
        if (!AppendRow(*writer, row, kChannelCount, static_cast<double>(row))) return 1;
      }
      const rlimit size{100, 100};
      setrlimit(RLIMIT_FSIZE, &size);
      signal(SIGXFSZ, SIG_IGN);
      return !writer->Finish() && !writer->error().empty() && !writer->Finish() ? 10 : 2;
    });
    ASSERT_TRUE(WIFEXITED(status)) << strsignal(WTERMSIG(status));
    EXPECT_EQ(WEXITSTATUS(status), 10);
  }
}

struct Outcome {
  std::size_t readable = 0, refused = 0, crashed = 0;
};

/// Damages `good` in `count` ways. The caller must get data or a diagnostic.
Outcome ReadDamaged(const std::string& good, std::size_t structure_bytes, int count,
                    const std::string& path) {
  std::mt19937 random(3);
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  Outcome outcome;
  for (int i = 0; i < count; ++i) {
    std::string bad = good;
    const std::size_t reach = i % 3 == 0 ? bad.size() : structure_bytes;
    for (std::size_t n = 1 + below(6); n > 0; --n) {
      bad[below(reach)] = static_cast<char>(below(256));
    }
    if (i % 10 == 0) bad.resize(below(bad.size()));
    std::ofstream(path, std::ios::binary) << bad;
    Diagnostics found;
    const auto trace = ReadTrace(path, found);
    EXPECT_NE(trace.has_value(), !found.ok()) << "file " << i;
    if (trace) {
      for (const auto& column : trace->values) EXPECT_EQ(column.size(), trace->time_s.size());
    }
    ++(trace ? outcome.readable : outcome.refused);
    outcome.crashed += found.Format().find("crashed") != std::string::npos;
  }
  std::cout << outcome.readable << " readable, " << outcome.refused << " refused, of which "
            << outcome.crashed << " crashed HDF5\n";
  return outcome;
}

TEST_F(Survival, DamagedTracesGiveDataOrADiagnostic) {
  Diagnostics out;
  auto writer = CreateHdf5Trace(Path("good.h5"), Channels(kChannelCount), {{"seed", "0"}}, out);
  for (std::size_t row = 0; row < 2000; ++row) {
    ASSERT_TRUE(AppendRow(*writer, row, kChannelCount, static_cast<double>(row)));
  }
  ASSERT_TRUE(writer->Finish());
  const Outcome outcome = ReadDamaged(ReadFile(Path("good.h5")), 8192, 400, Path("bad.h5"));
  EXPECT_GT(outcome.readable, 10u);
  EXPECT_GT(outcome.refused, 10u);
}

TEST_F(Survival, DamagedFilesWithoutChecksumsGiveDataOrADiagnostic) {
  WriteOldLayout(Path("good.h5"), Channels(kChannelCount), 2000);
  Diagnostics out;
  ASSERT_TRUE(ReadTrace(Path("good.h5"), out)) << out.Format();
  const Outcome outcome = ReadDamaged(ReadFile(Path("good.h5")), 8192, 400, Path("bad.h5"));
  EXPECT_GT(outcome.readable, 10u);
  EXPECT_GT(outcome.refused, 10u);
}

TEST(ChildProcess, SendsWhatItFound) {
  trace::ChildProcess child([](const trace::ChildOutput& to) { to.Write("hello", 5); }, 1 << 20,
                            kNoLimit);
  char text[6] = {};
  EXPECT_TRUE(child.Read(text, 5));
  EXPECT_STREQ(text, "hello");
  EXPECT_FALSE(child.Read(text, 1)) << "there is no more";
  EXPECT_EQ(child.End(), "");
}

TEST(ChildProcess, TellsHowItEnded) {
  const auto end = [](const std::function<void()>& work, milliseconds limit = kNoLimit) {
    trace::ChildProcess child([&](const trace::ChildOutput&) { work(); }, 1 << 28, limit);
    char byte = 0;
    EXPECT_FALSE(child.Read(&byte, 1));
    return child.End();
  };
  EXPECT_EQ(end([] { raise(SIGSEGV); }), "crashed (Segmentation fault)");
  EXPECT_EQ(end([] { std::abort(); }), "crashed (Aborted)");
  EXPECT_EQ(end([] { _exit(7); }), "ended with status 7");
  EXPECT_EQ(end([] { std::this_thread::sleep_for(kNoLimit); }, milliseconds(1000)),
            "did not respond for 1 s");
  // A direct call of operator new, because clang removes an unused vector.
  EXPECT_EQ(end([] { ::operator delete(::operator new (std::size_t{1} << 33)); }),
            "ended with status 1")
      << "memory is limited";
  EXPECT_EQ(end([] {}), "");
}

TEST(ChildProcess, DiesWithAParentThatHasHeardEnough) {
  trace::ChildProcess child(
      [](const trace::ChildOutput& to) {
        for (;;) to.Write("x", 1);
      },
      1 << 20, kNoLimit);  // a test that waited for the child would reach this limit
  char byte = 0;
  EXPECT_TRUE(child.Read(&byte, 1));
}

}  // namespace
}  // namespace taut::test
