// The command `taut report`
#include "tests/system/view_command.h"

namespace taut::test {
namespace {

using ReportCommand = ViewCommand;

/// Returns the data of a report.
Json DataOf(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="taut-report">)";
  const std::size_t from = page.find(open) + open.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST_F(ReportCommand, AReportHoldsTheRunAndTheNumbersOfItsSummary) {
  const CommandResult run = Run({"run", kHang, "--report", "--out", "run"});
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.output.find("Report: run/report.html\n"), std::string::npos) << run.output;
  const std::string page = Read(Path("run/report.html"));
  EXPECT_EQ(page.substr(page.size() - 6), "<p>end");
  const Json report = DataOf(page);
  EXPECT_EQ(report["version"], viewer::kProtocolVersion);
  EXPECT_EQ(report["title"], "hang");
  EXPECT_EQ(report["summary"], Json::parse(Read(Path("run/summary.json"))));
  EXPECT_EQ(report["inputs"], Read(Path("run/inputs.yaml")));
  EXPECT_EQ(report["metadata"]["experiment"], "hang");
  EXPECT_EQ(report["scene"]["bodies"].size(), 1u);
  const std::size_t numbers =
      report["frame_count"].get<std::size_t>() * report["frame_values"].get<std::size_t>();
  EXPECT_EQ(report["frames_base64"].get<std::string>().size(), (8 * numbers + 2) / 3 * 4);
  EXPECT_EQ(report["frame_count"], 151);  // 30 per second, including both ends
  ASSERT_EQ(report["rows"].size(), 1u);
  EXPECT_EQ(report["rows"][0]["count"], 1001);  // every row: 5 s at 200 Hz
  EXPECT_EQ(report["rows"][0]["channels"].size(), report["scene"]["channels"].size());
  EXPECT_EQ(report["comparisons"], Json::array());
  EXPECT_EQ(report["facts"]["time"], "5 s in steps of 0.001 s");
}

TEST_F(ReportCommand, PipesAndDevicesInPlaceOfTheSummaryAreNotOpened) {
  EXPECT_EQ(Run({"run", kHang, "--duration_s", "0.1", "--out", "run"}).status, 0);
  const std::string summary = Path("run/summary.json");
  for (const bool pipe : {true, false}) {
    std::filesystem::remove(summary);
    if (pipe) {
      ASSERT_EQ(mkfifo(summary.c_str(), 0600), 0);
    } else {
      std::filesystem::create_symlink("/dev/zero", summary);
    }
    const CommandResult report = Taut({"report", "run"}, [] {
      setenv("TAUT_WEB", "web", 1);
      alarm(60);
    });
    EXPECT_EQ(report.status, 0) << report.errors;
    EXPECT_TRUE(DataOf(Read(Path("run/report.html")))["summary"].is_null());
  }
  std::filesystem::remove(Path("run/inputs.yaml"));
  ASSERT_EQ(mkfifo(Path("run/inputs.yaml").c_str(), 0600), 0);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"report", "run"}, {"size", "run", "--catalogue", "none.yaml"}}) {
    const CommandResult ended = Taut(words, [] {
      setenv("TAUT_WEB", "web", 1);
      alarm(60);
    });
    EXPECT_EQ(ended.status, words[0] == "report" ? 0 : 3) << ended.errors;
  }
}

TEST_F(ReportCommand, AReportComparesTwoTraces) {
  Run({"run", kHang, "--quiet", "--out", "a"});
  Run({"run", kHang, "--quiet", "--out", "b", "--set", "mass_kg=0.6"});
  const CommandResult result =
      Run({"report", "b/trace.h5", "--compare", "a/trace.h5", "--out", "both.html"});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output,
            "Report: both.html\n"
            "figure: taut plot b/trace.h5 a/trace.h5 --out both.pdf\n"
            "next: xdg-open both.html\n");
  const Json report = DataOf(Read(Path("both.html")));
  EXPECT_EQ(report["scene"]["compared"][0]["name"], "hang (a/trace.h5)");
  EXPECT_EQ(report["scene"]["run_name"], "hang (b/trace.h5)");
  // that run minus this one
  const CommandResult compare = Run({"compare", "a/trace.h5", "b/trace.h5", "--json"});
  EXPECT_EQ(report["comparisons"][0]["channels"], Json::parse(compare.output)["channels"]);
  ASSERT_EQ(report["rows"].size(), 2u);
  EXPECT_EQ(report["rows"][1]["source"], 1);
  EXPECT_EQ(report["rows"][0]["channels"], report["rows"][1]["channels"]);
}

TEST_F(ReportCommand, ARunMayBeGivenAsItsFolder) {
  Run({"run", kHang, "--quiet", "--out", "a"});
  Run({"run", kHang, "--quiet", "--out", "b", "--csv", "--set", "mass_kg=0.6"});
  std::filesystem::remove(Path("b/trace.h5"));
  CommandResult result = Run({"report", "a/", "--compare", "b"});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output,
            "Report: a/report.html\n"
            "figure: taut plot a/trace.h5 b/trace.csv --out a/report.pdf\n"
            "next: xdg-open a/report.html\n");
  const Json report = DataOf(Read(Path("a/report.html")));
  EXPECT_EQ(report["scene"]["run_name"], "hang (a/trace.h5)");
  EXPECT_EQ(report["scene"]["compared"][0]["name"],
            "b/trace.csv");  // this file lacks the name of its run
  std::filesystem::create_directory(Path("empty"));
  result = Run({"report", "empty"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.errors.find("empty/trace.h5: error: "), std::string::npos) << result.errors;
}

TEST_F(ReportCommand, SeveralRunsAreNamedTogetherOrOneByOne) {
  for (const char* name : {"a", "b", "c", "d"}) Run({"run", kHang, "--quiet", "--out", name});
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"a/trace.h5", "--compare", "b/trace.h5", "c/trace.h5", "d/trace.h5"},
           {"--compare", "b/trace.h5", "--compare", "c/trace.h5", "--compare", "d/trace.h5",
            "a/trace.h5"}}) {
    std::vector<std::string> all{"report", "--out", "all.html"};
    all.insert(all.end(), words.begin(), words.end());
    ASSERT_EQ(Run(all).status, 0);
    const Json report = DataOf(Read(Path("all.html")));
    EXPECT_EQ(report["scene"]["run_name"], "hang (a/trace.h5)");
    ASSERT_EQ(report["scene"]["compared"].size(), 3u);
    EXPECT_EQ(report["scene"]["compared"][2]["name"], "hang (d/trace.h5)");
  }
}

TEST_F(ReportCommand, EveryRunThatCannotBeReadIsNamed) {
  Run({"run", kHang, "--quiet", "--out", "a"});
  const CommandResult result =
      Run({"report", "a/trace.h5", "--compare", "none.h5", Write("broken.h5", "no trace")});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.errors.find("none.h5: error: cannot open"), std::string::npos);
  EXPECT_NE(result.errors.find("broken.h5: error: the file is not HDF5"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(Path("a/report.html")));
}

TEST_F(ReportCommand, NothingInAReportCanEndTheElementThatHoldsIt) {
  const std::string text = Read(TAUT_SOURCE_DIR "/share/experiments/hang.yaml");
  std::string evil = text;
  const std::string model = "../models/hanging_mass.yaml";
  evil.replace(evil.find(model), model.size(), TAUT_SOURCE_DIR "/share/models/hanging_mass.yaml");
  const std::string key = "description: ";
  evil.insert(evil.find(key) + key.size(), "\"</script><script>alert(1)</script>\" #");
  const CommandResult run = Run({"run", Write("evil.yaml", evil), "--report", "--out", "run"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string page = Read(Path("run/report.html"));
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_NE(DataOf(page)["inputs"].get<std::string>().find("</script><script>alert(1)"),
            std::string::npos);
}

TEST_F(ReportCommand, AReportThatCannotBeMadeIsSaid) {
  Run({"run", kHang, "--quiet", "--out", "run"});
  CommandResult result = Run({"report", "run/trace.h5"}, "nowhere");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, kNoPages);
  result = Run({"report", "absent.h5"});
  EXPECT_EQ(result.status, 3);
  result = Run({"report", "run/trace.h5", "--out", "no/such/folder.html"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, "no/such/folder.html: error: cannot write: No such file or directory\n");
  Write("web/report.html", "<p>some other page");
  result = Run({"report", "run/trace.h5"});
  EXPECT_NE(result.errors.find("this page is not the template of reports"), std::string::npos);
  result = Run({"run", kHang, "--quiet", "--report", "--out", "run"}, "nowhere");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.errors.find("run/report.html: error: cannot create the report: the viewer's "
                               "pages are missing"),
            std::string::npos)
      << result.errors;
}

/// The built page: a report contains no reference to another host.
TEST_F(ReportCommand, ARealReportLoadsNothing) {
  if (!std::filesystem::exists(TAUT_WEB_FOLDER "/report.html")) GTEST_SKIP() << "no pages built";
  const CommandResult run = Run({"run", kHang, "--report", "--out", "run"}, TAUT_WEB_FOLDER);
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string page = Read(Path("run/report.html"));
  for (const char* load :
       {R"((src|href|action|data|poster|srcset)\s*=\s*["']?\s*(https?:)?//)",
        R"(url\(\s*["']?\s*(https?:)?//)",
        R"((fetch|import|importScripts|Worker|WebSocket)\(\s*["'`](https?|wss?):)", R"(@import)",
        R"(<link[^>]*stylesheet)", R"(<script[^>]*\ssrc)"}) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(page, found, std::regex(load, std::regex::icase)))
        << load << ": " << found[0];
  }
  EXPECT_EQ(DataOf(page)["summary"], Json::parse(Read(Path("run/summary.json"))));
}

}  // namespace
}  // namespace taut::test
