// Pages of user programs (taut/page.h), from the client's side
#include "taut/page.h"

#include <atomic>

#include "apps/viewer/pace.h"
#include "tests/viewer/page_fixture.h"

namespace taut::test {
namespace {

using viewer::FrameHeader;
using viewer::Pace;

constexpr double kStepS = 0.001;

TEST_F(PageTest, ShowsTwoWorldsBesideEachOtherAsTheyAre) {
  const auto model = [] {
    Diagnostics found;
    return Model::Compile(Prism(), found);
  }();
  WorldBatchOptions two;
  two.worlds = 2;
  WorldBatch batch(model, two);
  batch.SetNodeForce(1, 2, {3, 0, 1});
  for (int i = 0; i < 100; ++i) batch.Step(kStepS);
  const auto page = Open();
  const int a = page->Add(model->def(), "a"), b = page->Add(model->def(), "b", {0, 2, 0});
  page->Set(a, batch, 0);
  page->Set(b, batch, 1);
  page->Plot("score/way_m", "m", 12.5);
  page->Show(batch.Time(0));

  Client browser = Browser(*page, page->url());
  EXPECT_EQ(browser.Await("hello")["mode"], "program");
  const ReceivedFrame frame =
      browser.AwaitFrame([&](const auto& f) { return HasTime(f, batch.Time(0)); });
  Client later = Browser(*page, page->watch_url());
  EXPECT_EQ(later.Await("hello")["watch_only"], true);
  const Json scene = later.Await("scene")["scene"];
  EXPECT_EQ(Names(scene["bodies"]),
            (std::vector<std::string>{"a/strut_0", "a/strut_1", "a/strut_2", "b/strut_0",
                                      "b/strut_1", "b/strut_2"}))
      << scene["bodies"];
  EXPECT_EQ(Names(scene["terrain"]), std::vector<std::string>{"a/ground"});
  EXPECT_EQ(scene["values"], Json({"score/way_m"}));

  ASSERT_EQ(frame.numbers.size(), frame.end());
  const std::size_t bodies = 3, cables = model->def().cables.size();
  for (int world : {0, 1}) {
    for (int i = 0; i < 3; ++i) {
      const double* at = &frame.numbers[frame.bodies() + (world * bodies + i) * 7];
      const BodyState body = batch.Body(world, i);
      EXPECT_EQ(at[0], body.position_m.x);
      EXPECT_EQ(at[1], body.position_m.y + 2.0 * world);
      EXPECT_EQ(at[2], body.position_m.z);
      EXPECT_EQ(at[6], body.orientation.z);
    }
    for (std::size_t c = 0; c < cables; ++c) {
      const double* at = &frame.numbers[frame.cables() + (world * cables + c) * 4];
      const CableState cable = batch.Cable(world, static_cast<int>(c));
      EXPECT_EQ(at[0], cable.tension_n);
      EXPECT_EQ(at[1], cable.length_m);
      EXPECT_EQ(at[2], cable.rest_length_m);
      EXPECT_TRUE(std::isnan(at[3]));
    }
  }
  ASSERT_EQ(frame[FrameHeader::kFramePushCount], 1);
  EXPECT_EQ(frame.numbers[frame.pushes()], static_cast<double>(model->def().nodes.size()) + 2);
  EXPECT_EQ(frame.numbers[frame.pushes() + 1], 3);
  const auto contacts = batch.Contacts(0), others = batch.Contacts(1);
  ASSERT_EQ(frame[FrameHeader::kFrameContactRows],
            static_cast<double>(contacts.size() + others.size()));
  ASSERT_GT(others.size(), 0u);
  const double* last = &frame.numbers[frame.contacts() + 6 * (contacts.size())];
  EXPECT_EQ(last[1], others[0].point_m.y + 2.0);
  EXPECT_EQ(last[5], others[0].force_n.z);
  EXPECT_EQ(frame.numbers[frame.values()], 12.5);
  EXPECT_EQ(frame[FrameHeader::kFrameKineticJ],
            batch.TotalEnergy(0).kinetic_j + batch.TotalEnergy(1).kinetic_j);
}

TEST_F(PageTest, TerrainThatDiffersIsShownOfEach) {
  const auto page = Open();
  ModelDef other = Prism();
  other.planes[0].point_m.z = -0.1;
  page->Add(Prism(), "a");
  page->Add(other, "b");
  page->Show(0);
  Client browser = Browser(*page, page->url());
  const Json scene = browser.Await("scene")["scene"];
  EXPECT_EQ(Names(scene["terrain"]), (std::vector<std::string>{"a/ground", "b/ground"}));
}

TEST_F(PageTest, ARobotThatNobodySimulatesHasWhatIsKnown) {
  const auto page = Open();
  const ModelDef def = Prism();
  const int robot = page->Add(def);
  RobotMoment moment;
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    moment.tension_n.push_back(1.0 + static_cast<double>(c));
    moment.set_point_n.push_back(7.0);
  }
  page->Set(robot, moment);
  RobotMoment beside;
  beside.bends_m.resize(def.cables.size());
  beside.bends_m[2] = {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}};
  page->Set(page->Add(def, "beside", {0, 0, 1}), beside);
  page->Show(0.25);
  Client browser = Browser(*page, page->url());
  const ReceivedFrame frame = browser.AwaitFrame([](const auto& f) { return HasTime(f, 0.25); });
  EXPECT_EQ(frame.numbers[frame.bodies()], def.bodies[0].com_m.x);
  EXPECT_EQ(frame.numbers[frame.bodies() + 3], 1);
  EXPECT_EQ(frame.numbers[frame.cables() + 4], 2.0);
  EXPECT_TRUE(std::isnan(frame.numbers[frame.cables() + 5]));
  EXPECT_EQ(frame.numbers[frame.cables() + 7], 7.0);
  EXPECT_TRUE(std::isnan(frame[FrameHeader::kFrameKineticJ]));
  ASSERT_EQ(frame[FrameHeader::kFrameBendCount], 2);
  const auto cable = static_cast<double>(def.cables.size() + 2);
  const std::vector<double> bends = {cable, 0.1, 0.2, 1.3, cable, 0.4, 0.5, 1.6};
  EXPECT_EQ(std::vector<double>(frame.numbers.end() - 8, frame.numbers.end()), bends);
}

/// Shows poses of a robot until it is destroyed: at 0, 0.1, 0.2 ... s, with 10 times the time
/// plotted.
class Program {
 public:
  explicit Program(Page& page) {
    page.Add(Prism());
    thread_ = std::thread([this, &page] {
      for (int i = 0; !end_; ++i) {
        page.Plot("ten_times", "s", i);
        page.Show(0.1 * i);
      }
    });
  }
  ~Program() {
    end_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> end_{false};
  std::thread thread_;
};

TEST_F(PageTest, PausesStepsAndGoesOnAsTheBrowserSays) {
  options_.speed = 100;  // so that all frames are still available for seeking
  const auto page = Open();
  Client browser = Browser(*page, page->url());
  const auto paused_at = [&](double time_s) {
    return browser.AwaitFrame([=](const auto& f) {
      return f[FrameHeader::kFramePaused] == 1 && f[FrameHeader::kFrameTimeS] > time_s;
    });
  };
  {
    const Program program(*page);
    browser.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameTimeS] > 0; });
    browser.Send({{"type", "pause"}});
    paused_at(0);
    // One more frame may have been sent before. From here on the position follows commands.
    const double at_s = paused_at(0)[FrameHeader::kFrameTimeS];
    const int at = static_cast<int>(std::lround(10 * at_s));
    browser.Send({{"type", "step"}, {"count", 3}});
    EXPECT_EQ(browser.AwaitFrame([&](const auto& f) {
      return f[FrameHeader::kFrameTimeS] > 0.1 * (at + 2) + 0.05;
    })[FrameHeader::kFrameTimeS],
              0.1 * (at + 3));
    browser.Send({{"type", "seek"}, {"time_s", 0.1 * at}});
    const auto past = browser.AwaitFrame(
        [](const auto& f) { return f[FrameHeader::kFrameTimeS] < f[FrameHeader::kFrameNowS]; });
    EXPECT_EQ(past[FrameHeader::kFrameTimeS], 0.1 * at);
    EXPECT_EQ(past.numbers[past.values()], at);
    browser.Send({{"type", "want_series"},
                  {"id", 5},
                  {"channel", "ten_times"},
                  {"t0", 0.1 * at},
                  {"t1", 0.1 * at},
                  {"points", 9}});
    const Json series = browser.Await("series")["series"];
    ASSERT_FALSE(series["time_s"].empty());
    for (std::size_t i = 0; i < series["time_s"].size(); ++i) {
      EXPECT_NEAR(series["first"][i], 10 * series["time_s"][i].get<double>(), 1e-9);
    }
    browser.Send({{"type", "resume"}});
    browser.AwaitFrame([&](const auto& f) { return f[FrameHeader::kFrameTimeS] > at_s + 1; });
  }
}

/// Without `browser_pauses`, a pause or a seek holds the picture, and the program goes on.
TEST_F(PageTest, APageThatOnlyWatchesDoesNotStopTheProgram) {
  options_.browser_pauses = false;
  options_.frame_ancestors = "http://localhost:*";
  const auto page = Open();
  page->Add(Prism());
  for (int i = 0; i <= 10; ++i) page->Show(0.1 * i);
  Client browser = Browser(*page, page->url());
  const auto shows = [&](double time_s, double now_s) {
    const auto frame = browser.AwaitFrame([&](const auto& f) {
      return f[FrameHeader::kFrameTimeS] == time_s && f[FrameHeader::kFrameNowS] == now_s;
    });
    return frame[FrameHeader::kFramePaused] == 1;
  };
  browser.Send({{"type", "seek"}, {"time_s", 0.1 * 4}});
  EXPECT_TRUE(shows(0.1 * 4, 0.1 * 10));
  for (int i = 11; i <= 20; ++i) page->Show(0.1 * i);  // would wait forever
  EXPECT_TRUE(shows(0.1 * 4, 0.1 * 20));
  browser.Send({{"type", "step"}, {"count", 2}});
  EXPECT_TRUE(shows(0.1 * 6, 0.1 * 20));
  browser.Send({{"type", "seek"}, {"time_s", 100}});  // the present: follows again
  EXPECT_FALSE(shows(0.1 * 20, 0.1 * 20));
  browser.Send({{"type", "pause"}});
  EXPECT_TRUE(shows(0.1 * 20, 0.1 * 20));
  page->Show(0.1 * 21);
  EXPECT_TRUE(shows(0.1 * 20, 0.1 * 21));
  page->Show(0.05);  // another run
  EXPECT_FALSE(shows(0.05, 0.05));
  browser.Send({{"type", "speed"}, {"factor", 2}});
  EXPECT_EQ(browser.Await("error")["text"],
            "speed is not possible in a page that a program has opened");
  options_.speed = 1;
  Diagnostics out;
  EXPECT_EQ(Page::Open(options_, out), nullptr);
  EXPECT_NE(out.Format().find("speed must be 0 without browser_pauses"), std::string::npos);
}

/// Tags and phases of an experiment are in the scene, as in a live run.
TEST_F(PageTest, AnExperimentIsShownWithItsTagsAndPhases) {
  Diagnostics found;
  const auto experiment =
      LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml", {}, found);
  ASSERT_TRUE(experiment) << found.Format();
  const auto page = Open();
  EXPECT_EQ(page->Add(*experiment), 0);
  page->Show(0);
  const Json scene = Browser(*page, page->url()).Await("scene")["scene"];
  EXPECT_FALSE(scene["phases"].empty());
  EXPECT_FALSE(scene["cables"][0]["tags"].empty());
}

TEST_F(PageTest, WhatDoesNotGoWithAProgramIsSaid) {
  const auto page = Open();
  page->Add(Prism());
  page->Show(0);
  Client browser = Browser(*page, page->url());
  browser.Send({{"type", "reset"}});
  EXPECT_EQ(browser.Await("error")["text"],
            "reset is not possible in a page that a program has opened");
  browser.Send({{"type", "want_series"},
                {"id", 1},
                {"channel", "none"},
                {"t0", 0},
                {"t1", 1},
                {"points", 9}});
  EXPECT_EQ(browser.Await("error")["text"], "there is no channel \"none\"");
}

TEST_F(PageTest, ATimeThatGoesBackIsAnotherRun) {
  const auto page = Open();
  page->Add(Prism());
  for (const double time_s : {0.0, 0.5, 1.0}) page->Show(time_s);
  Client browser = Browser(*page, page->url());
  const double run =
      browser.AwaitFrame([](const auto& f) { return HasTime(f, 1.0); })[FrameHeader::kFrameRun];
  page->Show(0.5);
  EXPECT_EQ(
      browser.AwaitFrame([](const auto& f) { return HasTime(f, 0.5); })[FrameHeader::kFrameRun],
      run + 1);
  browser.Send({{"type", "want_series"},
                {"id", 1},
                {"channel", "system/kinetic_j"},
                {"t0", 0},
                {"t1", 1},
                {"points", 9}});
  EXPECT_EQ(browser.Await("series")["series"]["time_s"], Json({0.5}));
}

/// The next run waits until the page resumes it: it has no past for seeking and no lag to catch up.
TEST_F(PageTest, ARunThatWaitsHasNoPast) {
  options_.speed = 1;
  const auto page = Open();
  page->Add(Prism());
  page->Show(1000.5);
  Client browser = Browser(*page, page->url());
  const double run =
      browser.AwaitFrame([](const auto& f) { return HasTime(f, 1000.5); })[FrameHeader::kFrameRun];
  browser.Send({{"type", "pause"}});
  browser.AwaitFrame([](const auto& f) { return f[FrameHeader::kFramePaused] == 1; });
  std::thread program([&] { page->Show(1000); });
  for (int i = 0; i < 3; ++i) {
    browser.Send({{"type", "seek"}, {"time_s", 0}});
    browser.Send({{"type", "step"}, {"count", -1}});
    browser.Send({{"type", "reset"}});  // its answer comes after those are done
    browser.Await("error");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  browser.Send({{"type", "resume"}});
  EXPECT_EQ(
      browser.AwaitFrame([](const auto& f) { return HasTime(f, 1000); })[FrameHeader::kFrameRun],
      run + 1);
  program.join();
}

TEST_F(PageTest, AllThatIsWrongWithOptionsIsNamedAtOnce) {
  options_.speed = -1;
  options_.history_period_s = 0;
  options_.address = "home";
  options_.web_folder = folder_ + "/nothing";
  Diagnostics out;
  EXPECT_EQ(Page::Open(options_, out), nullptr);
  for (const char* word :
       {"PageOptions.speed must not be negative, got -1",
        "history_period_s must be positive, got 0", "\"home\"", "pages are missing"}) {
    EXPECT_NE(out.Format().find(word), std::string::npos) << word << " in " << out.Format();
  }
}

TEST_F(PageTest, APortInUseIsNamed) {
  const auto page = Open();
  options_.port = Port(*page);
  Diagnostics out;
  EXPECT_EQ(Page::Open(options_, out), nullptr);
  EXPECT_NE(out.Format().find("is in use"), std::string::npos) << out.Format();
}

using PageDeathTest = PageTest;

TEST_F(PageDeathTest, MistakesOfTheProgramEndItAndSayWhat) {
  const auto page = Open();
  const int robot = page->Add(Prism());
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  RobotMoment moment;
  EXPECT_DEATH(page->Set(robot + 1, moment), "taut::Page: there is no robot 1 .the page has 1.");
  moment.tension_n = {1.0};
  EXPECT_DEATH(page->Set(robot, moment), "tension_n of robot 0 has 1 entries, expected 9");
}

TEST(Pace, TimeIsDueWhereItIsWanted) {
  Pace pace(0.5, false);
  pace.Anchor(3.0);
  const auto due = pace.DueAt(10.0);
  EXPECT_NEAR(pace.WantedAt(due), 10.0, 1e-6);
  EXPECT_NEAR(pace.WantedAt(due + std::chrono::seconds(2)), 11.0, 1e-6);
  EXPECT_EQ(pace.DueAt(2.0), pace.DueAt(3.0));  // past times are due immediately
  pace.SetSpeed(0, 10.0);
  EXPECT_EQ(pace.WantedAt(due), std::numeric_limits<double>::infinity());
  EXPECT_LE(pace.DueAt(1e300), Pace::Clock::now());
}

TEST(Pace, WhoIsFarBehindGoesOnFromWhereHeIs) {
  Pace pace(2.0, false);
  pace.Anchor(0.0);
  const auto one_second_on = pace.DueAt(2.0);
  pace.At(1.95, one_second_on);  // slightly late: catches up
  EXPECT_NEAR(pace.WantedAt(one_second_on), 2.0, 1e-6);
  EXPECT_NEAR(pace.real_time_factor(), 1.95, 1e-6);
  pace.At(1.0, one_second_on);
  EXPECT_NEAR(pace.WantedAt(one_second_on), 1.0, 1e-6);
  pace.Pause(1.0);
  EXPECT_EQ(pace.real_time_factor(), 0);
}

}  // namespace
}  // namespace taut::test
