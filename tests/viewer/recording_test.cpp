// Recordings of live sessions: complete files, limited in number, and a notice if recording is
// impossible
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "apps/viewer/recording.h"
#include "tests/viewer/serving.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;
using viewer::FrameHeader;
using viewer::Recording;

/// Limits the size of all files during its lifetime: writes fail as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

class RecordingFolder : public testing::Test {
 protected:
  RecordingFolder() {
    std::string pattern = (fs::temp_directory_path() / "taut_recording_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    Diagnostics found;
    experiment_ = *LoadExperiment(kHang, {}, found);
    run_ = LiveRun::Start(experiment_, found);
  }
  ~RecordingFolder() override { fs::remove_all(folder_); }

  std::unique_ptr<Recording> Start() {
    Diagnostics found;
    auto recording = Recording::Start(
        folder_.string(), *run_, experiment_,
        [this](const std::string& text) { said_.push_back(text); }, found);
    complaints_ = found.Format();
    return recording;
  }
  void Restart(Recording& recording) {
    Diagnostics found;
    run_ = LiveRun::Start(experiment_, found);
    recording.Restart(*run_, experiment_);
  }
  /// Makes ten steps: three rows at 200 Hz and 1 ms, including the start.
  void Step(Recording& recording) {
    for (int i = 0; i < 10; ++i) {
      ASSERT_TRUE(run_->Step());
      recording.Take(*run_);
    }
  }
  std::size_t Rows(const std::string& name) const {
    Diagnostics found;
    const auto trace = ReadTrace((folder_ / name).string(), found);
    return trace ? trace->time_s.size() : 0;
  }
  /// Returns the number of files, without the lock.
  std::size_t FileCount() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})) - 1;
  }
  std::string Read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
  ExperimentSpec experiment_;
  std::unique_ptr<LiveRun> run_;
  std::vector<std::string> said_;
  std::string complaints_;
};

TEST_F(RecordingFolder, HundredsOfRestartsLeaveNoMorePartsThanTheLimit) {
  const auto recording = Start();
  for (int i = 0; i < 100; ++i) Restart(*recording);
  EXPECT_EQ(FileCount(), 3u) << "where nothing happened there is no part";
  EXPECT_TRUE(said_.empty());
  for (int i = 0; i < 40; ++i) {
    Step(*recording);
    recording->Event(0, fmt::format("event {}", i));
    if (i < 39) Restart(*recording);
  }
  EXPECT_TRUE(recording->Finish());
  EXPECT_EQ(FileCount(), 3u * Recording::kMaxParts);
  EXPECT_EQ(Rows("trace.h5"), 3u);
  EXPECT_EQ(Read("events.jsonl"), "{\"time_s\":0.0,\"text\":\"event 0\"}\n");
  const std::string last = fmt::format("trace_{}.h5", Recording::kMaxParts);
  EXPECT_EQ(Rows(last), 3u);
  EXPECT_EQ(Read(fmt::format("events_{}.jsonl", Recording::kMaxParts)),
            "{\"time_s\":0.0,\"text\":\"event 39\"}\n")
      << "the newest run is the last part";
  ASSERT_EQ(said_.size(), 1u) << "what is not kept is said, once";
  EXPECT_EQ(
      said_[0],
      fmt::format("{}/{} is the last part of the recording: every further restart replaces it",
                  folder_.string(), last));
  EXPECT_EQ(recording->failure(), "");
}

TEST_F(RecordingFolder, HasOneWriter) {
  auto first = Start();
  ASSERT_TRUE(first);
  EXPECT_FALSE(Start());
  EXPECT_NE(complaints_.find(folder_.string() + ": error: another process"), std::string::npos)
      << complaints_;
  first.reset();
  EXPECT_TRUE(Start());
}

TEST_F(RecordingFolder, NothingIsWrittenThroughALink) {
  for (const char* name :
       {"inputs.yaml", "events.jsonl", "inputs.yaml.part", "events.jsonl.part"}) {
    std::ofstream(folder_ / fmt::format("victim_of_{}", name)) << "precious";
    fs::create_symlink(fmt::format("victim_of_{}", name), folder_ / name);
  }
  const auto recording = Start();
  ASSERT_TRUE(recording) << complaints_;
  recording->Event(0, "something");
  for (const char* name :
       {"inputs.yaml", "events.jsonl", "inputs.yaml.part", "events.jsonl.part"}) {
    EXPECT_EQ(Read(fmt::format("victim_of_{}", name)), "precious");
  }
  EXPECT_EQ(Read("events.jsonl"), "{\"time_s\":0.0,\"text\":\"something\"}\n");
}

TEST_F(RecordingFolder, AFileThatIsTakenAwayIsMissed) {
  const auto recording = Start();
  Step(*recording);
  fs::remove(folder_ / "trace.h5");
  EXPECT_FALSE(recording->Finish());
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_EQ(said_[0], recording->failure());
  EXPECT_EQ(said_[0],
            fmt::format("recording stopped at t = 0.01 s of part 1: {}/trace.h5: the file was "
                        "deleted or replaced; solve this problem, then reset to resume recording",
                        folder_.string()));
  Step(*recording);
  EXPECT_FALSE(recording->Finish());
  EXPECT_EQ(said_.size(), 1u) << "once is enough";
}

TEST_F(RecordingFolder, GoesOnWithTheFirstResetForWhichThereIsRoom) {
  const auto recording = Start();
  Step(*recording);
  {
    const FullDisk full(8 << 10);
    std::this_thread::sleep_for(std::chrono::milliseconds(600));  // rows become due
    recording->FlushOld();
    ASSERT_EQ(said_.size(), 1u);
    EXPECT_EQ(said_[0],
              fmt::format("recording stopped at t = 0.01 s of part 1: {}/trace.h5: cannot write: "
                          "File too large; solve this problem, then reset to resume recording",
                          folder_.string()));
    for (int i = 0; i < 20; ++i) {
      Restart(*recording);
      Step(*recording);
      recording->Event(0, "nobody writes this down");
    }
    EXPECT_EQ(said_.size(), 1u) << "once is enough";
    EXPECT_EQ(recording->notice(), said_[0]);
  }
  EXPECT_EQ(FileCount(), 3u) << "nothing half made stays";
  Restart(*recording);
  ASSERT_EQ(said_.size(), 2u);
  EXPECT_EQ(
      said_[1],
      "recording resumed at the start of part 2; data after t = 0.01 s of part 1 are missing");
  EXPECT_EQ(recording->failure(), "");
  EXPECT_EQ(recording->notice(), said_[1]);
  Step(*recording);
  recording->Event(0.01, "seen");
  Restart(*recording);
  EXPECT_EQ(recording->notice(), "") << "of this part all is there";
  EXPECT_FALSE(recording->Finish()) << "but not of all";
  EXPECT_EQ(said_.size(), 2u);
  EXPECT_GE(Rows("trace.h5"), 1u) << "what was recorded stays";
  EXPECT_EQ(Rows("trace_2.h5"), 3u);
  EXPECT_EQ(
      Read("events_2.jsonl"),
      fmt::format("{{\"time_s\":0.0,\"text\":\"{}\"}}\n{{\"time_s\":0.01,\"text\":\"seen\"}}\n",
                  said_[1]));
  EXPECT_EQ(FileCount(), 9u);
}

TEST_F(RecordingFolder, AFolderThatWasMovedAwayIsMadeAnewByAReset) {
  const auto recording = Start();
  Step(*recording);
  const fs::path moved = folder_.string() + "_moved";
  fs::rename(folder_, moved);
  recording->FlushOld();
  ASSERT_EQ(said_.size(), 1u);
  Restart(*recording);
  EXPECT_EQ(recording->failure(), "");
  EXPECT_EQ(FileCount(), 3u);
  EXPECT_FALSE(Start()) << "the new one has its writer";
  fs::remove_all(moved);
}

TEST_F(RecordingFolder, APartThatCannotBeginLeavesTheOneThatWasThere) {
  {
    const auto recording = Start();
    Step(*recording);
    recording->Event(0, "before");
  }
  const std::string inputs = Read("inputs.yaml");
  std::ofstream(folder_ / "summary.json") << "{}";
  {
    const FullDisk full(16 << 10);  // enough for the inputs, not for a trace
    EXPECT_FALSE(Start());
  }
  EXPECT_NE(complaints_.find("trace.h5: cannot write: File too large"), std::string::npos)
      << complaints_;
  EXPECT_EQ(Rows("trace.h5"), 3u);
  EXPECT_EQ(Read("inputs.yaml"), inputs);
  EXPECT_EQ(Read("events.jsonl"), "{\"time_s\":0.0,\"text\":\"before\"}\n");
  EXPECT_EQ(FileCount(), 4u) << "nothing half made stays, and nothing goes";
}

TEST_F(RecordingFolder, WhatARunLeftGoesAndWhatAKilledWriterLeft) {
  for (const char* name : {"summary.json", "report.html", "trace.csv", "trace_3.h5.77.part",
                           "events.jsonl.77.part", "notes.txt"}) {
    std::ofstream(folder_ / name) << "old";
  }
  ASSERT_TRUE(Start()) << complaints_;
  EXPECT_EQ(FileCount(), 4u);
  EXPECT_EQ(Read("notes.txt"), "old");
}

TEST_F(RecordingFolder, EveryClientHearsWhatIsNotRecordedAndWhatIsAgainLateOnesToo) {
  std::vector<std::string> told;
  viewer::LiveOptions options;
  options.paused = true;
  options.record = viewer::RecordInto(folder_.string());
  options.tell = [&](const std::string& text) { told.push_back(text); };
  std::string notice, again;
  {
    const Serving serving(Live(kHang, options));
    Client early(serving.port());
    EXPECT_FALSE(early.Await("scene")["scene"].contains("notice"));
    fs::remove(folder_ / "trace.h5");
    early.Send({{"type", "step"}});
    notice = early.AwaitText([](const Json& message) {
      return message["type"] == "scene" && message["scene"].contains("notice");
    })["scene"]["notice"];
    Client late(serving.port());
    EXPECT_EQ(late.Await("scene")["scene"]["notice"], notice);
    early.Send({{"type", "reset"}});
    again = early.AwaitText([&](const Json& message) {
      return message["type"] == "scene" && message["scene"].value("notice", notice) != notice;
    })["scene"]["notice"];
    Client later(serving.port());
    EXPECT_EQ(later.Await("scene")["scene"]["notice"], again);
    early.Send({{"type", "reset"}});
    early.AwaitText([&](const Json& message) {
      return message["type"] == "scene" && !message["scene"].contains("notice");
    });
  }
  EXPECT_NE(notice.find("trace.h5: the file was deleted or replaced"), std::string::npos) << notice;
  EXPECT_NE(again.find("recording resumed at the start of part "), std::string::npos) << again;
  EXPECT_EQ(told, (std::vector<std::string>{notice, again}));
}

}  // namespace
}  // namespace taut::test
