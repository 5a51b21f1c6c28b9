// The command `taut compare`
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

struct Outcome {
  int status = -1;
  std::string output, errors;
};

class CompareCommand : public TraceFolder {
 protected:
  CompareCommand() {
    Diagnostics out;
    const std::vector<ChannelInfo> channels = {{"cable/a/tension_n", "N"},
                                               {"cable/b/tension_n", "N"}};
    auto writer = CreateHdf5Trace(Path("a.h5"), channels, {}, out);
    EXPECT_TRUE(writer) << out.Format();
    std::string csv = "time_s,a_lbf,b_lbf\n";
    for (int i = 0; i <= 100; ++i) {
      const double row[] = {20.0 + i % 7, 30.0};
      writer->Append(0.1 * i, row);
      csv += std::to_string(i) + "e-1," + std::to_string(5 + i % 7) + ",6\n";
    }
    EXPECT_TRUE(writer->Finish());
    WriteFile("b.csv", csv);
    WriteFile("map.json", R"({"version": 1, "channels": [
      {"from": "*_lbf", "to": "cable/*/tension_n", "scale": 4}]})");
  }

  /// Runs `taut compare` in the folder.
  Outcome Run(const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && '" TAUT_COMMAND "' compare " +
                                arguments + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), ReadFile(Path("out.txt")), ReadFile(Path("err.txt"))};
  }
};

TEST_F(CompareCommand, PassesWithinTheLimitAndFailsBeyondIt) {
  // Maximum of a: 30 N; maximum of b: 11 lbf, here 44 N; the error is -31.82 %.
  Outcome outcome = Run("a.h5 b.csv --map map.json --max_error_percent 32");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("largest cable/*/tension_n: error -31.82 %"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(outcome.output.rfind("PASS: within the limits\n", 0), 0u) << outcome.output;
  EXPECT_EQ(outcome.output.find("rmse"), std::string::npos) << "tables are printed on request";
  EXPECT_NE(Run("a.h5 b.csv --map map.json --tables").output.find("rmse"), std::string::npos);
  outcome = Run("a.h5 b.csv --map map.json --max_error_percent 31");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.output.rfind("FAIL: the largest cable/*/tension_n differs by -31.82 %", 0), 0u)
      << outcome.output;
  outcome = Run("a.h5 b.csv --map map.json");
  EXPECT_EQ(outcome.status, 0) << "no limit, no verdict";
  EXPECT_EQ(outcome.output.find("PASS"), std::string::npos);
  // 6 lbf of b are 24 N: the RMSE of cable b is exactly 6 N.
  EXPECT_EQ(Run("a.h5 b.csv --map map.json --channels 'cable/b/*' --max_rmse 6.01").status, 0);
  EXPECT_EQ(Run("a.h5 b.csv --map map.json --channels 'cable/b/*' --max_rmse 5.99").status, 1);
  EXPECT_EQ(Run("b.csv a.h5 --map_a map.json --max_error_percent 46.7").status, 0);
}

TEST_F(CompareCommand, AFolderOfARunStandsForItsTrace) {
  std::filesystem::create_directory(Path("run"));
  std::filesystem::copy_file(Path("a.h5"), Path("run/trace.h5"));
  const Outcome outcome = Run("run a.h5 --max_rmse 0");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output.rfind("PASS: within the limits\nrun/trace.h5 and a.h5 are equal: 2 "
                                 "channels, 101 rows\n",
                                 0),
            0u)
      << outcome.output;
  EXPECT_TRUE(outcome.output.ends_with("\nnext: taut report run/trace.h5 --compare a.h5\n"))
      << outcome.output;
}

TEST_F(CompareCommand, JsonAloneIsOnStandardOutput) {
  const Outcome outcome = Run(
      "--json --phase early=0:1 --phase late=9:10 --channels 'cable/a/*' --channels 'cable/b/*' "
      "a.h5 b.csv --map map.json --from_s 0.5 --max_error_percent 1");
  EXPECT_EQ(outcome.status, 1);
  const auto json = nlohmann::ordered_json::parse(outcome.output);
  EXPECT_EQ(json["channels"].size(), 2u);
  EXPECT_EQ(json["phases"][1]["name"], "late");
  EXPECT_EQ(json["from_s"], 0.5);
  EXPECT_EQ(json["channels"][1]["phases"]["early"]["a"]["rows"], 6);
  EXPECT_EQ(outcome.errors.substr(0, 5), "FAIL:");
}

TEST_F(CompareCommand, BadInputEndsWithThreeAndSaysWhatIsWrong) {
  Outcome outcome = Run("none.h5 b.csv --map none.json");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.errors,
            "none.h5: error: cannot open: No such file or directory\n"
            "none.json: error: cannot open: No such file or directory\n");
  EXPECT_EQ(outcome.output, "");
  outcome = Run("a.h5 b.csv");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.errors,
            "error: the traces have no channel in common (--map translates names)\n");
  EXPECT_NE(outcome.output.find("only in b (2): a_lbf b_lbf\n"), std::string::npos);
  outcome = Run("a.h5 b.csv --map map.json --from_s 20");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.errors, "error: the time ranges of the traces do not overlap\n");
}

TEST_F(CompareCommand, BadUsageEndsWithTwo) {
  for (const std::string phase : {"25:30", "x=30:25", "x=25", "=1:2", "x=a:3"}) {
    const Outcome outcome = Run("a.h5 b.csv --phase " + phase);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.errors.find("\"" + phase + "\" is not of the form NAME=FROM:TO"),
              std::string::npos)
        << outcome.errors;
  }
  EXPECT_EQ(Run("a.h5").status, 2);
  EXPECT_EQ(Run("a.h5 b.csv --max_lag_s -1").status, 2);
  EXPECT_EQ(Run("a.h5 b.csv --no-such-option").status, 2);
}

TEST_F(CompareCommand, HelpShowsExamples) {
  const Outcome outcome = Run("--help");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.output.find("taut compare runs/push/trace.h5 push_1000hz.csv.gz --map"),
            std::string::npos);
}

}  // namespace
}  // namespace taut::test
