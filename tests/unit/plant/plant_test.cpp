// Interface between controllers and the plant: lanes with separate clocks, user-defined controllers
// and sensors, recordings as plants
#include "taut/plant.h"

#include <gtest/gtest.h>

#include "plant/find_start.h"
#include "plant/loop.h"
#include "taut/live.h"
#include "taut/rollout.h"
#include "taut/run.h"
#include "tests/unit/plant/fake_plant.h"
#include "tests/unit/plant/recorder_fixture.h"

namespace taut::test {
namespace {

ExperimentSpec LoadShipped(const std::string& name) {
  Diagnostics out;
  auto experiment = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/" + name + ".yaml", {}, out);
  EXPECT_TRUE(experiment) << out.Format();
  return experiment.value_or(ExperimentSpec{});
}

/// A different variant for each lane
std::vector<RolloutWorld> VariantsOf(const ExperimentSpec& experiment, int count) {
  std::vector<RolloutWorld> worlds(static_cast<std::size_t>(count), WorldOf(experiment));
  for (std::size_t j = 0; j < worlds.size(); ++j) {
    worlds[j].seed = 100 + j;
    for (ControllerSpec& controller : worlds[j].controllers) {
      if (!controller.impedance) continue;
      for (ImpedanceGains& gains : controller.impedance->cables) {
        gains.tension_offset_n *= 1.0 + 0.01 * static_cast<double>(j);
      }
    }
  }
  return worlds;
}

/// Lanes of a batch under an experiment, each at the start of its variant
class Company {
 public:
  Company(const ExperimentSpec& experiment, std::vector<RolloutWorld> worlds, Simd simd)
      : experiment_(experiment),
        worlds_(std::move(worlds)),
        model_(Model::Compile(experiment.robot.def, out_)),
        batch_(model_, {.worlds = static_cast<int>(worlds_.size()), .simd = simd}),
        plant_(PlantOf(batch_)) {
    std::vector<const RolloutWorld*> lanes;
    for (std::size_t j = 0; j < worlds_.size(); ++j) {
      lanes.push_back(&worlds_[j]);
      BringToStart(static_cast<int>(j));
    }
    loop_.emplace(experiment_, lanes, *plant_, Extensions{});
  }

  void BringToStart(int lane) {
    WorldBatch alone(model_, {});
    const auto& world = worlds_[static_cast<std::size_t>(lane)];
    EXPECT_TRUE(plant::PrepareStart(ExperimentOf(experiment_, world), alone, out_));
    EXPECT_TRUE(batch_.Restore(lane, alone.Save(0)));
  }
  /// Restarts a lane as another variant.
  void Restart(int lane) {
    RolloutWorld& world = worlds_[static_cast<std::size_t>(lane)];
    world.seed += 1000;
    world.scales.push_back({ScaleSpec::Quantity::kMass, {}, 1.03});
    for (ControllerSpec& controller : world.controllers) {
      if (controller.impedance) controller.impedance->cables[0].tension_offset_n += 0.5;
    }
    BringToStart(lane);
    loop_->Restart(lane, world);
  }
  const std::vector<RolloutWorld>& worlds() const { return worlds_; }

  plant::Loop& loop() { return *loop_; }
  std::uint64_t Hash(int lane) const { return batch_.Hash(lane); }

 private:
  Diagnostics out_;
  const ExperimentSpec& experiment_;
  std::vector<RolloutWorld> worlds_;
  std::shared_ptr<const Model> model_;
  WorldBatch batch_;
  std::unique_ptr<Plant> plant_;
  std::optional<plant::Loop> loop_;
};

std::uint64_t HashAlone(const ExperimentSpec& experiment, const RolloutWorld& world) {
  Diagnostics out;
  const auto summary = RunExperiment(ExperimentOf(experiment, world), {}, out);
  EXPECT_TRUE(summary) << out.Format();
  return summary ? summary->state_hash : 0;
}

/// Restarts some lanes during the run; every lane must equal a separate run bit for bit.
void ExpectOwnBits(ExperimentSpec experiment, double duration_s) {
  experiment.duration_s = duration_s;
  const int lanes = static_cast<int>(BestSimd());
  Company company(experiment, VariantsOf(experiment, lanes), BestSimd());
  const std::vector<RolloutWorld>& worlds = company.worlds();
  plant::Loop& loop = company.loop();
  const std::pair<double, int> restarts[] = {
      {0.2, 1 % lanes}, {0.3217, 2 % lanes}, {0.55, 1 % lanes}};
  std::size_t done = 0;
  int hashed = 0;
  std::vector<std::uint64_t> hash(static_cast<std::size_t>(lanes));
  for (double passed_s = 0; hashed < lanes; passed_s += loop.step_s()[0]) {
    ASSERT_LT(passed_s, 3 * duration_s);
    if (done < std::size(restarts) && passed_s >= restarts[done].first) {
      company.Restart(restarts[done++].second);
    }
    loop.Step();
    for (int j = 0; j < lanes; ++j) {
      std::uint64_t& own = hash[static_cast<std::size_t>(j)];
      if (loop.time_s(j) != duration_s || own != 0) continue;
      own = company.Hash(j);
      ++hashed;
    }
  }
  ASSERT_EQ(done, std::size(restarts));
  for (std::size_t j = 0; j < worlds.size(); ++j) {
    EXPECT_EQ(hash[j], HashAlone(experiment, worlds[j])) << experiment.name << ", lane " << j;
  }
}

TEST(Lanes, BeginAnewWhileTheirNeighboursRunOn) {
  ExpectOwnBits(LoadShipped("cpg_learned"), 0.7);
  ExperimentSpec push = LoadShipped("push_20n");
  for (auto& [time_s, force_n] : push.pushes[0].force_n) time_s = 0.05 * time_s + 0.0003;
  ExpectOwnBits(push, 0.7);
  ExperimentSpec drag = LoadShipped("drag");
  drag.drags[0].from_s = 0.1003;
  drag.drags[0].to_s = 0.9;
  ExpectOwnBits(drag, 0.7);
}

TEST(Lanes, BeginAnewWithSensorsAndUnevenClocks) {
  ExperimentSpec experiment = LoadShipped("sine_hand_tuned");
  experiment.sensors.emplace();
  experiment.sensors->period_s = 0.0013;
  experiment.sensors->load_cell = LoadCellSpec{.noise_n = 0.2, .bias_n = 0.1, .delay_s = 0.0026};
  experiment.sensors->encoder = EncoderSpec{1e-5, 0.0013};
  experiment.controllers[0].velocity_input->clock = {0.0037, 0.0005};
  experiment.controllers[0].impedance->differenced_rate = true;
  ExpectOwnBits(experiment, 0.7);
}

TEST(Lanes, BeginAnewWhileTheyFallAndTouch) { ExpectOwnBits(LoadShipped("drop_six_strut"), 0.9); }

/// A controller that lets every cable out and in, by its number in the world
class Breathe final : public Controller {
 public:
  explicit Breathe(const ControlSetup& setup) {
    for (const RolloutWorld* world : setup.lanes) {
      depth_m_.push_back(world->numbers.empty() ? 0.002 : world->numbers[0]);
    }
    for (const CableDef& cable : setup.experiment.robot.def.cables) {
      rest_m_.push_back(cable.rest_length_m);
    }
  }
  ClockSpec clock() const override { return {0.005, 0.0}; }
  void Act(const Tick& tick, const Observation& seen, Commands& commands) override {
    const auto lanes = static_cast<std::size_t>(seen.lanes);
    for (std::size_t i = 0; i < rest_m_.size() * lanes; ++i) {
      const std::size_t j = i % lanes;
      if (!Has(tick.due, static_cast<int>(j))) continue;
      commands.rest_length_m[i] = rest_m_[i / lanes] + (tick.number[j] % 20 < 10 ? depth_m_[j] : 0);
    }
  }

 private:
  std::vector<double> depth_m_, rest_m_;
};

TEST(Extensions, AControllerActsInARunALiveRunAndLanesToTheSameBits) {
  ExperimentSpec experiment = LoadShipped("stand_still");
  experiment.duration_s = 0.5;
  Extensions extensions;
  extensions.controllers.push_back(
      [](const ControlSetup& setup) { return std::make_unique<Breathe>(setup); });
  Diagnostics out;
  RunOptions options;
  options.extensions = extensions;
  const auto alone = RunExperiment(experiment, options, out);
  ASSERT_TRUE(alone) << out.Format();
  EXPECT_NE(alone->state_hash, HashAlone(experiment, WorldOf(experiment)));

  const auto live = LiveRun::Start(experiment, out, {}, extensions);
  ASSERT_TRUE(live) << out.Format();
  while (live->time_s() < experiment.duration_s) ASSERT_TRUE(live->Step());
  EXPECT_EQ(live->world()->Hash(0), alone->state_hash);

  RolloutOptions side_by_side;
  side_by_side.extensions = extensions;
  const auto rollouts = Rollouts::Create(experiment, {}, side_by_side, out);
  std::vector<RolloutWorld> worlds(5, WorldOf(experiment));
  worlds[1].numbers = {0.004};
  const auto results = rollouts->Run(worlds);
  EXPECT_EQ(results[0].state_hash, alone->state_hash);
  EXPECT_NE(results[1].state_hash, alone->state_hash);
  EXPECT_EQ(results[4].state_hash, alone->state_hash);
}

/// Sensors that double every tension
class Double final : public SensorModel {
 public:
  ClockSpec clock() const override { return {0.001, 0.0}; }
  void Sample(const Tick&, const Observation& exact) override {
    shown_ = exact;
    tension_n_.resize(exact_cables_);
    for (std::size_t i = 0; i < exact_cables_; ++i) tension_n_[i] = 2 * exact.cables.tension_n[i];
    shown_.cables.tension_n = tension_n_.data();
  }
  const Observation& seen() const override { return shown_; }
  explicit Double(const ControlSetup& setup)
      : exact_cables_(setup.experiment.robot.def.cables.size() * setup.lanes.size()) {}

 private:
  std::size_t exact_cables_;
  std::vector<double> tension_n_;
  Observation shown_;
};

TEST(Extensions, SensorsStandBetweenThePlantAndTheControllers) {
  ExperimentSpec experiment = LoadShipped("stand_still");
  experiment.duration_s = 0.1;
  struct Sees final : Controller {
    explicit Sees(double& into) : tension_n(into) {}
    ClockSpec clock() const override { return {0.001, 0.0}; }
    void Act(const Tick& tick, const Observation& seen, Commands&) override {
      if (tick.number[0] == 0) tension_n = seen.Cable(2).tension_n;
    }
    double& tension_n;
  };
  double exact_n = 0, seen_n = 0;
  RunOptions options;
  options.extensions.controllers = {
      [&](const ControlSetup&) { return std::make_unique<Sees>(exact_n); }};
  Diagnostics out;
  ASSERT_TRUE(RunExperiment(experiment, options, out)) << out.Format();
  options.extensions.controllers = {
      [&](const ControlSetup&) { return std::make_unique<Sees>(seen_n); }};
  options.extensions.sensors = [](const ControlSetup& s) { return std::make_unique<Double>(s); };
  ASSERT_TRUE(RunExperiment(experiment, options, out)) << out.Format();
  EXPECT_GT(exact_n, 1.0);
  EXPECT_EQ(seen_n, 2 * exact_n);
}

TEST(Extensions, AScoreTakesThePlaceOfTheMeasure) {
  ExperimentSpec experiment = LoadShipped("stand_still");
  experiment.duration_s = 0.25;
  struct Steps final : Score {
    explicit Steps(std::size_t lanes) : sum_s(lanes) {}
    void Take(const Observation&, const Commands&, const World&, const double* step_s) override {
      for (std::size_t j = 0; j < sum_s.size(); ++j) sum_s[j] += step_s[j];
    }
    double Result(int lane) const override {
      return lane == 1 ? std::nan("") : sum_s[static_cast<std::size_t>(lane)];
    }
    std::vector<double> sum_s;
  };
  RolloutOptions options;
  options.simd = BestSimd();
  options.score = [](const ControlSetup& setup) {
    return std::make_unique<Steps>(setup.lanes.size());
  };
  Diagnostics out;
  const auto rollouts = Rollouts::Create(experiment, {}, options, out);
  ASSERT_TRUE(rollouts) << out.Format();
  const auto results = rollouts->Run(std::vector<RolloutWorld>(2, WorldOf(experiment)));
  EXPECT_NEAR(results[0].score, 0.25, 1e-12);
  if (rollouts->lanes() > 1) {
    EXPECT_EQ(results[1].failed, "the score is not a finite number");
  }
}

TEST(Commands, AnActuatorHoldsWhereItIs) {
  ExperimentSpec experiment = LoadShipped("push_20n");
  experiment.duration_s = 0.4;
  struct Freeze final : Controller {
    ClockSpec clock() const override { return {0.001, 0.2}; }
    void Act(const Tick&, const Observation&, Commands& commands) override {
      commands.mode[0] = CommandMode::kHold;
      commands.mode[1] = CommandMode::kOff;
    }
  };
  Extensions extensions;
  extensions.controllers = {[](const ControlSetup&) { return std::make_unique<Freeze>(); }};
  experiment.pushes[0].force_n = {{0.2, 0.0}, {0.25, 20.0}, {0.4, 20.0}};
  Diagnostics out;
  const auto run = LiveRun::Start(experiment, out, {}, extensions);
  ASSERT_TRUE(run) << out.Format();
  const auto rest_m = [&](int cable) { return run->Observe().Cable(cable).rest_length_m; };
  while (run->time_s() < 0.2 + 1e-9) ASSERT_TRUE(run->Step());
  // A motor that was winding needs time to slow down.
  while (run->time_s() < 0.25) ASSERT_TRUE(run->Step());
  const double held_m = rest_m(0), off_m = rest_m(1), driven_m = rest_m(2);
  while (run->time_s() < 0.4) ASSERT_TRUE(run->Step());
  EXPECT_NEAR(rest_m(0), held_m, 1e-12);
  EXPECT_NEAR(rest_m(1), off_m, 1e-12);
  EXPECT_GT(std::fabs(rest_m(2) - driven_m), 1e-5);
}

TEST(Replay, ControllersSayToALogWhatTheySaidToTheRobot) {
  ExperimentSpec experiment = LoadShipped("cpg_learned");
  experiment.duration_s = 1.5;
  experiment.record.rate_hz = 0;  // every step
  experiment.record.channels.clear();
  const Trace log = Recording(experiment).trace;
  Diagnostics out;
  const auto plant = ReplayOf(log, experiment.robot, out);
  ASSERT_TRUE(plant) << out.Format();
  EXPECT_EQ(plant->world(), nullptr);
  EXPECT_NE(plant->Observe().bodies, nullptr);
  experiment.duration_s = 10.0;  // the recording ends before
  const Trace said = Recording(experiment, plant.get()).trace;
  EXPECT_EQ(said.time_s, log.time_s);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < said.channels.size(); ++i) {
    const auto in_log = log.Find(said.channels[i].name);
    ASSERT_TRUE(in_log) << said.channels[i].name;
    EXPECT_EQ(said.values[i], log.values[*in_log]) << said.channels[i].name;
    compared += said.channels[i].name.find("target") != std::string::npos;
  }
  EXPECT_EQ(compared, experiment.robot.def.cables.size());
  EXPECT_FALSE(said.Find("system/kinetic_j"));
}

TEST(Replay, WhatALogLacksIsAFault) {
  const ExperimentSpec experiment = LoadShipped("stand_still");
  const std::string cable = experiment.robot.def.cables[1].name;
  Trace log;
  log.channels = {{"cable/" + cable + "/tension_n", "N"}};
  log.time_s = {5.0, 5.1, 5.2};
  log.values = {{10.0, std::nan(""), 12.0}};
  Diagnostics out;
  const auto plant = ReplayOf(log, experiment.robot, out);
  ASSERT_TRUE(plant) << out.Format();
  EXPECT_EQ(plant->Observe().bodies, nullptr);
  const auto to = [&](double time_s) {
    const double step_s = 0.1;
    plant->Advance(&step_s, &time_s);
    return plant->Observe().Cable(1).tension_n;
  };
  EXPECT_EQ(to(0.05), 10.0);
  EXPECT_EQ(to(0.1), 10.0);  // the row has no value: the last one is kept
  EXPECT_TRUE(plant->IsRunning(0));
  EXPECT_EQ(to(0.2), 12.0);
  EXPECT_FALSE(plant->IsRunning(0));
  EXPECT_EQ(plant->Observe().faults[0], kFaultNoReading);
  log.channels[0].name = "cable/nobody/tension_n";
  EXPECT_EQ(ReplayOf(log, experiment.robot, out), nullptr);
  EXPECT_EQ(out.items().size(), 1u);
}

}  // namespace
}  // namespace taut::test
