// The command `taut view`
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <sstream>

#include "taut/trace.h"
#include "tests/system/view_command.h"

namespace taut::test {
namespace {

TEST_F(ViewCommand, ServesALiveRunUntilCtrlC) {
  const pid_t pid = StartView({kHang});
  EXPECT_EQ(host_, "localhost");
  EXPECT_EQ(query_, "?token=" + kDriveToken);
  EXPECT_EQ(watch_, fmt::format("http://localhost:{}/?token={}", port_, kWatchToken));
  EXPECT_EQ(Get(port_, "/").body, "<p>the page");
  EXPECT_EQ(Get(port_, "/report.html").status, 404u);  // a template is not served
  {
    Client client(port_);
    EXPECT_EQ(client.Await("hello")["mode"], "live");
    client.AwaitFrame([](const auto& f) { return f[viewer::kFrameTimeS] > 0.1; });
  }
  EXPECT_EQ(Stop(pid), 0);
  EXPECT_EQ(Read(Path("err.txt")), "");
}

/// Executing the queued commands would take minutes.
TEST_F(ViewCommand, SignalsEndItWhateverWaits) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t pid = StartView({kPush, "--paused"});
    Client client(port_);
    client.Await("scene");
    for (int i = 0; i < 20000; ++i) {
      if (i % 2 == 0) {
        client.Send({{"type", "step"}, {"count", 1000}});
      } else {
        client.Send({{"type", "set_parameter"}, {"name", "push_n"}, {"value", i % 80}});
      }
    }
    EXPECT_EQ(Stop(pid, signal), 0) << signal;
  }
}

TEST_F(ViewCommand, AHangupIsNothingToWhatNohupStarted) {
  const pid_t pid = StartView({kHang, "--paused"}, [] { std::signal(SIGHUP, SIG_IGN); });
  kill(pid, SIGHUP);
  EXPECT_EQ(Get(port_, "/").status, 200u);
  EXPECT_EQ(Stop(pid), 0);
}

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

TEST_F(ViewCommand, TheTokensOfTheAddressesAreRandomUnlessNamed) {
  std::vector<std::string> seen;
  for (int i = 0; i < 2; ++i) {
    const pid_t pid = StartView({kHang, "--paused"}, [] {
      unsetenv("TAUT_TOKEN");
      setenv("TAUT_WATCH_TOKEN", "", 1);
    });
    const std::string watch = watch_.substr(watch_.find('?'));
    for (const std::string& query : {query_, watch}) {
      EXPECT_TRUE(std::regex_match(query, std::regex("\\?token=[0-9a-f]{32}"))) << query;
      EXPECT_EQ(Get(port_, "/" + query, {{"Cookie", ""}}).status, 200u);
      seen.push_back(query);
    }
    EXPECT_EQ(Get(port_, "/", {{"Cookie", ""}}).status, 403u);
    EXPECT_FALSE(Client(port_, "/ws").open());
    EXPECT_TRUE(Client(port_, "/ws" + watch).Await("hello").contains("watch_only"));
    EXPECT_EQ(Stop(pid), 0);
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end());
  for (const auto& [token, why] :
       {std::pair("short", "error: TAUT_TOKEN must be 16 to 128 letters, digits, - or _\n"),
        std::pair("semicolons;make;cookies",
                  "error: TAUT_TOKEN must be 16 to 128 letters, digits, - or _\n"),
        std::pair("the-same-for-both", "error: TAUT_TOKEN and TAUT_WATCH_TOKEN must differ\n")}) {
    const CommandResult result = Taut({"view", kHang}, [token = token] {
      setenv("TAUT_WEB", "web", 1);
      setenv("TAUT_TOKEN", token, 1);
      setenv("TAUT_WATCH_TOKEN", "the-same-for-both", 1);
    });
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.errors, why);
  }
}

TEST_F(ViewCommand, ListeningToOthersIsSaidToBeReadable) {
  const pid_t pid = StartView({kHang, "--listen", "0.0.0.0", "--paused"});
  EXPECT_EQ(Get(port_, "/", {{"Cookie", ""}}).status, 403u);
  EXPECT_EQ(Get(port_, "/" + query_, {{"Cookie", ""}}).status, 200u);
  EXPECT_EQ(Stop(pid), 0);
  const std::string said = Read(Path("err.txt"));
  EXPECT_EQ(
      said.rfind("warning: other machines can connect, and the connection is not encrypted: ", 0),
      0u);
  EXPECT_NE(said.find(fmt::format("ssh -L {0}:localhost:{0} MACHINE)\n", port_)), said.npos)
      << said;
}

TEST_F(ViewCommand, WhatMovesMotorsListensToThisMachineOnly) {
  for (const std::string address : {"0.0.0.0", "::", "192.0.2.1"}) {
    const CommandResult result = Run({"view", "--robot", "virtual", "--listen", address});
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.errors.find("--listen " + address + " cannot be combined with a robot"),
              result.errors.npos)
        << result.errors;
    EXPECT_NE(result.errors.find("ssh -L 8080:localhost:8080 MACHINE"), result.errors.npos);
  }
  EXPECT_EQ(Run({"view", kHang, "--robot", "virtual"}).status, 2);
  EXPECT_EQ(Run({"view", "--robot", "virtual", "--speed", "2"}).status, 2);
  EXPECT_EQ(Run({"view", kHang, "--model", "m.yaml"}).status, 2);
  EXPECT_EQ(Run({"view"}).status, 2);
  EXPECT_EQ(Run({"view", "--robot", "/absent", "--port", "0"}).status, 1);
}

/// A limit of the file size acts like a full disk: writes fail in the same way.
TEST_F(ViewCommand, AFullDiskIsSaidToAllAndAtTheTerminal) {
  const auto limit = [] {
    const rlimit bytes{400'000, 400'000};
    setrlimit(RLIMIT_FSIZE, &bytes);
  };
  for (const bool trace : {true, false}) {
    const pid_t pid = StartView({kHang, "--out", "recorded", "--max", "--paused"}, limit);
    Client client(port_);
    client.Await("hello");
    if (trace) {
      client.Send({{"type", "step"}, {"count", 1000}});
      for (std::size_t rows = 0; rows < 201;) {  // until they are in the file
        Diagnostics not_yet;
        const auto written = ReadTrace(Path("recorded/trace.h5"), not_yet);
        rows = written ? written->time_s.size() : 0;
      }
      client.Send({{"type", "resume"}});
      client.AwaitFrame([](const auto& f) {
        return f[viewer::kFrameTimeS] >= 5 && f[viewer::kFramePaused] == 1;
      });
      client.Send({{"type", "resume"}});  // beyond the experiment's end
    } else {
      for (int i = 0; i < 10000; ++i) {
        client.Send({{"type", "set_parameter"}, {"name", "friction_scale"}, {"value", 1}});
      }
    }
    const std::string notice = client.AwaitText([](const Json& message) {
      return message["type"] == "scene" && message["scene"].contains("notice");
    })["scene"]["notice"];
    const std::string file = trace ? "recorded/trace.h5" : "recorded/events.jsonl";
    EXPECT_EQ(notice.rfind("recording stopped at t = ", 0), 0u) << notice;
    EXPECT_NE(notice.find(" of part 1: " + file + ": cannot write: File too large"), notice.npos)
        << notice;
    Client late(port_);
    EXPECT_EQ(late.Await("scene")["scene"]["notice"], notice);
    EXPECT_EQ(Stop(pid), 1) << "what was to be recorded is not all there";
    EXPECT_EQ(Read(Path("err.txt")), notice + "\n");
    Diagnostics found;
    const auto kept = ReadTrace(Path("recorded/trace.h5"), found);
    ASSERT_TRUE(kept) << found.Format();
    EXPECT_GE(kept->time_s.size(), trace ? 201u : 1u);
    std::istringstream events(Read(Path("recorded/events.jsonl")));
    for (std::string line; std::getline(events, line);) EXPECT_FALSE(Json::parse(line).is_null());
    EXPECT_TRUE(trace || Read(Path("recorded/events.jsonl")).ends_with("}\n"));
  }
}

TEST_F(ViewCommand, APortInUseIsNamed) {
  const pid_t pid = StartView({kHang, "--paused"});
  const CommandResult second = Run({"view", kHang, "--port", std::to_string(port_)});
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(second.errors.rfind(
                "error: port " + std::to_string(port_) + " is in use; next free port: --port ", 0),
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

TEST_F(ViewCommand, AFolderOfARunShowsItsTrace) {
  ASSERT_EQ(Run({"run", kHang, "--duration_s", "0.1", "--out", "run", "--quiet"}).status, 0);
  const pid_t pid = StartView({"run", "--compare", "run"});
  Client client(port_);
  EXPECT_EQ(client.Await("hello")["mode"], "replay");
  EXPECT_EQ(client.Await("scene")["scene"]["compared"].size(), 1u);
  client.Close();
  EXPECT_EQ(Stop(pid), 0);
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
  EXPECT_TRUE(notice.ends_with("; the trace is unfinished: its run continues, or was killed"));
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
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.errors.find("\"here\" is not an address (expected 127.0.0.1 for this machine "
                               "only, or 0.0.0.0 for all)\n"),
            std::string::npos)
      << result.errors;
  EXPECT_EQ(Run({"view", kHang, "--speed", "0"}).status, 2);
  EXPECT_EQ(Run({"view", kHang, "--speed", "2", "--max"}).status, 2);
  EXPECT_EQ(Run({"view", kHang, "--speed", "nan"}).status, 2);
  EXPECT_EQ(Run({"view", kHang, "--step_s", "2"}).status, 2);
  EXPECT_EQ(Run({"view", "absent.yaml"}).status, 3);
  EXPECT_EQ(Run({"view", "."}).status, 3);
  EXPECT_EQ(Run({"view", kHang, "--set", "luck=1"}).status, 3);
  const std::string good = Write("good.csv", "time_s,a/tension_n\n0,1\n1,2\n");
  for (const auto& [words, why] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"absent.h5"}, "absent.h5: error: cannot open: No such file or directory"},
           {{Write("broken.h5", "not a trace")}, "broken.h5: error: the file is not HDF5"},
           {{Write("empty.csv", "time_s,a/tension_n\n")}, "has no rows"},
           {{good, "--compare", "absent.h5"}, "absent.h5: error: cannot open"}}) {
    std::vector<std::string> all{"view"};
    all.insert(all.end(), words.begin(), words.end());
    result = Run(all);
    EXPECT_EQ(result.status, 3) << why;
    EXPECT_EQ(result.output, "") << "no address: there is nothing to see";
    EXPECT_NE(result.errors.find(why), std::string::npos) << result.errors;
  }
  result = Run({"view", kHang, "--compare", "a.h5"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors, "error: --compare needs a trace\n");
  result = Run({"view", "a.h5", "--out", "folder"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors,
            "error: --set, --step_s, --settled and --out cannot be combined with a trace\n");
}

}  // namespace
}  // namespace taut::test
