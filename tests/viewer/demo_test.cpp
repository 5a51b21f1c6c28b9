// The demo of the browser build (apps/browser): a live run without a thread, advanced by its caller
// turn by turn
#include "apps/browser/demo.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/viewer/protocol_messages.h"
#include "taut/run.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;
using browser::Demo;
using Json = nlohmann::json;

const std::string kDrop = TAUT_SOURCE_DIR "/share/experiments/drop_six_strut.yaml";
const std::string kPush = TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml";
const std::string kModel = TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml";

Json Opened(Demo& demo, const std::string& path, std::vector<double> mark_at_s,
            bool paused = true) {
  return Json::parse(demo.Open(path, std::move(mark_at_s), paused));
}

Json State(const Demo& demo) { return Json::parse(demo.State()); }

void Say(Demo& demo, const Json& message) { EXPECT_EQ(demo.Post(message.dump()), ""); }

/// Runs at full speed until `marks` marks are reached, then pauses.
void GoOn(Demo& demo, std::size_t marks) {
  Say(demo, {{"type", "speed"}, {"factor", 0}});
  Say(demo, {{"type", "resume"}});
  while (State(demo)["marks"].size() < marks) demo.Turn();
  Say(demo, {{"type", "pause"}});
  demo.Turn();
}

/// Returns the mark of the same run by the command.
Json MarkOfRun(const std::string& path, double duration_s, const Overrides& overrides = {}) {
  Diagnostics out;
  auto experiment = LoadExperiment(path, overrides, out);
  experiment->duration_s = duration_s;
  const auto summary = RunExperiment(*experiment, {}, out);
  return {{"time_s", summary->simulated_s}, {"hash", fmt::format("{:016x}", summary->state_hash)}};
}

TEST(Demo, MarksTheStateThatARunOfTheCommandHas) {
  Demo demo;
  EXPECT_EQ(demo.State(), "null");
  const Json opened = Opened(demo, kDrop, {0.5, 1.2});
  EXPECT_TRUE(opened["good"]);
  EXPECT_EQ(opened["kind"], "experiment");
  ASSERT_EQ(opened["files"].size(), 2u);
  EXPECT_EQ(opened["files"][0], kDrop);
  EXPECT_EQ(opened["found"], Json::array());
  EXPECT_EQ(State(demo)["marks"], Json::array());
  EXPECT_EQ(State(demo)["path"], kDrop);
  GoOn(demo, 2);
  EXPECT_EQ(State(demo)["marks"], Json({MarkOfRun(kDrop, 0.5), MarkOfRun(kDrop, 1.2)}));
  EXPECT_EQ(State(demo)["touched"], false);
  // the present, some steps later
  const double now_s = State(demo)["time_s"];
  EXPECT_EQ(State(demo)["hash"], MarkOfRun(kDrop, now_s)["hash"]);
}

TEST(Demo, ARunThatBeginsAnewIsMarkedAnew) {
  Demo demo;
  Opened(demo, kPush, {0.2});
  GoOn(demo, 1);
  EXPECT_EQ(State(demo)["set"], Json::object());
  Say(demo, {{"type", "set_parameter"}, {"name", "push_n"}, {"value", 31.5}});
  while (State(demo)["time_s"] != 0.0) demo.Turn();
  EXPECT_EQ(State(demo)["marks"], Json::array());
  EXPECT_EQ(State(demo)["set"], Json({{"push_n", "31.5"}}));
  EXPECT_EQ(State(demo)["touched"], false) << "the command can do so, too";
  GoOn(demo, 1);
  EXPECT_EQ(State(demo)["marks"][0], MarkOfRun(kPush, 0.2, {{"push_n", "31.5"}}));
}

TEST(Demo, WhoeverTouchesItIsNoLongerComparedUntilAReset) {
  Demo demo;
  Opened(demo, kPush, {0.2});
  demo.Turn();
  Json scene;
  for (const Json& message : Json::parse(demo.TakeMessages())) {
    if (message["type"] == "scene") scene = message["scene"];
  }
  const Json node = scene["nodes"][0]["name"];
  const Json cable = scene["controls"][0]["cable"];
  const Json mark = MarkOfRun(kPush, 0.2);
  for (const Json& touch : std::vector<Json>{
           {{"type", "drag"}, {"node", node}, {"target_m", {0, 0, 2}}},
           {{"type", "push"}, {"node", node}, {"force_n", {0, 0, 5}}, {"duration_s", 0.1}},
           {{"type", "set_parameter"}, {"name", "friction_scale"}, {"value", 0.5}},
           {{"type", "set_setpoint"}, {"cable", cable}, {"value", 30}}}) {
    Opened(demo, kPush, {0.2});  // paused at its start
    Say(demo, touch);
    demo.Turn();
    EXPECT_EQ(State(demo)["touched"], true) << touch;
    GoOn(demo, 1);
    if (touch["type"] != "set_parameter") {  // a changed friction has no effect at rest
      EXPECT_NE(State(demo)["marks"][0], mark) << touch;
    }
    Say(demo, {{"type", "reset"}});
    while (State(demo)["time_s"] != 0.0) demo.Turn();
    EXPECT_EQ(State(demo)["touched"], false) << touch;
    GoOn(demo, 1);
    EXPECT_EQ(State(demo)["marks"][0], mark) << touch;
  }
  Say(demo, {{"type", "drag"}, {"node", "nobody"}, {"target_m", {0, 0, 2}}});
  Say(demo, {{"type", "set_setpoint"}, {"cable", "none"}, {"value", 3}});
  demo.Turn();
  EXPECT_EQ(State(demo)["touched"], false) << "what is refused touches nothing";
}

TEST(Demo, GreetsWithHelloAndTheSceneAndSendsEachFrameOnce) {
  Demo demo;
  EXPECT_EQ(demo.TakeMessages(), "[]");
  EXPECT_EQ(demo.TakeFrame(), nullptr);
  for (const std::string& path : {kPush, kDrop}) {  // once for each opened experiment
    Opened(demo, path, {});
    demo.Turn();
    const Json messages = Json::parse(demo.TakeMessages());
    ASSERT_GE(messages.size(), 2u);
    EXPECT_EQ(messages[0]["type"], "hello");
    EXPECT_EQ(messages[0]["version"], viewer::kProtocolVersion);
    EXPECT_EQ(messages[0]["mode"], "live");
    EXPECT_EQ(messages[0]["client"], 1);
    EXPECT_EQ(messages[0]["driver"], 1);
    EXPECT_FALSE(messages[0].contains("watch_only"));
    EXPECT_EQ(messages[1]["type"], "scene");
    EXPECT_EQ(demo.TakeMessages(), "[]");
    ASSERT_NE(demo.TakeFrame(), nullptr);
    EXPECT_EQ(demo.TakeFrame(), nullptr);
  }
}

TEST(Demo, AModelByItselfWaitsToBePulled) {
  Demo demo;
  EXPECT_EQ(Opened(demo, kModel, {}, false)["kind"], "model");
  demo.Turn();
  EXPECT_EQ(Json::parse(demo.TakeMessages())[0]["mode"], "model");
  EXPECT_EQ(State(demo)["time_s"], 0.0);
}

TEST(Demo, AnExperimentRunsUnlessItIsToBeginPaused) {
  for (const bool paused : {true, false}) {
    Demo demo;
    Opened(demo, kDrop, {}, paused);
    for (int i = 0; i < 20; ++i) {
      usleep(2000);
      EXPECT_GE(demo.Turn(), 0.0);
    }
    EXPECT_EQ(State(demo)["time_s"] == 0.0, paused);
  }
}

TEST(Demo, AMistakeIsSaidWithItsPlaceAndLeavesWhatRuns) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("taut_demo_{}", getpid());
  fs::create_directories(folder);
  const std::string path = (folder / "it.yaml").string();
  std::ofstream(path) << "taut: 1\nkind: experiment\nname: it\nmodel: " << kModel
                      << "\nduration_s: long\nseeed: 3\n";
  Demo demo;
  Opened(demo, kDrop, {});
  const Json before = State(demo);
  for (const Json& answer : {Json::parse(Demo::Check(path)), Opened(demo, path, {})}) {
    EXPECT_FALSE(answer["good"]);
    ASSERT_EQ(answer["found"].size(), 2u) << answer;
    EXPECT_EQ(answer["found"][0]["file"], path);
    EXPECT_EQ(answer["found"][0]["line"], 5);
    EXPECT_EQ(answer["found"][0]["column"], 13);
    EXPECT_EQ(answer["found"][0]["error"], true);
    EXPECT_EQ(answer["found"][1]["line"], 6);
    EXPECT_NE(answer["found"][1]["hint"].get<std::string>().find("seed"), std::string::npos);
  }
  EXPECT_EQ(State(demo), before);
  for (const char* missing : {"", "/nothing.yaml", "/"}) {
    EXPECT_FALSE(Json::parse(Demo::Check(missing))["good"]) << missing;
  }
  fs::remove_all(folder);
}

TEST(Demo, WhatIsNoMessageIsRefused) {
  Demo demo;
  EXPECT_EQ(demo.Post(R"({"type": "pause"})"), "there is no running simulation");
  EXPECT_EQ(demo.Turn(), 1000.0);
  Opened(demo, kDrop, {});
  for (const char* text : {"", "x", "{}", R"({"type": "drag"})", R"({"type": "seek"})"}) {
    EXPECT_NE(demo.Post(text), "") << text;
  }
  EXPECT_EQ(demo.Post(R"({"type": "take_control"})"), "") << "it is the page's anyway";
}

}  // namespace
}  // namespace taut::test
