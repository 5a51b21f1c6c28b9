// `taut learn` and interruptions: kill, Ctrl-C, resume, full disks, diverging worlds
#include <sys/resource.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/system/learn_fixture.h"

namespace taut::test {
namespace {

TEST_F(Learn, KilledAgainAndAgainItComesToTheSameEnd) {
  ASSERT_EQ(Search("whole").status, 0);
  ASSERT_EQ(Result("whole").evaluations.size(), 84u);
  int kills = 0;
  for (double wait_s = 0.02;; wait_s *= 1.2) {  // grows, so that the loop ends on any machine
    const pid_t pid = Start({"learn", "study.yaml", "--out", "killed", "--quiet"});
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    kill(pid, SIGKILL);
    const CommandResult result = End(pid);
    if (result.status == 0) break;
    ASSERT_EQ(result.status, 128 + SIGKILL) << result.errors;
    ++kills;
  }
  EXPECT_GE(kills, 1);
  ExpectSame("whole", "killed");
}

TEST_F(Learn, InterruptedItSaysSoAndGoesOn) {
  Write("study.yaml", Replaced(kStudy, "evaluations: 24", "evaluations: 100000"));
  const pid_t pid = Start({"learn", "study.yaml", "--out", "long"});
  // The log's existence proves that the search has begun.
  while (!std::filesystem::exists(Path("long/study.sqlite"))) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(pid, SIGINT);
  const CommandResult result = End(pid);
  EXPECT_EQ(result.status, 130) << result.errors;
  EXPECT_NE(result.errors.find("interrupted; run the same command again to resume"),
            std::string::npos);
  // The completed evaluations are a prefix of any longer search.
  Write("study.yaml", kStudy);
  const std::size_t done = Result("long").evaluations.size();
  if (done < 84) {
    ASSERT_EQ(Search("long").status, 0);
    ASSERT_EQ(Search("whole").status, 0);
    ExpectSame("whole", "long");
  }
}

TEST_F(Learn, EndsWithItsTerminalAsInterrupted) {
  Write("study.yaml", Replaced(kStudy, "evaluations: 24", "evaluations: 100000"));
  const pid_t pid = Start({"learn", "study.yaml", "--out", "run"});
  while (!std::filesystem::exists(Path("run/study.sqlite"))) std::this_thread::yield();
  kill(pid, SIGHUP);
  EXPECT_EQ(End(pid).status, 130);
}

TEST_F(Learn, ThreadsAndInstructionSetsChangeNothing) {
  ASSERT_EQ(Search("a").status, 0);
  ASSERT_EQ(Search("b", {"--threads", "1"}, [] { setenv("TAUT_SIMD", "scalar", 1); }).status, 2)
      << "an option given twice";
  ASSERT_EQ(Taut({"learn", "study.yaml", "--out", "b", "--threads", "1"},
                 [] { setenv("TAUT_SIMD", "scalar", 1); })
                .status,
            0);
  ExpectSame("a", "b");
}

TEST_F(Learn, ALargerBudgetGoesOnAsIfItHadBeenSoFromTheStart) {
  ASSERT_EQ(Search("grown").status, 0);
  Write("study.yaml", Replaced(kStudy, "evaluations: 24", "evaluations: 40"));
  const CommandResult result = Search("grown");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_NE(result.output.find("small: 100 evaluations, 0 failed, 84 of them from earlier"),
            std::string::npos)
      << result.output;
  ASSERT_EQ(Search("large").status, 0);
  ExpectSame("large", "grown");
}

TEST_F(Learn, AChangedStudyOrExperimentIsRefusedWithTheDifference) {
  ASSERT_EQ(Search("run").status, 0);
  Write("study.yaml", Replaced(kStudy, "high: 4, scale: log", "high: 5, scale: log"));
  CommandResult result = Search("run");
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(
      result.errors,
      "run/study.sqlite: error: the folder contains another study: its study differs\n"
      "  - parameter frequency.motion.sine.frequency_hz: 0.5..4 Hz log targets "
      "motion.sine.frequency_hz\n"
      "  + parameter frequency.motion.sine.frequency_hz: 0.5..5 Hz log targets "
      "motion.sine.frequency_hz (choose another folder with `--out`, or undo the change; only "
      "`evaluations` of the last search may change)\n");
  Write("study.yaml", kStudy);
  Write("experiment.yaml", Replaced(kExperiment, "0.8", "0.9"));
  result = Search("run");
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.errors.find("its experiment differs\n  - duration_s: 0.8\n  + duration_s: 0.9"),
            std::string::npos)
      << result.errors;
  Write("experiment.yaml", kExperiment);
  EXPECT_EQ(Search("run").status, 0);
}

TEST_F(Learn, AnotherBuildThatGivesOtherNumbersIsRefused) {
  ASSERT_EQ(Search("run").status, 0);
  // as if written by another build
  Change("run", [](learn::LogContents& log) { log.evaluations[0].worlds[1].state_hash = 1; });
  const CommandResult result = Search("run");
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(
      result.errors,
      "run/study.sqlite: error: another build of taut wrote the folder: evaluation 0 now ends in a "
      "different state (choose another folder with `--out`)\n");
}

TEST_F(Learn, AFolderOfAnotherVersionGoesOnIfItsNumbersAreTheSame) {
  ASSERT_EQ(Search("run").status, 0);
  // as if written by an earlier version, without start noise
  Change("run", [](learn::LogContents& log) {
    log.facts["taut_version"] = "0.0.1";
    std::string& text = log.facts["experiment"];
    const std::size_t from = text.find("\nstart_noise: "), to = text.find('\n', from + 1);
    ASSERT_NE(from, text.npos);
    text.erase(from, to - from);
    log.evaluations.resize(50);
  });
  const CommandResult result = Search("run");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_NE(result.output.find("small: 84 evaluations, 0 failed, 50 of them from earlier"),
            std::string::npos)
      << result.output;
}

TEST_F(Learn, AFullDiskStopsItAndLosesNothing) {
  const CommandResult full = Search("full", {}, [] {
    const rlimit limit{150'000, 150'000};  // limit of every file, like a disk that fills up
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  EXPECT_EQ(full.status, 1);
  EXPECT_NE(full.errors.find("full/study.sqlite: error: cannot write: "), std::string::npos)
      << full.errors;
  EXPECT_NE(full.errors.find("the logged evaluations are safe"), std::string::npos) << full.errors;
  const std::size_t kept = Result("full").evaluations.size();
  EXPECT_GT(kept, 0u);
  EXPECT_LT(kept, 84u);
  ASSERT_EQ(Search("full").status, 0);
  ASSERT_EQ(Search("whole").status, 0);
  ExpectSame("whole", "full");
}

TEST_F(Learn, TwoAtOnceAreRefused) {
  Write("study.yaml", Replaced(kStudy, "evaluations: 24", "evaluations: 100000"));
  const pid_t first = Start({"learn", "study.yaml", "--out", "run", "--quiet"});
  while (!std::filesystem::exists(Path("run/study.sqlite"))) std::this_thread::yield();
  const CommandResult second = Search("run");
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(second.errors,
            "run: error: another process is writing into this folder (wait for it, stop it, or "
            "give `--out` another folder)\n");
  kill(first, SIGKILL);
  End(first);
}

TEST_F(Learn, WorldsThatBlowUpAreCountedAndNeverWin) {
  Write("study.yaml", R"(taut: 1
kind: study
name: fragile
experiment: experiment.yaml
vary:
  - {each: model.mass.segment_1, low: 1e-320, high: 1, scale: log}
objective: {measure: distance}
search:
  - {method: monte_carlo, evaluations: 40}
)");
  const CommandResult result = Search("run");
  ASSERT_EQ(result.status, 0) << result.errors;
  const StudyResult study = Result("run");
  std::size_t failed = 0;
  for (const Evaluation& e : study.evaluations) {
    EXPECT_EQ(std::isnan(e.score), !e.failed.empty());
    failed += !e.failed.empty();
  }
  EXPECT_GT(failed, 0u);
  EXPECT_LT(failed, 40u);
  ASSERT_NE(study.best(), nullptr);
  EXPECT_EQ(study.best()->failed, "");
  EXPECT_NE(result.output.find("40 evaluations, " + std::to_string(failed) + " failed"),
            std::string::npos)
      << result.output;
}

TEST_F(Learn, AnObjectiveThatIsNotANumberIsAFailure) {
  Write("experiment.yaml", kExperiment + "controllers: []\n");
  Write("study.yaml", R"(taut: 1
kind: study
name: idle
experiment: experiment.yaml
vary:
  - {each: model.friction, low: 0.5, high: 1}
objective: {measure: distance_per_energy}
search:
  - {method: monte_carlo, evaluations: 4}
)");
  const CommandResult result = Search("run");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("4 evaluations, 4 failed"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("best: none, every evaluation failed"), std::string::npos);
  EXPECT_EQ(Result("run").evaluations[0].failed,
            "world 0: the objective is not a finite number: the motors did no work");
}

TEST_F(Learn, TheBestIsReplayedToTheSameState) {
  ASSERT_EQ(Search("run").status, 0);
  const CommandResult top = Taut({"learn", "--top", "3", "--json", "run"});
  ASSERT_EQ(top.status, 0) << top.errors;
  const auto list = nlohmann::json::parse(top.output);
  ASSERT_EQ(list.size(), 3u);
  EXPECT_GE(list[0].at("score"), list[1].at("score"));
  EXPECT_GE(list[1].at("score"), list[2].at("score"));
  const CommandResult best = Taut({"learn", "--best", "run"});
  ASSERT_EQ(best.status, 0)
      << best.errors;  // status 1 if the final state differs from the logged state
  const StudyResult study = Result("run");
  EXPECT_EQ(study.best()->score, list[0].at("score").get<double>());
  // The written inputs reproduce the run.
  const CommandResult again = Taut({"run", "run/best/inputs.yaml", "--quiet", "--out", "again"});
  ASSERT_EQ(again.status, 0) << again.errors;
  const auto summary = nlohmann::json::parse(Read(Path("again/summary.json")));
  EXPECT_EQ(std::stoull(summary.at("state_hash").get<std::string>(), nullptr, 16),
            study.best()->worlds[0].state_hash);
  EXPECT_TRUE(std::filesystem::exists(Path("run/best/trace.h5")));
  EXPECT_TRUE(std::filesystem::exists(Path("run/best/report.html")));
  EXPECT_TRUE(std::filesystem::exists(Path("run/best/motion.gait.yaml")));
}

TEST_F(Learn, FoldersThatHoldNoStudyAreSaid) {
  CommandResult result = Taut({"learn", "--best", "nowhere"});
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(
      result.errors,
      "nowhere/study.sqlite: error: the file does not exist (give the folder that `taut learn "
      "STUDY` wrote)\n");
  std::filesystem::create_directories(Path("other"));
  Write("other/study.sqlite", "not a database, but long enough to look at for a while");
  result = Taut({"learn", "--top", "3", "other"});
  EXPECT_EQ(result.status, 3);
  const std::string expected =
      "other/study.sqlite: error: the file is not the log of a study, or damaged: file is not a "
      "database\n";
  EXPECT_EQ(result.errors, expected);
  result = Search("other");
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.errors, expected);
}

}  // namespace
}  // namespace taut::test
