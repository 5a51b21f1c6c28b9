// Folder of a run: begun, finished, and with files of different runs
#include "taut/run_folder.h"

#include <chrono>
#include <thread>

#include "tests/unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;

struct Run : TraceFolder {
  /// Writes the files of a run with this id; empty: as earlier versions wrote them.
  void WriteTrace(const std::string& name, const std::string& id) const {
    Diagnostics out;
    const TraceMetadata metadata = id.empty() ? TraceMetadata{} : TraceMetadata{{kRunIdKey, id}};
    const auto writer = name.ends_with(".h5")
                            ? CreateHdf5Trace(Path(name), Channels(1), metadata, out)
                            : CreateCsvTrace(Path(name), Channels(1), out);
    ASSERT_TRUE(writer && AppendRow(*writer, 0, 1, 0.0) && writer->Finish()) << out.Format();
  }
  void WriteInputs(const std::string& name, const std::string& id) const {
    WriteFile(name, id.empty() ? "taut: 1\n" : InputsOfRun(id, "taut: 1\n"));
  }
  void WriteSummary(const std::string& name, const std::string& id) const {
    WriteFile(name, id.empty() ? "{}" : "{\"run\": \"" + id + "\"}");
  }
  /// Returns the errors of reading a trace; empty if it is read.
  std::string Read(const std::string& name) const {
    Diagnostics out;
    const auto trace = ReadTraceOfRun(Path(name), out);
    EXPECT_EQ(trace.has_value(), out.ok());
    return WithoutFolder(out.Format());
  }
};

TEST_F(Run, PiecesOfOneRunAreRead) {
  WriteTrace("trace.h5", "a");
  EXPECT_EQ(Read("trace.h5"), "") << "alone";
  WriteInputs("inputs.yaml", "a");
  EXPECT_EQ(Read("trace.h5"), "") << "not finished";
  WriteSummary("summary.json", "a");
  EXPECT_EQ(Read("trace.h5"), "");
}

TEST_F(Run, PiecesOfDifferentRunsAreRefused) {
  const std::string hint =
      " (remove the file that does not belong there, or run the experiment again)\n";
  WriteTrace("trace.h5", "a");
  for (const std::string other : {"b", ""}) {
    const std::string runs = "trace.h5 (run " + (other.empty() ? "none" : other) + ", not a)";
    WriteInputs("inputs.yaml", other);
    EXPECT_EQ(Read("trace.h5"),
              "inputs.yaml: error: the file belongs to another run than " + runs + hint);
    WriteInputs("inputs.yaml", "a");
    WriteSummary("summary.json", other);
    EXPECT_EQ(Read("trace.h5"),
              "summary.json: error: the file belongs to another run than " + runs + hint);
    fs::remove(Path("summary.json"));
  }
  WriteTrace("trace.h5", "");
  EXPECT_EQ(
      Read("trace.h5"),
      "inputs.yaml: error: the file belongs to another run than trace.h5 (run a, not none)" + hint);
  WriteFile("inputs.yaml", "taut: 1\n");
  EXPECT_EQ(Read("trace.h5"), "") << "of an earlier version";
}

TEST_F(Run, ATextualTraceStandsBesideInputsAndSummaryOfOneRun) {
  WriteTrace("trace.csv", "");
  WriteInputs("inputs.yaml", "a");
  WriteSummary("summary.json", "a");
  EXPECT_EQ(Read("trace.csv"), "");
  WriteSummary("summary.json", "b");
  EXPECT_NE(Read("trace.csv")
                .find("summary.json: error: the file belongs to another run than inputs.yaml"),
            std::string::npos);
}

TEST_F(Run, AMeasuredTraceInTheFolderIsNoPiece) {
  WriteInputs("inputs.yaml", "a");
  WriteSummary("summary.json", "a");
  for (const char* const name : {"measured.h5", "measured.csv"}) {
    WriteTrace(name, "");
    EXPECT_EQ(Read(name), "");
  }
  WriteTrace("renamed.h5", "b");
  EXPECT_NE(Read("renamed.h5"), "");
}

TEST_F(Run, ARunThatWasResetHasPiecesOfItsOwn) {
  EXPECT_EQ(BesideTrace("x/trace_2.h5", "inputs", ".yaml"), "x/inputs_2.yaml");
  EXPECT_EQ(BesideTrace("trace.csv.gz", "summary", ".json"), "summary.json");
  EXPECT_EQ(BesideTrace("x/renamed.h5", "inputs", ".yaml"), "x/inputs.yaml");
  WriteTrace("trace_2.h5", "a");
  WriteInputs("inputs.yaml", "b");
  EXPECT_EQ(Read("trace_2.h5"), "");
  WriteInputs("inputs_2.yaml", "b");
  EXPECT_NE(Read("trace_2.h5"), "");
}

TEST_F(Run, TheRunBeforeIsThereUntilTheNewOneBegins) {
  for (const char* const name :
       {"trace.h5", "trace.csv", "inputs.yaml", "summary.json", "report.html", "c.gait.yaml",
        "notes.txt", "report.html.77.part", "trace_2.h5", "a.part", "events.jsonl",
        "events.jsonl.77.part", "trace_2.h5.77.part", "trace_b.h5.77.part"}) {
    WriteFile(name, "old");
  }
  Diagnostics out;
  const auto folder = RunFolder::Open(Path(""), {"c.gait.yaml"}, out);
  ASSERT_TRUE(folder && folder->Prepare("taut: 1\n", out)) << out.Format();
  const std::string part = "inputs.yaml." + std::to_string(getpid()) + ".part";
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "a.part", "c.gait.yaml", "events.jsonl",
                                               "inputs.yaml", part, "notes.txt", "report.html",
                                               "summary.json", "trace.csv", "trace.h5",
                                               "trace_2.h5", "trace_b.h5.77.part"}));
  EXPECT_EQ(ReadFile(Path("inputs.yaml")), "old");
  ASSERT_TRUE(folder->Begin(out)) << out.Format();
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "a.part", "inputs.yaml", "notes.txt",
                                               "trace_2.h5", "trace_b.h5.77.part"}));
  EXPECT_EQ(ReadFile(Path("inputs.yaml")), "# run " + folder->id() + "\ntaut: 1\n");
  ASSERT_TRUE(folder->Finish("{}", out)) << out.Format();
  EXPECT_EQ(ReadFile(Path("summary.json")), "{}");
}

/// A finished run "old", and a run "new" that was killed while it replaced "old": after its trace
/// was published, and after `gone` of the old files were removed.
struct KilledRun : Run {
  void Leave(int gone, const std::string& trace_of = "new") const {
    WriteTrace("trace.h5", trace_of);
    WriteInputs("inputs.yaml", "old");
    WriteInputs("inputs.yaml.77.part", "new");
    if (gone < 1) WriteSummary("summary.json", "old");
    if (gone < 2) WriteFile("report.html", "old");
  }
  std::string InputsId() const { return ReadFile(Path("inputs.yaml")).substr(6, 3); }
};

TEST_F(KilledRun, IsReadWhereverItWasKilledAndNothingOldIsLeft) {
  for (int gone = 0; gone <= 2; ++gone) {
    Leave(gone);
    EXPECT_EQ(Read("trace.h5"), "") << gone;
    EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "inputs.yaml", "trace.h5"})) << gone;
    EXPECT_EQ(InputsId(), "new");
  }
}

TEST_F(KilledRun, IsFinishedByTheNextOneWhichMayFailToBegin) {
  Leave(0);
  Diagnostics out;
  ASSERT_TRUE(RunFolder::Open(Path(""), {}, out)) << out.Format();
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "inputs.yaml", "trace.h5"}));
  EXPECT_EQ(InputsId(), "new");
}

TEST_F(KilledRun, WithoutInputsIsReadWhereverItWasKilledAndNothingOldIsLeft) {
  for (const char* const last_old : {"summary.json", "events.jsonl", "host.h5", "inputs.yaml"}) {
    WriteTrace("trace.h5", "new");
    WriteInputs("inputs.yaml", "old");
    WriteFile("inputs.yaml.77.part", InputsOfRun("new", ""));
    WriteFile(last_old, std::string(last_old) == "inputs.yaml" ? InputsOfRun("old", "") : "{}");
    EXPECT_EQ(Read("trace.h5"), "") << last_old;
    EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "trace.h5"})) << last_old;
  }
  // A log replaced a log.
  WriteFile("events.jsonl", "old");
  WriteFile("inputs.yaml.77.part", InputsOfRun("new", ""));
  EXPECT_EQ(Read("trace.h5"), "");
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "trace.h5"}));
}

TEST_F(KilledRun, LeavesTheOldOneWholeIfItHadNoRow) {
  Leave(0, "old");
  EXPECT_EQ(Read("trace.h5"), "");
  Diagnostics out;
  ASSERT_TRUE(RunFolder::Open(Path(""), {}, out)) << out.Format();
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "inputs.yaml", "report.html",
                                               "summary.json", "trace.h5"}));
  EXPECT_EQ(InputsId(), "old");
}

TEST_F(KilledRun, OfWhichNothingIsLeftToFinishIsRefused) {
  Leave(0);
  fs::remove(Path("inputs.yaml.77.part"));
  EXPECT_NE(
      Read("trace.h5").find("inputs.yaml: error: the file belongs to another run than trace.h5"),
      std::string::npos);
}

TEST_F(KilledRun, IsWaitedForIfItIsAlive) {
  Leave(0);
  Diagnostics out;
  auto lock = FolderLock::Take(Path(""), out);
  ASSERT_TRUE(lock) << out.Format();
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    fs::remove(Path("summary.json"));
    fs::rename(Path("inputs.yaml.77.part"), Path("inputs.yaml"));
  });
  EXPECT_EQ(Read("trace.h5"), "");
  writer.join();
}

TEST_F(Run, TheFirstRowOfTheLastTraceBeginsIt) {
  for (const char* const name : {"trace.h5", "trace.csv", "summary.json"}) WriteFile(name, "old");
  Diagnostics out;
  const auto folder = RunFolder::Open(Path(""), {}, out);
  ASSERT_TRUE(folder && folder->Prepare("taut: 1\n", out)) << out.Format();
  const auto trace =
      folder->BeginWith(CreateHdf5Trace(Path("trace.h5"), Channels(1), {}, out), {"trace.h5"});
  EXPECT_EQ(ReadFile(Path("trace.h5")), "old");
  EXPECT_TRUE(fs::exists(Path("summary.json")));
  ASSERT_TRUE(AppendRow(*trace, 0, 1, 0.0)) << trace->error();
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "inputs.yaml", "trace.h5"}));
  EXPECT_TRUE(trace->Finish()) << trace->error();
}

TEST_F(Run, WithoutAnExperimentHasNoInputs) {
  for (const char* const name : {"trace.h5", "inputs.yaml", "summary.json", "host.h5"}) {
    WriteFile(name, "old");
  }
  Diagnostics out;
  const auto folder = RunFolder::Open(Path(""), {}, out);
  ASSERT_TRUE(folder && folder->Prepare("", out)) << out.Format();
  const auto trace =
      folder->BeginWith(CreateHdf5Trace(Path("trace.h5"), Channels(1), {}, out), {"trace.h5"});
  EXPECT_EQ(ReadFile(Path("inputs.yaml")), "old");
  ASSERT_TRUE(AppendRow(*trace, 0, 1, 0.0)) << trace->error();
  EXPECT_EQ(Names(), (std::vector<std::string>{".lock", "trace.h5"}));
  EXPECT_TRUE(trace->Finish()) << trace->error();
}

TEST_F(Run, WhatCannotBeRemovedIsAnErrorOfTheTrace) {
  fs::create_directory(Path("summary.json"));
  Diagnostics out;
  const auto folder = RunFolder::Open(Path(""), {}, out);
  ASSERT_TRUE(folder && folder->Prepare("taut: 1\n", out)) << out.Format();
  const auto trace =
      folder->BeginWith(CreateHdf5Trace(Path("trace.h5"), Channels(1), {}, out), {"trace.h5"});
  EXPECT_FALSE(AppendRow(*trace, 0, 1, 0.0));
  EXPECT_EQ(WithoutFolder(trace->error()),
            "summary.json: cannot remove this file of the previous run: Is a directory");
}

TEST_F(Run, EveryRunHasAnIdOfItsOwn) {
  const std::string id = NewRunId();
  EXPECT_EQ(id.size(), 16u);
  EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), id.npos);
  EXPECT_NE(NewRunId(), id);
}

TEST_F(Run, AFolderThatWasReplacedGetsNoSummary) {
  Diagnostics out;
  const auto folder = RunFolder::Open(Path("run"), {}, out);
  ASSERT_TRUE(folder && folder->Prepare("", out) && folder->Begin(out)) << out.Format();
  fs::remove_all(Path("run"));
  fs::create_directory(Path("run"));
  EXPECT_FALSE(folder->Finish("{}", out));
  EXPECT_EQ(
      WithoutFolder(out.Format()),
      "run: error: the folder was deleted while the run wrote into it, so there is no summary\n");
  EXPECT_TRUE(fs::is_empty(Path("run")));
}

TEST_F(Run, WhatCannotBeRemovedIsNamed) {
  fs::create_directory(Path("summary.json"));
  Diagnostics out;
  const auto folder = RunFolder::Open(Path(""), {}, out);
  ASSERT_TRUE(folder && folder->Prepare("", out)) << out.Format();
  EXPECT_FALSE(folder->Begin(out));
  EXPECT_EQ(WithoutFolder(out.Format()),
            "summary.json: error: cannot remove this file of the previous run: Is a directory\n");
}

}  // namespace
}  // namespace taut::test
