// `taut learn` with a changed folder: damaged records, folder deleted or moved during the search
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/system/learn_fixture.h"

namespace taut::test {
namespace {

const std::string kThree =
    "run/study.sqlite: error: 84 evaluations were written, 81 of them are intact\n"
    "run/study.sqlite: error: evaluation 17: it has 0 values, but the study has 7 parameters\n"
    "run/study.sqlite: error: evaluation 40: its checksum does not match its content\n"
    "run/study.sqlite: error: evaluation 83: score is not a number\n"
    "run/study.sqlite: error: the log is damaged; 81 evaluations are intact (use these with "
    "`--skip_damaged`; a search repeats the others)\n";

class DamagedLearn : public Learn {
 protected:
  /// Makes a finished search in `run`, in which three records are damaged.
  void MakeThree() {
    ASSERT_EQ(Search("run").status, 0);
    Sql("run", "UPDATE evaluation SET parameter_values = '[]' WHERE id = 17");
    Sql("run", "UPDATE evaluation SET score = score + 1000 WHERE id = 40");
    Sql("run", "UPDATE evaluation SET score = 'much' WHERE id = 83");
  }
};

TEST_F(DamagedLearn, IsRefusedByAllThatReadItWithEveryRecordNamed) {
  MakeThree();
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"learn", "--top", "3", "run"},
                                             {"learn", "--top", "3", "--json", "run"},
                                             {"learn", "--best", "run"},
                                             {"learn", "study.yaml", "--out", "run"}}) {
    const CommandResult result = Taut(arguments);
    EXPECT_EQ(result.status, 3) << arguments[1];
    EXPECT_EQ(result.errors, kThree) << arguments[1];
    EXPECT_EQ(result.output, "");
  }
}

TEST_F(DamagedLearn, TheRestIsUsedIfToldSo) {
  MakeThree();
  CommandResult result = Taut({"learn", "--top", "100", "--json", "--skip_damaged", "run"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(nlohmann::json::parse(result.output).size(), 81u);
  EXPECT_EQ(
      result.errors,
      "warning: run: skipped: evaluation 17: it has 0 values, but the study has 7 parameters\n"
      "warning: run: skipped: evaluation 40: its checksum does not match its content\n"
      "warning: run: skipped: evaluation 83: score is not a number\n"
      "warning: run: skipped: 84 evaluations were written, 81 of them are intact\n");
  EXPECT_EQ(Taut({"learn", "--best", "--quiet", "--skip_damaged", "run"}).status, 0);
}

TEST_F(DamagedLearn, ASearchDoesTheDamagedOnesOnceMoreToTheSameEnd) {
  MakeThree();
  ASSERT_EQ(Search("whole").status, 0);
  CommandResult result = Search("run", {"--skip_damaged"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_NE(result.output.find("84 evaluations, 0 failed, 81 of them from earlier"),
            std::string::npos)
      << result.output;
  ExpectSame("whole", "run");  // reads without skipping
  // The damaged log is kept for inspection.
  std::filesystem::create_directory(Path("kept"));
  std::filesystem::rename(Path("run/study.sqlite.damaged"), Path("kept/study.sqlite"));
  result = Taut({"learn", "--top", "3", "kept"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.errors.find("evaluation 40: its checksum"), std::string::npos);
}

TEST_F(DamagedLearn, ALogWithoutItsStudyIsNotUsedAtAll) {
  ASSERT_EQ(Search("run").status, 0);
  Sql("run", "UPDATE parameter SET high = 5 WHERE position = 0");
  for (const char* flag : {"--quiet", "--skip_damaged"}) {
    const CommandResult result = Search("run", {flag});
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(
        result.errors,
        "run/study.sqlite: error: the log is damaged: its metadata or parameters were changed "
        "(its evaluations are unusable; choose another folder with `--out`)\n");
  }
}

/// Starts a long search, changes its folder after the first records, and waits for the end.
class GoneLearn : public Learn {
 protected:
  CommandResult While(const std::function<void()>& accident) {
    Write("study.yaml", Replaced(kStudy, "evaluations: 24", "evaluations: 100000"));
    const pid_t pid = Start({"learn", "study.yaml", "--out", "run", "--quiet"});
    // The first page of the log's journal is written before the first evaluation and is smaller
    // than this.
    const auto grown = [&] {
      std::error_code none;
      const auto bytes = std::filesystem::file_size(Path("run/study.sqlite-wal"), none);
      return !none && bytes > 100'000;
    };
    while (!grown()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    accident();
    return End(pid);
  }
  const std::string kGone =
      "run/study.sqlite: error: the log or its folder was deleted or moved during the search (if "
      "it was moved, resume with `--out` and its new path)\n";
};

TEST_F(GoneLearn, AFolderDeletedMeanwhileIsAnError) {
  const CommandResult result = While([&] { std::filesystem::remove_all(Path("run")); });
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, kGone);
}

TEST_F(GoneLearn, AFolderMovedMeanwhileIsAnErrorAndGoesOnElsewhere) {
  const CommandResult result = While([&] {
    std::filesystem::rename(Path("run"), Path("elsewhere"));
    std::filesystem::create_directory(Path("run"));
    Write("run/study.sqlite", "something else");
  });
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, kGone);
  EXPECT_EQ(Read(Path("run/study.sqlite")), "something else");
  EXPECT_GT(Result("elsewhere").evaluations.size(), 0u);
  Write("study.yaml", kStudy);
  ASSERT_EQ(Search("elsewhere").status, 0);
  ASSERT_EQ(Search("whole").status, 0);
  if (Result("elsewhere").evaluations.size() == 84) ExpectSame("whole", "elsewhere");
}

}  // namespace
}  // namespace taut::test
