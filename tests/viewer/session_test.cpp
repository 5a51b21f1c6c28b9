// A session under many commands: it can be stopped between any two, shows frames in between, and
// merges restarts. No test depends on the speed of the machine.
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <map>

#include "tests/viewer/serving.h"

namespace taut::test {
namespace {

using viewer::Command;
using viewer::FrameHeader;

void Post(viewer::Session& session, const std::string& type, const std::string& name = "",
          double value = 0, int client = 1) {
  Command command;
  command.type = type;
  command.name = name;
  command.value = value;
  ASSERT_TRUE(session.Post(client, command));
}

/// Session that only counts commands, and calls a function of the test for each
class Counting final : public viewer::Session {
 public:
  explicit Counting(std::function<void(const Counting&)> handle)
      : Session("live", "counting"), handle_(std::move(handle)) {}
  ~Counting() override { Stop(); }

  std::atomic<int> handled{0}, shown{0};
  bool told_to_stop() const { return stopping(); }

 private:
  void Handle(int, const Command&) override {
    ++handled;
    handle_(*this);
  }
  Clock::time_point Work() override {
    ++shown;
    return Clock::now() + std::chrono::hours(1);
  }
  std::function<void(const Counting&)> handle_;
};

TEST(ViewSession, StopsBetweenCommandsHoweverManyWait) {
  Counting session([](const Counting& self) {
    while (self.handled == 3 && !self.told_to_stop()) std::this_thread::yield();
  });
  for (int i = 0; i < 1000; ++i) Post(session, "step");
  session.Start([] {});
  while (session.handled < 3) std::this_thread::yield();
  session.Stop();
  EXPECT_EQ(session.handled, 3);
}

TEST(ViewSession, ShowsPicturesWhileManyCommandsWait) {
  std::atomic<int> shown_before_the_last{0};
  Counting session([&](const Counting& self) {
    shown_before_the_last = self.shown.load();
    std::this_thread::sleep_for(std::chrono::milliseconds(11));  // longer than a time slice
  });
  for (int i = 0; i < 5; ++i) Post(session, "step");
  session.Start([] {});
  while (session.handled < 5) std::this_thread::yield();
  session.Stop();
  EXPECT_EQ(shown_before_the_last, 4);
}

double ValueOf(const Json& scene, const std::string& name) {
  for (const Json& parameter : scene["parameters"]) {
    if (parameter["name"] == name) return parameter["value"];
  }
  return std::nan("");
}

/// Scene and frame of a client once the run has this number and time. The commands were posted
/// before the server started.
struct Outcome {
  Json scene;
  ReceivedFrame frame;
};
Outcome After(std::unique_ptr<viewer::Session> session, double run, double time_s = 0) {
  const Serving serving(std::move(session));
  Client client(serving.port());
  Outcome outcome;
  outcome.frame = client.AwaitFrame([=](const auto& f) {
    return f[FrameHeader::kFrameRun] >= run && f[FrameHeader::kFrameTimeS] >= time_s;
  });
  // A new client gets the present scene.
  outcome.scene = Client(serving.port()).Await("scene")["scene"];
  return outcome;
}

TEST(ViewSession, TwentyThousandChangesAreOneRestart) {
  auto session = PausedLive(kPush);
  for (int i = 1; i <= 20000; ++i) Post(*session, "set_parameter", "push_n", 0.004 * i);
  const Outcome outcome = After(std::move(session), 2);
  EXPECT_EQ(outcome.frame[FrameHeader::kFrameRun], 2);
  EXPECT_EQ(ValueOf(outcome.scene, "push_n"), 80);
}

TEST(ViewSession, ResetsAndChangesInARowAreOneRestart) {
  auto session = PausedLive(kHang);
  for (int i = 0; i < 1000; ++i) {
    Post(*session, "reset");
    Post(*session, "set_parameter", "mass_kg", 0.7);
    Post(*session, "set_parameter", "rest_length_m", 1.5);
  }
  const Outcome outcome = After(std::move(session), 2);
  EXPECT_EQ(outcome.frame[FrameHeader::kFrameRun], 2);
  EXPECT_EQ(ValueOf(outcome.scene, "mass_kg"), 0.7);
  EXPECT_EQ(ValueOf(outcome.scene, "rest_length_m"), 1.5);
}

/// Commands between restarts refer to the run after the preceding changes.
TEST(ViewSession, OtherCommandsKeepTheirPlaceAmongRestarts) {
  auto session = PausedLive(kHang);
  Post(*session, "set_parameter", "mass_kg", 0.7);
  Post(*session, "set_parameter", "friction_scale", 0.5);
  Post(*session, "step");
  Post(*session, "reset");
  Post(*session, "set_parameter", "mass_kg", 0.8);
  Post(*session, "set_parameter", "friction_scale", 0.25);
  Post(*session, "step");
  Post(*session, "step");
  const Outcome outcome = After(std::move(session), 3, 0.002);
  EXPECT_EQ(outcome.frame[FrameHeader::kFrameRun], 3);
  EXPECT_EQ(outcome.frame[FrameHeader::kFrameTimeS], 0.002);
  EXPECT_EQ(ValueOf(outcome.scene, "mass_kg"), 0.8);
  EXPECT_EQ(ValueOf(outcome.scene, "friction_scale"), 0.25);
}

TEST(ViewSession, OfManyChangesThoseThatCannotBeAreAnsweredAndTheRestAreMade) {
  const auto session = PausedLive(kHang);
  Post(*session, "set_parameter", "luck", 1, 1);
  Post(*session, "set_parameter", "mass_kg", 0.75, 2);
  Post(*session, "set_parameter", "mass_kg", 0, 3);   // the model does not allow it
  Post(*session, "set_parameter", "mass_kg", 99, 4);  // beyond the slider's range
  Post(*session, "set_parameter", "rest_length_m", 1.25, 5);
  session->Start([] {});
  std::map<int, std::string> errors;
  Json scene;
  while (scene.is_null()) {
    for (const viewer::Outgoing& message : session->TakeMessages()) {
      const Json json = Json::parse(message.text);
      if (json["type"] == "scene") scene = json["scene"];
      if (json["type"] == "error") errors[message.client] = json["text"];
    }
    std::this_thread::yield();
  }
  session->Stop();
  EXPECT_EQ(ValueOf(scene, "mass_kg"), 0.75);
  EXPECT_EQ(ValueOf(scene, "rest_length_m"), 1.25);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_EQ(errors[1], "there is no parameter \"luck\"");
  EXPECT_NE(errors[3].find("mass_kg"), std::string::npos) << errors[3];
  EXPECT_EQ(errors[4], "mass_kg must be within 0 to 2");
}

TEST(ViewSession, WhatAParameterMayBeFollowsFromTheFilesAndNotFromWhatItIs) {
  auto session = PausedLive(kPush);
  Post(*session, "set_parameter", "push_n", 0);
  Post(*session, "step");
  Post(*session, "set_parameter", "push_n", 80);
  EXPECT_EQ(ValueOf(After(std::move(session), 3).scene, "push_n"), 80);
}

}  // namespace
}  // namespace taut::test
