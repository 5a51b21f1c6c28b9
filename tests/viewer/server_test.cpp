// The viewer's server through real sockets: access, control, rejected requests
#include <random>

#include "tests/viewer/serving.h"

namespace taut::test {
namespace {

using viewer::FrameHeader;

TEST(ViewServer, ServesItsFilesAndNothingElse) {
  const Serving serving(PausedLive(kHang));
  const HttpAnswer page = Get(serving.port(), "/");
  EXPECT_EQ(page.status, 200u);
  EXPECT_EQ(page.body, "<p>the page");
  EXPECT_NE(page.fields.at("Content-Security-Policy").find("default-src 'self'"),
            std::string::npos);
  EXPECT_EQ(Get(serving.port(), "/index.html").body, "<p>the page");
  EXPECT_EQ(Get(serving.port(), "/?a=b").status, 200u);
  EXPECT_EQ(Get(serving.port(), "/assets/a.js").fields.at("Content-Type"),
            "text/javascript; charset=utf-8");
  for (const char* path :
       {"/nothing", "/../CMakeLists.txt", "/assets/../../etc/passwd", "//etc/passwd",
        "/assets/%2e%2e/index.html", "/assets", "/assets/", "/ws", "/index.html/", "*"}) {
    EXPECT_EQ(Get(serving.port(), path).status, 404u) << path;
  }
  EXPECT_EQ(Get(serving.port(), "/", {}, "DELETE").status, 405u);
  EXPECT_EQ(Get(serving.port(), "/", {}, "HEAD").status, 200u);
}

TEST(ViewServer, PagesOfOtherSitesStayOutside) {
  const Serving serving(PausedLive(kHang));
  EXPECT_EQ(Get(serving.port(), "/", {{"Host", "elsewhere.example"}}).status, 403u);
  EXPECT_EQ(Get(serving.port(), "/", {{"Origin", "http://elsewhere.example"}}).status, 403u);
  const Client foreign(serving.port(), kToDrive, "http://elsewhere.example");
  EXPECT_FALSE(foreign.open());
  const Client own(serving.port(), kToDrive, "http://localhost:" + std::to_string(serving.port()));
  EXPECT_TRUE(own.open());
}

TEST(ViewServer, OnlyThoseWhoHaveATokenComeIn) {
  EXPECT_EQ(viewer::RandomToken().size(), 32u);
  EXPECT_NE(viewer::RandomToken(), viewer::RandomToken());
  const Serving serving(PausedLive(kHang));
  const std::string cookie = "taut_token_" + std::to_string(serving.port()) + "=";
  const auto without_cookie = [&](const std::string& target) {
    return Get(serving.port(), target, {{"Cookie", ""}});
  };
  std::string wrong = kDriveToken;
  wrong.back() = 'x';
  for (const std::string& target :
       {std::string("/"), "/?token=" + wrong, std::string("/?token="), "/?nottoken=" + kDriveToken,
        "/?token=" + kDriveToken + "0", "/?token=" + kDriveToken.substr(1)}) {
    EXPECT_EQ(without_cookie(target).status, 403u) << target;
  }
  EXPECT_FALSE(Client(serving.port(), "/ws").open());
  EXPECT_FALSE(Client(serving.port(), "/ws?token=" + wrong).open());
  EXPECT_FALSE(Client(serving.port(), "/ws?token=").open());
  // Another server on this machine uses other cookies.
  EXPECT_EQ(Get(serving.port(), "/", {{"Cookie", "taut_token_1=" + kDriveToken}}).status, 403u);
  for (const std::string& token : {kDriveToken, kWatchToken}) {
    const HttpAnswer page = without_cookie("/?token=" + token);
    ASSERT_EQ(page.status, 200u);
    EXPECT_EQ(page.fields.at("Set-Cookie"), cookie + token + "; HttpOnly; SameSite=Strict; Path=/");
    const std::string pair = "other=1; " + cookie + token;
    EXPECT_EQ(Get(serving.port(), "/assets/a.js", {{"Cookie", pair}}).status, 200u);
    EXPECT_TRUE(Client(serving.port(), "/ws?token=" + token).open());
  }
}

TEST(ViewServer, ALinkToWatchMayNotDrive) {
  const Serving serving(PausedLive(kHang));
  Client watcher(serving.port(), kToWatch), driver(serving.port());
  EXPECT_EQ(watcher.Await("hello")["watch_only"], true);
  EXPECT_FALSE(driver.Await("hello").contains("watch_only"));
  for (const char* type : {"step", "take_control", "reset", "pause"}) {
    watcher.Send({{"type", type}});
    EXPECT_EQ(watcher.Await("error")["text"],
              "this address is for watching only; taut printed another address to drive");
  }
  driver.Send({{"type", "step"}});  // no driver before
  EXPECT_EQ(watcher.AwaitFrame([](const auto& f) {
    return f[FrameHeader::kFrameTimeS] > 0;
  })[FrameHeader::kFrameTimeS],
            0.001);
  watcher.Send({{"type", "want_series"},
                {"id", 1},
                {"channel", "body/hanging_mass/position_y_m"},
                {"t0", 0},
                {"t1", 1},
                {"points", 9}});
  EXPECT_EQ(watcher.Await("series")["id"], 1);
}

TEST(ViewServer, KnowsWhatAnAddressIsAndWhoReachesIt) {
  EXPECT_TRUE(viewer::IsLoopback("127.0.0.1"));
  EXPECT_TRUE(viewer::IsLoopback("::1"));
  EXPECT_FALSE(viewer::IsLoopback("0.0.0.0"));
  EXPECT_FALSE(viewer::IsLoopback("192.168.1.2"));
  EXPECT_FALSE(viewer::IsLoopback("nonsense"));
  EXPECT_TRUE(viewer::IsAddress("::"));
  EXPECT_FALSE(viewer::IsAddress("here"));
}

TEST(ViewServer, RequestsThatDoNotEndAreDroppedForNewOnesTheOldestFirst) {
  viewer::ServerOptions options;
  options.max_http = 8;
  options.request_patience = std::chrono::hours(1);
  const Serving serving(PausedLive(kHang), options);
  std::vector<std::unique_ptr<HalfOpen>> slow;
  for (int i = 0; i < 8; ++i) slow.push_back(std::make_unique<HalfOpen>(serving.port()));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Get(serving.port(), "/").status, 200u) << i;
  EXPECT_TRUE(Client(serving.port()).open());
  EXPECT_EQ(slow.front()->End(), 0u);
  EXPECT_EQ(slow.back()->End(), 200u) << "who begins late has its time";
}

TEST(ViewServer, ARequestThatDoesNotEndIsDroppedAtItsDeadline) {
  viewer::ServerOptions options;
  options.request_patience = std::chrono::milliseconds(20);
  const Serving serving(PausedLive(kHang), options);
  HalfOpen(serving.port()).AwaitClose();
}

TEST(ViewServer, AUsedPortIsNamedAndTheNextOffered) {
  const Serving first(PausedLive(kHang));
  const auto session = PausedLive(kHang);
  viewer::ServerOptions options;
  options.port = first.port();
  viewer::Server second(*session, {}, options);
  std::string error;
  ASSERT_FALSE(second.Listen(error));
  const std::string in_use = "port " + std::to_string(first.port()) + " is in use";
  EXPECT_EQ(error.find(in_use), 0u) << error;
  // The suggested port is free.
  const std::size_t at = error.find("--port ");
  ASSERT_NE(at, error.npos) << error;
  options.port = static_cast<std::uint16_t>(std::stoi(error.substr(at + 7)));
  viewer::Server third(*session, {}, options);
  EXPECT_TRUE(third.Listen(error)) << error;
  options.address = "not an address";
  viewer::Server fourth(*session, {}, options);
  EXPECT_FALSE(fourth.Listen(error));
  EXPECT_EQ(error, "\"not an address\" is not an address");
}

TEST(ViewServer, GreetsWithVersionSceneAndFrame) {
  const Serving serving(PausedLive(kPush));
  Client client(serving.port());
  const Json hello = client.Await("hello");
  EXPECT_EQ(hello["version"], viewer::kProtocolVersion);
  EXPECT_EQ(hello["mode"], "live");
  EXPECT_EQ(hello["title"], "push_20n");
  EXPECT_EQ(hello["driver"], 0);
  const Json scene = client.Await("scene")["scene"];
  EXPECT_EQ(scene["bodies"].size(), 3u);
  EXPECT_EQ(scene["cables"].size(), 12u);
  EXPECT_EQ(scene["controls"].size(), 12u);
  EXPECT_EQ(scene["phases"][1]["name"], "during");
  const ReceivedFrame frame = client.AwaitFrame();
  EXPECT_EQ(frame.Count(FrameHeader::kFrameBodyCount), 3u);
  EXPECT_EQ(frame.Count(FrameHeader::kFrameCableCount), 12u);
  EXPECT_EQ(frame.end(), frame.numbers.size());
  EXPECT_EQ(frame[FrameHeader::kFramePaused], 1);
  // bodies have the scene's poses before the first step
  for (std::size_t b = 0; b < 3; ++b) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(frame.numbers[frame.bodies() + 7 * b + i],
                scene["bodies"][b]["position_m"][i].get<double>());
    }
  }
}

TEST(ViewServer, OneDrivesAtATimeAndEveryoneKnowsWho) {
  const Serving serving(PausedLive(kHang));
  Client first(serving.port()), second(serving.port());
  const int id_1 = first.Await("hello")["client"], id_2 = second.Await("hello")["client"];
  EXPECT_NE(id_1, id_2);
  first.Send({{"type", "step"}});
  EXPECT_EQ(first.Await("driver")["id"], id_1);
  EXPECT_EQ(second.Await("driver")["id"], id_1);
  const ReceivedFrame stepped =
      second.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameTimeS] > 0; });
  EXPECT_EQ(stepped[FrameHeader::kFrameDriver], id_1);

  second.Send({{"type", "reset"}});
  EXPECT_EQ(second.Await("error")["text"],
            "viewer " + std::to_string(id_1) + " drives; take control first");
  second.Send({{"type", "take_control"}});
  EXPECT_EQ(second.Await("driver")["id"], id_2);
  EXPECT_EQ(first.Await("driver")["id"], id_2);
  second.Send({{"type", "reset"}});
  EXPECT_EQ(second.AwaitFrame([](const auto& f) {
    return f[FrameHeader::kFrameRun] == 2;
  })[FrameHeader::kFrameTimeS],
            0);
  second.Close();
  EXPECT_EQ(first.Await("driver")["id"], 0);
}

TEST(ViewServer, MessagesThatAreNoneCloseTheirConnectionOnly) {
  const Serving serving(PausedLive(kHang));
  Client good(serving.port());
  good.Await("hello");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "a message must be a JSON object with a string \"type\""},
      {"nonsense", "a message must be a JSON object with a string \"type\""},
      {"[]", "a message must be a JSON object with a string \"type\""},
      {R"({"type": 3})", "a message must be a JSON object with a string \"type\""},
      {R"({"type": "fly"})", "there is no message \"fly\""},
      {R"({"type": "seek"})", "seek needs \"time_s\""},
      {R"({"type": "seek", "time_s": "1"})", "seek: \"time_s\" has the wrong type"},
      {R"({"type": "seek", "time_s": 1e999})",
       "a message must be a JSON object with a string \"type\""},
      {R"({"type": "pause", "now": true})", "pause has an unknown field"},
      {R"({"type": "drag", "node": "mass", "target_m": [1, 2]})",
       "drag: \"target_m\" has the wrong type"},
      {R"({"type": "set_gain", "cable": "c", "gain": "g", "value": 1})",
       "set_gain: \"gain\" has the wrong type"},
      {R"({"type": "speed", "factor": -1})", "speed: factor must be within 0.001 to 1000, got -1"},
      {R"({"type": "step", "count": 2000})", "step: count must be within -1000 to 1000, got 2000"},
      {R"({"type": "want_series", "id": 1, "channel": "a", "t0": 0, "t1": 1, "points": 1})",
       "want_series: points must be within 2 to 10000, got 1"},
  };
  for (const auto& [text, why] : cases) {
    Client bad(serving.port());
    bad.SendText(text);
    const auto reason = bad.AwaitClose();
    EXPECT_EQ(reason.code, kPolicyViolation) << text;
    EXPECT_EQ(reason.reason, why.substr(0, 120)) << text;
  }
  Client binary(serving.port());
  binary.SendBinary("{\"type\": \"pause\"}");
  EXPECT_EQ(binary.AwaitClose().reason, "messages must be text frames");
  Client large(serving.port());
  large.SendText(R"({"type": "pause", "x": ")" + std::string(65 * 1024, 'x') + "\"}");
  EXPECT_EQ(large.AwaitClose().code, kMessageTooBig);
  Client deep(serving.port());
  deep.SendText(std::string(60000, '['));
  EXPECT_EQ(deep.AwaitClose().code, kPolicyViolation);

  good.Send({{"type", "step"}});  // other clients are not affected
  EXPECT_GT(
      good.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameTimeS] > 0; }).numbers.size(),
      0u);
}

TEST(ViewServer, UnknownNamesAreAnsweredNotObeyed) {
  const Serving serving(PausedLive(kHang));
  Client client(serving.port());
  const std::vector<std::pair<Json, std::string>> cases = {
      {{{"type", "drag"}, {"node", "nobody"}, {"target_m", {0, 0, 0}}},
       "there is no node \"nobody\""},
      {{{"type", "set_parameter"}, {"name", "luck"}, {"value", 1}},
       "there is no parameter \"luck\""},
      {{{"type", "set_parameter"}, {"name", "friction_scale"}, {"value", -1}},
       "friction_scale must be within 0 to 4"},
      {{{"type", "set_setpoint"}, {"cable", "cable"}, {"value", 1}},
       "there is no actuated cable \"cable\""},
      {{{"type", "want_series"},
        {"id", 1},
        {"channel", "luck"},
        {"t0", 0},
        {"t1", 1},
        {"points", 9}},
       "there is no channel \"luck\""},
  };
  for (const auto& [message, why] : cases) {
    client.Send(message);
    EXPECT_EQ(client.Await("error")["text"], why);
  }
}

/// Seeded: the same messages in every run.
TEST(ViewServer, RandomMessagesHarmNothing) {
  const Serving serving(PausedLive(kHang));
  std::mt19937 random(4);
  const auto pick = [&](std::size_t count) { return random() % count; };
  const std::vector<std::string> seeds = {
      R"({"type": "drag", "node": "mass", "target_m": [0.1, 0, 1]})",
      R"({"type": "push", "node": "mass", "force_n": [1, 2, 3], "duration_s": 0.1})",
      R"({"type": "set_parameter", "name": "gravity_z_m_per_s2", "value": -3})",
      R"({"type": "step", "count": 3})",
      R"({"type": "speed", "factor": 0})",
      R"({"type": "want_series", "id": 1, "channel": "a", "t0": 0, "t1": 1, "points": 100})",
      R"({"type": "reset"})"};
  for (int i = 0; i < 400; ++i) {
    Client client(serving.port());
    ASSERT_TRUE(client.open()) << i;
    for (int k = 0; k < 5 && !client.failed(); ++k) {
      std::string text = seeds[pick(seeds.size())];
      for (std::size_t damage = pick(4); damage > 0; --damage) {
        const std::size_t at = pick(text.size());
        switch (pick(3)) {
          case 0:
            text[at] = static_cast<char>(random());
            break;
          case 1:
            text.erase(at, 1 + pick(8));
            break;
          default:
            text.insert(at, text.substr(pick(text.size()), 6));
        }
        if (text.empty()) text = " ";
      }
      pick(10) == 0 ? client.SendRaw(text) : client.SendText(text);
    }
  }
  // Messages that were valid commands have been executed; the server still responds to commands.
  Client client(serving.port());
  client.Send({{"type", "take_control"}});
  client.Send({{"type", "pause"}});
  client.Send({{"type", "reset"}});
  const ReceivedFrame frame = client.AwaitFrame([](const auto& f) {
    return f[FrameHeader::kFrameTimeS] == 0 && f[FrameHeader::kFramePaused] == 1;
  });
  EXPECT_FALSE(frame.numbers.empty());
}

TEST(ViewServer, AClientComesBackAfterARestart) {
  auto serving = std::make_unique<Serving>(PausedLive(kHang));
  viewer::ServerOptions options;
  options.port = serving->port();
  Client before(serving->port());
  before.Await("hello");
  serving.reset();
  before.AwaitClose();
  EXPECT_FALSE(before.open());
  serving = std::make_unique<Serving>(PausedLive(kHang), options);
  ASSERT_EQ(serving->port(), options.port);
  Client after(serving->port());
  EXPECT_EQ(after.Await("hello")["title"], "hang");
}

/// Frames that exceed the sockets' buffers, in sequence, numbered by their time
class Flood final : public viewer::Session {
 public:
  Flood() : Session("live", "flood") {}
  ~Flood() override { Stop(); }

 private:
  void Handle(int, const viewer::Command&) override {}
  Clock::time_point Work() override {
    viewer::Frame frame;
    frame.time_s = ++count_;
    frame.bodies.resize(300000);
    Publish(std::move(frame));
    return Clock::now() + std::chrono::milliseconds(1);
  }
  int count_ = 0;
};

TEST(ViewServer, ASlowClientIsOneFrameBehindAndHoldsNobodyUp) {
  const Serving serving(std::make_unique<Flood>());
  Client slow(serving.port()), quick(serving.port());
  slow.Await("hello");
  // `slow` reads nothing while `quick` receives many frames.
  double seen = 0;
  for (int i = 0; i < 6; ++i) seen = quick.AwaitFrame()[FrameHeader::kFrameTimeS];
  EXPECT_GE(seen, 6);
  // The frame that was being sent, and then the newest.
  EXPECT_LT(slow.AwaitFrame()[FrameHeader::kFrameTimeS], seen);
  EXPECT_GE(slow.AwaitFrame()[FrameHeader::kFrameTimeS], seen);
}

}  // namespace
}  // namespace taut::test
