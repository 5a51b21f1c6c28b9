// A run folder as a transaction: one writer, and either one complete run or an explicit notice
#include <sys/resource.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "taut/run_folder.h"
#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;

const std::string kHangInFolder = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";

class RunCommand : public CommandTest {
 protected:
  RunCommand() {
    fs::create_directory(Path("web"));
    Write("web/index.html", "<p>the page");
    Write("web/report.html",
          R"(<!doctype html><script type="application/json" id="taut-report"></script>)");
    setenv("TAUT_WEB", Path("web").c_str(), 1);
  }
  ~RunCommand() override { unsetenv("TAUT_WEB"); }

  /// Returns the run's id from its trace, or an empty string.
  std::string IdOfTrace(const std::string& path) const {
    Diagnostics not_yet;
    const auto trace = ReadTrace(Path(path), not_yet);
    for (const auto& [key, value] : trace ? trace->metadata : TraceMetadata{}) {
      if (key == kRunIdKey) return value;
    }
    return {};
  }

  /// Starts a run that would take hours, and waits until it has written a row. `id`: id of the
  /// existing trace, if any.
  pid_t StartLong(const std::string& folder, const std::string& id = "") const {
    const pid_t pid =
        Start({"run", kHangInFolder, "--duration_s", "1e6", "--out", folder, "--quiet"});
    for (std::string now; now.empty() || now == id; now = IdOfTrace(folder + "/trace.h5")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (waitpid(pid, nullptr, WNOHANG) != 0) throw std::runtime_error("the run has ended");
    }
    return pid;
  }
  CommandResult Kill(pid_t pid, int number) const {
    kill(pid, number);
    return End(pid);
  }

  std::vector<std::string> Names(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(Path(folder))) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Returns the scene's notice in a report.
  std::string NoticeOf(const std::string& report) const {
    const std::string page = Read(Path(report));
    const std::string key = R"("notice":")";
    const std::size_t at = page.find(key);
    if (at == page.npos) return {};
    return page.substr(at + key.size(), page.find('"', at + key.size()) - at - key.size());
  }
};

TEST_F(RunCommand, EveryPieceHasTheRunsId) {
  ASSERT_EQ(Taut({"run", kHangInFolder, "--out", "a", "--csv", "--report", "--quiet"}).status, 0);
  ASSERT_EQ(Taut({"run", kHangInFolder, "--out", "b", "--quiet"}).status, 0);
  const std::string id = IdOfTrace("a/trace.h5");
  EXPECT_EQ(id.size(), 16u);
  EXPECT_EQ(Read(Path("a/inputs.yaml")).rfind("# run " + id + "\n", 0), 0u);
  EXPECT_EQ(nlohmann::json::parse(Read(Path("a/summary.json"))).at("run"), id);
  EXPECT_NE(IdOfTrace("b/trace.h5"), id);
  EXPECT_EQ(Names("a"), (std::vector<std::string>{".lock", "inputs.yaml", "report.html",
                                                  "summary.json", "trace.csv", "trace.h5"}));
}

TEST_F(RunCommand, TwoAtOnceAreRefused) {
  const pid_t first = StartLong("run");
  const CommandResult second = Taut({"run", kHangInFolder, "--out", "run", "--quiet"});
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(second.errors,
            "run: error: another process is writing into this folder (wait for it, stop it, or "
            "give `--out` another folder)\n");
  EXPECT_EQ(Kill(first, SIGTERM).status, 130);
  EXPECT_EQ(Taut({"run", kHangInFolder, "--out", "run", "--quiet"}).status, 0);
}

TEST_F(RunCommand, AKilledRunLeavesItsFirstRowAndNothingOfTheRunBefore) {
  ASSERT_EQ(Taut({"run", kHangInFolder, "--out", "run", "--csv", "--report", "--quiet"}).status, 0);
  const std::string before = IdOfTrace("run/trace.h5");
  Kill(StartLong("run", before), SIGKILL);
  Diagnostics out;
  const auto trace = ReadTraceOfRun(Path("run/trace.h5"), out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(Names("run"), (std::vector<std::string>{".lock", "inputs.yaml", "trace.h5"}));
  EXPECT_TRUE(trace->unfinished);
  EXPECT_GE(trace->time_s.size(), 1u);
  const CommandResult report = Taut({"report", "run/trace.h5"});
  EXPECT_EQ(report.status, 0) << report.errors;
  for (const std::string& said : {NoticeOf("run/report.html"), report.errors}) {
    EXPECT_NE(said.find("the trace is unfinished"), std::string::npos) << said;
  }
  EXPECT_NE(Read(Path("run/report.html")).find(R"("summary":null)"), std::string::npos);
  const CommandResult compared = Taut({"compare", "run/trace.h5", "run/trace.h5", "--json"});
  EXPECT_NE(compared.errors.find("the trace is unfinished (the recorded part is compared)"),
            std::string::npos)
      << compared.errors;
}

TEST_F(RunCommand, PiecesOfDifferentRunsAreBadInput) {
  ASSERT_EQ(Taut({"run", kHangInFolder, "--out", "a", "--quiet"}).status, 0);
  ASSERT_EQ(Taut({"run", kHangInFolder, "--out", "b", "--quiet"}).status, 0);
  fs::copy_file(Path("a/summary.json"), Path("b/summary.json"),
                fs::copy_options::overwrite_existing);
  const std::string said =
      "b/summary.json: error: the file belongs to another run than b/trace.h5 (run " +
      IdOfTrace("a/trace.h5") + ", not " + IdOfTrace("b/trace.h5") +
      ") (remove the file that does not belong there, or run the experiment again)\n";
  for (const auto& words : {std::vector<std::string>{"report", "b/trace.h5"},
                            {"report", "a/trace.h5", "--compare", "b/trace.h5"},
                            {"compare", "b/trace.h5", "a/trace.h5"},
                            {"compare", "a/trace.h5", "b/trace.h5"},
                            {"view", "b/trace.h5", "--port", "0"}}) {
    const CommandResult result = Taut(words);
    EXPECT_EQ(result.status, 3) << words[0];
    EXPECT_EQ(result.errors, said) << words[0];
  }
}

TEST_F(RunCommand, ARunThatCannotBeginLeavesTheRunBefore) {
  ASSERT_EQ(Taut({"run", kHangInFolder, "--out", "run", "--csv", "--report", "--quiet"}).status, 0);
  const std::vector<std::string> names = Names("run");
  const std::string summary = Read(Path("run/summary.json")), id = IdOfTrace("run/trace.h5");
  // no space: a limit of the file size acts like a full disk
  const CommandResult full = Taut({"run", kHangInFolder, "--out", "run", "--quiet"}, [] {
    const rlimit size{500, 500};
    setrlimit(RLIMIT_FSIZE, &size);
  });
  EXPECT_EQ(full.status, 1) << full.errors;
  // no equilibrium to start from: a ball in free fall
  WriteNeverSettles();
  const CommandResult never = Taut({"run", "never.yaml", "--out", "run", "--quiet"});
  EXPECT_EQ(never.status, 1) << never.errors;
  EXPECT_NE(never.errors.find("does not settle"), std::string::npos) << never.errors;
  EXPECT_EQ(Names("run"), names);
  EXPECT_EQ(Read(Path("run/summary.json")), summary);
  EXPECT_EQ(IdOfTrace("run/trace.h5"), id);
  EXPECT_EQ(Taut({"report", "run/trace.h5"}).status, 0);
}

TEST_F(RunCommand, LinksInTheFolderAreReplacedAndNotFollowed) {
  fs::create_directory(Path("run"));
  Write("victim", "untouched");
  const std::vector<std::string> pieces{"inputs.yaml", "report.html", "summary.json", "trace.csv",
                                        "trace.h5"};
  for (const std::string& name : pieces) fs::create_symlink("../victim", Path("run/" + name));
  const CommandResult result =
      Taut({"run", kHangInFolder, "--out", "run", "--csv", "--report", "--quiet"});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(Read(Path("victim")), "untouched");
  for (const std::string& name : pieces) {
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(Path("run/" + name)))) << name;
  }
}

TEST_F(RunCommand, AFolderThatIsDeletedUnderTheRunIsSaid) {
  const pid_t run = StartLong("run");
  fs::remove_all(Path("run"));
  fs::create_directory(Path("run"));  // created by another program
  const CommandResult result = Kill(run, SIGTERM);
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(
      result.errors,
      "run: error: the folder was deleted while the run wrote into it, so there is no summary\n");
  EXPECT_TRUE(fs::is_empty(Path("run")));
}

}  // namespace
}  // namespace taut::test
