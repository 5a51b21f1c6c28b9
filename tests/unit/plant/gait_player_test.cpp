// Gaits in operation: clocks, tables, feedback, and the commands of a cable
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "plant/lane_clock.h"
#include "plant/loop.h"
#include "plant/player_kinds.h"
#include "taut/play.h"
#include "taut/run.h"
#include "tests/constants.h"
#include "tests/unit/plant/fake_plant.h"

namespace taut::test {
namespace {

const std::string kPlayerRoot = TAUT_SOURCE_DIR "/";

RobotSpec PlayerSpine() {
  Diagnostics out;
  auto robot = LoadRobot(kPlayerRoot + "share/models/tetraspine3.yaml", {}, out);
  EXPECT_TRUE(robot) << out.Format();
  return robot.value_or(RobotSpec{});
}

/// A gait alone, on a clock, in one lane
struct Player {
  Player(const GaitSpec& gait, const ClockSpec& on) : spec(on), clock(on, 1) {
    Diagnostics out;
    const auto resolved = ResolveGait(gait, PlayerSpine(), out);
    EXPECT_TRUE(resolved) << out.Format();
    player = plant::PlayerOf({{&gait}, resolved.value_or(ResolvedGait{}), on.period_s});
  }

  const std::vector<int>& cables() const { return player->cables(); }
  const std::vector<double>& signal() const { return player->signal(); }
  double next_tick_s() const { return clock.NextS(0); }

  /// Acts if a tick is due. `tension_n`: of every cable of the robot; may be empty.
  void Act(double time_s, const std::vector<double>& tension_n = {}) {
    const Tick tick = clock.Due(&time_s, AllLanes(1));
    if (tick.due == 0) return;
    const double since_s =
        control::TickTime(control::Clock<double>{spec.period_s, spec.phase_s}, *tick.number);
    Observation seen;
    seen.cables.tension_n = tension_n.data();
    player->Tick({tick.due, tick.number, &since_s, &since_s}, seen);
    clock.Advance(tick.due);
  }

  ClockSpec spec;
  plant::LaneClock clock;
  std::unique_ptr<plant::GaitPlayer> player;
};

GaitSpec OneWave(double frequency_hz) {
  SineWave wave;
  wave.name = "w";
  wave.cables = {{"outer", "top"}};
  wave.amplitude = 0.1;
  wave.offset = 0.02;
  wave.phase_per_segment_rad = kTwoPi / 4;
  GaitSpec gait;
  gait.name = "g";
  gait.sine = SineGait{frequency_hz, {wave}};
  return gait;
}

GaitSpec OneTable(bool linear) {
  TableGait table;
  table.cables = {"outer_top_2"};
  table.time_s = {0.0, 0.5, 1.0};
  table.rows = {{0.1}, {0.2}, {0.4}};
  table.linear = linear;
  GaitSpec gait;
  gait.name = "t";
  gait.table = table;
  return gait;
}

TEST(GaitPlayer, AWaveTravelsAndHoldsBetweenTicks) {
  Player player(OneWave(0.5), {0.25, 0.5});
  ASSERT_EQ(player.cables().size(), 2u);
  EXPECT_EQ(player.next_tick_s(), 0.5);
  player.Act(0.25);  // not yet
  EXPECT_EQ(player.signal()[0], 0.0);
  player.Act(0.5);
  EXPECT_NEAR(player.signal()[0], 0.02, 1e-15);        // cos 90 degrees
  EXPECT_NEAR(player.signal()[1], 0.02 - 0.1, 1e-15);  // a quarter turn later
  EXPECT_EQ(player.next_tick_s(), 0.75);
  player.Act(0.6);
  EXPECT_NEAR(player.signal()[0], 0.02, 1e-15);
  player.Act(0.75);
  EXPECT_NEAR(player.signal()[0], 0.02 + 0.1 * std::cos(kTwoPi * 0.375), 1e-15);
}

TEST(GaitPlayer, ATableHoldsOrGoesStraight) {
  Player held(OneTable(false), {0.25, 0.0});
  Player straight(OneTable(true), {0.25, 0.0});
  const double of_held[] = {0.1, 0.1, 0.2, 0.2, 0.4, 0.4};
  const double of_straight[] = {0.1, 0.15, 0.2, 0.3, 0.4, 0.4};
  for (int tick = 0; tick < 6; ++tick) {
    held.Act(0.25 * tick);
    straight.Act(0.25 * tick);
    EXPECT_EQ(held.signal()[0], of_held[tick]) << tick;
    EXPECT_NEAR(straight.signal()[0], of_straight[tick], 1e-15) << tick;
  }
}

TEST(GaitPlayer, ATableRepeats) {
  GaitSpec gait = OneTable(false);
  gait.table->repeat_from_s = 0.5;  // then the row at 1 s is never used
  Player player(gait, {0.25, 0.0});
  const double expected[] = {0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.2};
  for (int tick = 0; tick < 7; ++tick) {
    player.Act(0.25 * tick);
    EXPECT_EQ(player.signal()[0], expected[tick]) << tick;
  }
  gait.table->repeat_from_s = 0.0;
  Player from_start(gait, {0.25, 0.0});
  const double round[] = {0.1, 0.1, 0.2, 0.2, 0.1, 0.1, 0.2};
  for (int tick = 0; tick < 7; ++tick) {
    from_start.Act(0.25 * tick);
    EXPECT_EQ(from_start.signal()[0], round[tick]) << tick;
  }
}

GaitSpec BlankCpg() {
  Diagnostics out;
  auto gait = NewCpgGait(PlayerSpine(), CpgSymmetry::kSegments, out);
  EXPECT_TRUE(gait);
  gait->cpg->frequency_hz = 1.0;
  gait->cpg->amplitude = 0.1;
  gait->cpg->inverted = {{"inner_top_1"}};
  return *gait;
}

TEST(GaitPlayer, OscillatorsStartAtTheFirstTickAndSomeAreInverted) {
  Player player(BlankCpg(), {0.01, 0.0});
  player.Act(0.0);
  for (const double v : player.signal()) EXPECT_EQ(v, 0.0);  // amplitudes grow from 0
  for (int tick = 1; tick <= 200; ++tick) player.Act(0.01 * tick);
  const RobotSpec robot = PlayerSpine();
  for (std::size_t i = 0; i < player.cables().size(); ++i) {
    const std::string& name = robot.def.cables[static_cast<std::size_t>(player.cables()[i])].name;
    // two turns after the start; (1 + 20) exp(-20) of the amplitude is missing
    EXPECT_NEAR(player.signal()[i], name == "inner_top_1" ? -0.1 : 0.1, 1e-8) << name;
  }
}

// At common ticks, a gait at 100 Hz equals the gait at 1 kHz, because it integrates with the same
// steps; periods divided by 40 and by 4 may differ by rounding.
TEST(GaitPlayer, TheRateOfTheGaitDoesNotChangeItsOscillators) {
  Diagnostics out;
  const auto gait = LoadGait(kPlayerRoot + "share/gaits/cpg_learned_ntrt.yaml", out);
  ASSERT_TRUE(gait) << out.Format();
  const auto fast = PlayGait(*gait, PlayerSpine(), 1000.0, 2.0, out);
  const auto slow = PlayGait(*gait, PlayerSpine(), 100.0, 2.0, out);
  ASSERT_TRUE(fast && slow);
  ASSERT_EQ(slow->rows.size(), 201u);
  for (std::size_t i = 0; i < slow->rows.size(); ++i) {
    for (std::size_t c = 0; c < 12; ++c) {
      ASSERT_NEAR(slow->rows[i][c], fast->rows[10 * i][c], 1e-12);
    }
  }
}

// theta' = omega + g (T - T_ref) cos theta: a constant tension of 12 N against 10 N at g = 5 stops
// an oscillator of 1 Hz where the cosine is -omega / 10.
TEST(GaitPlayer, TensionActsOnTheOscillatorOfItsCable) {
  GaitSpec gait = BlankCpg();
  gait.cpg->inverted.clear();
  gait.cpg->feedback = CpgFeedback{5.0, 10.0};
  Player player(gait, {0.001, 0.0});
  std::vector<double> tension_n(PlayerSpine().def.cables.size(), 10.0);
  tension_n[static_cast<std::size_t>(player.cables()[3])] = 12.0;
  for (int tick = 0; tick <= 5000; ++tick) {
    player.Act(0.001 * tick, tension_n);
  }
  for (std::size_t i = 0; i < player.cables().size(); ++i) {
    EXPECT_NEAR(player.signal()[i], i == 3 ? -0.1 * kTwoPi / 10.0 : 0.1, 1e-4) << i;
  }
}

TEST(GaitPlayer, ATableOfAGaitPlaysAsTheGaitItself) {
  Diagnostics out;
  const auto gait = LoadGait(kPlayerRoot + "share/gaits/cpg_learned.yaml", out);
  ASSERT_TRUE(gait) << out.Format();
  const auto table = PlayGait(*gait, PlayerSpine(), 100.0, 3.0, out);
  ASSERT_TRUE(table);
  const auto folder = std::filesystem::path(testing::TempDir()) / "taut_gait_table";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "t.csv") << GaitTableText(*table);
  std::ofstream(folder / "t.yaml") << "taut: 1\nkind: gait\nname: t\ntable: {file: t.csv}\n";
  const auto replayed = LoadGait((folder / "t.yaml").string(), out);
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(replayed) << out.Format();
  Player original(*gait, {0.01, 0.0}), replay = Player(*replayed, {0.01, 0.0});
  EXPECT_EQ(original.cables(), replay.cables());
  for (int tick = 0; tick <= 300; ++tick) {
    original.Act(0.01 * tick);
    replay.Act(0.01 * tick);
    ASSERT_EQ(original.signal(), replay.signal()) << tick;
  }
}

/// An impedance controller of one cable at 1 kHz with a gait at 4 Hz
TEST(GaitPlayer, TheGaitActsBeforeTheLawThatItFeeds) {
  const RobotSpec robot = PlayerSpine();
  int cable = 0;
  while (robot.def.cables[static_cast<std::size_t>(cable)].name != "outer_top_2") ++cable;
  ControllerSpec spec;
  spec.name = "c";
  spec.impedance.emplace();
  spec.impedance->cables.push_back({cable, 10.0, 0.2, 0.0, 100.0, 0.01});
  spec.velocity_input = GaitInputSpec{{0.25, 0.0}, OneTable(false), {}, {}};
  ExperimentSpec experiment;
  experiment.robot = robot;
  experiment.controllers = {spec};
  experiment.duration_s = 1.0;
  FakePlant plant(robot.def.cables.size());
  plant.Show({0.15, 0.2, 0.0, 10.0, 10.0, 229.16});
  plant::Loop loop(experiment, plant);
  loop.Step();
  // the offsets of the cable and of the gait, already in the first tick: T0 + B (0 - V0)
  EXPECT_EQ(plant.commands().velocity_input_m_per_s[cable], 0.01 + 0.1);
  EXPECT_NEAR(plant.commands().set_point_n[cable], 0.0, 0.0);  // 10 - 11: a cable cannot push
  EXPECT_EQ(loop.time_s(), 0.001);
  while (loop.time_s() < 0.5005) loop.Step();
  EXPECT_EQ(plant.commands().velocity_input_m_per_s[cable], 0.01 + 0.2);
}

// A controller slower than its gait uses the gait's latest value, and steps end at ticks of both
// clocks.
TEST(GaitPlayer, StepsLandOnTheTicksOfTheGait) {
  Diagnostics out;
  auto experiment = LoadExperiment(kPlayerRoot + "share/experiments/sine_hand_tuned.yaml", {}, out);
  ASSERT_TRUE(experiment) << out.Format();
  experiment->controllers[0].velocity_input->clock = {0.0037, 0.0005};
  experiment->duration_s = 0.05;
  experiment->step_s = 0.01;  // far longer than either period
  experiment->record.rate_hz = 0;
  experiment->record.channels = {"cable/outer_top_1/velocity_input_m_per_s"};
  struct Times : TraceWriter {
    std::vector<double> time_s, velocity_m_per_s;
    bool Append(double t_s, const double* row) override {
      time_s.push_back(t_s);
      velocity_m_per_s.push_back(row[0]);
      return true;
    }
    bool FlushOld() override { return true; }
    bool Finish() override { return true; }
    const std::string& error() const override { return none; }
    std::string none;
  } times;
  RunOptions options;
  options.traces = {&times};
  ASSERT_TRUE(RunExperiment(*experiment, options, out)) << out.Format();
  int gait_ticks = 0, law_ticks = 0;
  for (const double t : times.time_s) {
    const double of_gait = (t - 0.0005) / 0.0037, of_law = t / 0.001;
    if (std::fabs(of_gait - std::round(of_gait)) < 1e-9) ++gait_ticks;
    if (std::fabs(of_law - std::round(of_law)) < 1e-9) ++law_ticks;
  }
  EXPECT_EQ(gait_ticks, 14);  // 0.0005, 0.0042, ..., 0.0486
  EXPECT_EQ(law_ticks, 51);
}

}  // namespace
}  // namespace taut::test
