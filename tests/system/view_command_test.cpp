// `taut view` and `taut report` as a user meets them.
#include <chrono>
#include <regex>
#include <thread>

#include "taut/trace.h"
#include "tests/system/command.h"
#include "tests/viewer/client.h"

namespace taut::test {
namespace {

const std::string kHang = TAUT_SOURCE_DIR "/experiments/hang.yaml";
const std::string kNoPages =
    "error: the viewer's pages are missing; they are built with taut where node and npm are "
    "(apt-get install nodejs npm, then script/build)\n";
/// What reports are made of, without what makes it a page.
const std::string kTemplate =
    R"(<!doctype html><script type="application/json" id="taut-report"></script><p>end)";

class ViewCommand : public CommandTest {
 protected:
  ViewCommand() {
    std::filesystem::create_directory(Path("web"));
    Write("web/index.html", "<p>the page");
    Write("web/report.html", kTemplate);
  }
  ~ViewCommand() override {
    if (viewing_ > 0) Stop(viewing_);  // the test threw
  }

  CommandResult Run(const std::vector<std::string>& arguments, const std::string& web = "web") {
    return Taut(arguments, [&] { setenv("TAUT_WEB", web.c_str(), 1); });
  }

  /// Starts `taut view` on a free port and waits for its address.
  pid_t StartView(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "view");
    arguments.insert(arguments.end(), {"--port", "0"});
    std::filesystem::remove(Path("out.txt"));
    const pid_t pid = Start(arguments, [] { setenv("TAUT_WEB", "web", 1); });
    viewing_ = pid;
    const std::regex address("http://([^:]+):([0-9]+)/([^\n]*)\n");
    std::smatch found;
    while (waitpid(pid, nullptr, WNOHANG) == 0) {
      const std::string said = Read(Path("out.txt"));
      if (std::regex_search(said, found, address)) {
        host_ = found[1];
        port_ = static_cast<std::uint16_t>(std::stoi(found[2]));
        query_ = found[3];
        return pid;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    viewing_ = -1;
    ADD_FAILURE() << "ended without an address: " << Read(Path("out.txt")) << Read(Path("err.txt"));
    return pid;
  }

  int Stop(pid_t pid, int number = SIGINT) {
    kill(pid, number);
    viewing_ = -1;
    return End(pid).status;
  }

  pid_t viewing_ = -1;
  std::string host_, query_;
  std::uint16_t port_ = 0;
};

TEST_F(ViewCommand, ServesALiveRunUntilCtrlC) {
  const pid_t pid = StartView({kHang});
  EXPECT_EQ(host_, "localhost");
  EXPECT_EQ(query_, "");
  EXPECT_EQ(Get(port_, "/").body, "<p>the page");
  EXPECT_EQ(Get(port_, "/report.html").status, 404u);  // a template is no page
  {
    Client client(port_);
    EXPECT_EQ(client.Await("hello")["mode"], "live");
    client.AwaitFrame([](const auto& f) { return f[viewer::kFrameTimeS] > 0.1; });
  }
  EXPECT_EQ(Stop(pid), 0);
}

TEST_F(ViewCommand, EndsWithItsTerminal) { EXPECT_EQ(Stop(StartView({kHang}), SIGHUP), 0); }

TEST_F(ViewCommand, TheStepIsTheOneAskedForAfterARestartToo) {
  const pid_t pid = StartView({kHang, "--paused", "--step_s", "0.01"});
  Client client(port_);
  client.Await("scene");
  client.Send({{"type", "step"}});
  client.AwaitFrame([](const auto& f) { return f[viewer::kFrameTimeS] == 0.01; });
  client.Send({{"type", "set_parameter"}, {"name", "mass_kg"}, {"value", 1}});
  client.AwaitFrame([](const auto& f) { return f[viewer::kFrameRun] == 2; });
  client.Send({{"type", "step"}});
  client.AwaitFrame([](const auto& f) { return f[viewer::kFrameTimeS] == 0.01; });
  EXPECT_EQ(Stop(pid), 0);
}

TEST_F(ViewCommand, ListeningToOthersNeedsTheTokenOfTheAddress) {
  const pid_t pid = StartView({kHang, "--listen", "0.0.0.0", "--paused"});
  ASSERT_EQ(query_.rfind("?token=", 0), 0u) << query_;
  EXPECT_EQ(query_.size(), 7u + 32u);
  EXPECT_EQ(Get(port_, "/").status, 403u);
  EXPECT_EQ(Get(port_, "/" + query_).status, 200u);
  EXPECT_EQ(Stop(pid), 0);
}

TEST_F(ViewCommand, APortInUseIsNamed) {
  const pid_t pid = StartView({kHang, "--paused"});
  const CommandResult second = Run({"view", kHang, "--port", std::to_string(port_)});
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(
      second.errors.rfind(
          "error: port " + std::to_string(port_) + " is in use; the next that is free: --port ", 0),
      0u)
      << second.errors;
  EXPECT_EQ(Stop(pid), 0);
}

TEST_F(ViewCommand, AModelStandsStillAsDescribedOrSettled) {
  const std::string model = TAUT_SOURCE_DIR "/examples/my_first_robot.yaml";
  double energies[2] = {};
  for (const bool settled : {false, true}) {
    std::vector<std::string> arguments{model};
    if (settled) arguments.push_back("--settled");
    const pid_t pid = StartView(arguments);
    Client client(port_);
    EXPECT_EQ(client.Await("hello")["mode"], "model");
    const ReceivedFrame frame = client.AwaitFrame();
    EXPECT_EQ(frame[viewer::kFramePaused], 1);
    EXPECT_EQ(frame[viewer::kFrameTimeS], 0);
    energies[settled ? 1 : 0] = frame[viewer::kFrameElasticJ];
    client.Close();
    EXPECT_EQ(Stop(pid), 0);
  }
  EXPECT_LT(energies[1], energies[0]);
}

TEST_F(ViewCommand, ATraceCutOffInTheMiddleIsReplayed) {
  const pid_t run = Start({"run", kHang, "--duration_s", "1e6", "--out", "cut", "--quiet"});
  for (std::optional<Trace> trace; !trace || trace->time_s.size() < 300;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    Diagnostics not_yet;
    trace = ReadTrace(Path("cut/trace.h5"), not_yet);
  }
  kill(run, SIGKILL);
  End(run);
  const pid_t pid = StartView({"cut/trace.h5"});
  Client client(port_);
  EXPECT_EQ(client.Await("hello")["mode"], "replay");
  const Json scene = client.Await("scene")["scene"];
  EXPECT_GT(scene["duration_s"].get<double>(), 1);
  const auto notice = scene["notice"].get<std::string>();
  EXPECT_EQ(notice.rfind("the trace ends at ", 0), 0u);
  EXPECT_TRUE(notice.ends_with("; the trace is not finished: its run goes on, or was killed"));
  client.Close();
  EXPECT_EQ(Stop(pid), 0);
}

TEST_F(ViewCommand, BadInputIsSaidAtOnce) {
  const std::string bad = Write("bad.yaml", "taut: 1\nkind: experiment\nnmae: x\n");
  CommandResult result = Run({"view", bad});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.errors.find("bad.yaml:3:1: error: unknown key \"nmae\""), std::string::npos)
      << result.errors;
  result = Run({"view", kHang}, "nowhere");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, kNoPages);
  result = Run({"view", kHang, "--listen", "here"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors,
            "error: \"here\" is not an address; 127.0.0.1 is this machine, 0.0.0.0 listens to "
            "all\n");
  EXPECT_EQ(Run({"view", kHang, "--speed", "0"}).status, 2);
  EXPECT_EQ(Run({"view", kHang, "--speed", "2", "--max"}).status, 2);
  EXPECT_EQ(Run({"view", kHang, "--speed", "nan"}).status, 2);
  EXPECT_EQ(Run({"view", kHang, "--step_s", "2"}).status, 2);
  EXPECT_EQ(Run({"view", "absent.yaml"}).status, 3);
  result = Run({"view", kHang, "--compare", "a.h5"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors, "error: --compare goes with a trace only\n");
  result = Run({"view", "a.h5", "--out", "folder"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors, "error: --set, --step_s, --settled and --out do not go with a trace\n");
}

/// The data of a report.
Json DataOf(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="taut-report">)";
  const std::size_t from = page.find(open) + open.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST_F(ViewCommand, AReportHoldsTheRunAndTheNumbersOfItsSummary) {
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
  EXPECT_EQ(report["frame_count"], 151);  // 30 a second, both ends
  ASSERT_EQ(report["rows"].size(), 1u);
  EXPECT_EQ(report["rows"][0]["count"], 1001);  // every row: 5 s at 200 Hz
  EXPECT_EQ(report["rows"][0]["channels"].size(), report["scene"]["channels"].size());
  EXPECT_EQ(report["comparison"], nullptr);
}

TEST_F(ViewCommand, AReportComparesTwoTraces) {
  Run({"run", kHang, "--quiet", "--out", "a"});
  Run({"run", kHang, "--quiet", "--out", "b", "--set", "mass_kg=0.6"});
  const CommandResult result =
      Run({"report", "b/trace.h5", "--compare", "a/trace.h5", "--out", "both.html"});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output, "Report: both.html\n");
  const Json report = DataOf(Read(Path("both.html")));
  EXPECT_EQ(report["scene"]["reference"]["name"], "hang (a/trace.h5)");
  const CommandResult compare = Run({"compare", "b/trace.h5", "a/trace.h5", "--json"});
  EXPECT_EQ(report["comparison"]["channels"].size(),
            Json::parse(compare.output)["channels"].size());
  EXPECT_EQ(report["comparison"]["channels"][0]["rmse"],
            Json::parse(compare.output)["channels"][0]["rmse"]);
  ASSERT_EQ(report["rows"].size(), 2u);
  EXPECT_EQ(report["rows"][1]["source"], 1);
  EXPECT_EQ(report["rows"][0]["channels"], report["rows"][1]["channels"]);
}

TEST_F(ViewCommand, NothingInAReportCanEndTheElementThatHoldsIt) {
  const std::string text = Read(TAUT_SOURCE_DIR "/experiments/hang.yaml");
  std::string evil = text;
  const std::string model = "../models/hanging_mass.yaml";
  evil.replace(evil.find(model), model.size(), TAUT_SOURCE_DIR "/models/hanging_mass.yaml");
  const std::string key = "description: ";
  evil.insert(evil.find(key) + key.size(), "\"</script><script>alert(1)</script>\" #");
  const CommandResult run = Run({"run", Write("evil.yaml", evil), "--report", "--out", "run"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string page = Read(Path("run/report.html"));
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_NE(DataOf(page)["inputs"].get<std::string>().find("</script><script>alert(1)"),
            std::string::npos);
}

TEST_F(ViewCommand, AReportThatCannotBeMadeIsSaid) {
  Run({"run", kHang, "--quiet", "--out", "run"});
  CommandResult result = Run({"report", "run/trace.h5"}, "nowhere");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, kNoPages);
  result = Run({"report", "absent.h5"});
  EXPECT_EQ(result.status, 3);
  result = Run({"report", "run/trace.h5", "--out", "no/such/folder.html"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors,
            "no/such/folder.html: error: cannot be written: No such file or directory\n");
  Write("web/report.html", "<p>some other page");
  result = Run({"report", "run/trace.h5"});
  EXPECT_NE(result.errors.find("is not the page that reports are made of"), std::string::npos);
  result = Run({"run", kHang, "--quiet", "--report", "--out", "run"}, "nowhere");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.errors.find("run/report.html: error: the report cannot be made: the viewer's "
                               "pages are missing"),
            std::string::npos)
      << result.errors;
}

/// The page that was built: nothing in a report makes a browser ask another host.
TEST_F(ViewCommand, ARealReportLoadsNothing) {
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
