// `taut learn` and a folder that is not what it was: damaged records, deleted or moved meanwhile.
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/system/learn_fixture.h"

namespace taut::test {
namespace {

const std::string kThree =
    "run/study.sqlite: error: 84 evaluations were written, 81 of them are good\n"
    "run/study.sqlite: error: evaluation 17: 0 values where the study has 7 parameters\n"
    "run/study.sqlite: error: evaluation 40: its checksum says that it was changed\n"
    "run/study.sqlite: error: evaluation 83: score is not a number\n"
    "run/study.sqlite: error: is damaged; 81 evaluations are good (`--skip_damaged` uses these; a "
    "search does the others once more)\n";

class DamagedLearn : public Learn {
 protected:
  /// A finished search in `run` of which three records are damaged.
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
  EXPECT_EQ(result.errors,
            "warning: run: skipped: evaluation 17: 0 values where the study has 7 parameters\n"
            "warning: run: skipped: evaluation 40: its checksum says that it was changed\n"
            "warning: run: skipped: evaluation 83: score is not a number\n"
            "warning: run: skipped: 84 evaluations were written, 81 of them are good\n");
  EXPECT_EQ(Taut({"learn", "--best", "--quiet", "--skip_damaged", "run"}).status, 0);
}

TEST_F(DamagedLearn, ASearchDoesTheDamagedOnesOnceMoreToTheSameEnd) {
  MakeThree();
  ASSERT_EQ(Search("whole").status, 0);
  CommandResult result = Search("run", {"--skip_damaged"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_NE(result.output.find("84 evaluations, 0 failed, 81 of them from before"),
            std::string::npos)
      << result.output;
  ExpectSame("whole", "run");  // reads without skipping
  // What was there is still to be looked at.
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
    EXPECT_EQ(result.errors,
              "run/study.sqlite: error: is damaged: facts or parameters were changed (without that "
              "no evaluation means anything; give `--out` another folder)\n");
  }
}

/// Starts a long search, does something to its folder once it has logged, and waits for the end.
class GoneLearn : public Learn {
 protected:
  CommandResult While(const std::function<void()>& accident) {
    Write("study.yaml", Replaced(kStudy, "evaluations: 24", "evaluations: 100000"));
    const pid_t pid = Start({"learn", "study.yaml", "--out", "run", "--quiet"});
    // The first page of the log's journal comes before the first evaluation, and this is larger.
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
      "run/study.sqlite: error: is gone: it or its folder was deleted or moved during the search "
      "(if it was moved, `--out` with its new place goes on)\n";
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
