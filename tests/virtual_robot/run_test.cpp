// Experiments on emulated boards: `taut_virtual_robot --run`
#include "apps/virtual_robot/run_experiment.h"

#include <gtest/gtest.h>

#include "taut/run.h"

namespace taut::virtual_robot {
namespace {

ExperimentSpec Push(double duration_s) {
  Diagnostics found;
  auto experiment =
      LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/push_20n_motors.yaml", {}, found);
  EXPECT_TRUE(experiment.has_value()) << found.Format();
  experiment->duration_s = duration_s;
  return *experiment;
}

BoardsOptions Options() {
  Diagnostics found;
  BoardsOptions options;
  options.robot.program = ReadAvrProgram(TAUT_FIRMWARE_ELF, found);
  EXPECT_TRUE(found.ok()) << found.Format();
  return options;
}

struct RunDone {
  RunSummary summary;
  link::State heard;
  std::int64_t bad_frames = 0;
  std::vector<double> tensions_n;
};

RunDone RunPush(double duration_s, const BoardsOptions& options) {
  const ExperimentSpec experiment = Push(duration_s);
  Diagnostics found;
  const auto motors = MotorPlant::Make(experiment.robot, found);
  BoardsPlant plant(experiment, *motors, options);
  EXPECT_TRUE(plant.Prepare(found)) << found.Format();
  RunOptions how;
  how.plant = &plant;
  const auto summary = RunExperiment(experiment, how, found);
  EXPECT_TRUE(summary.has_value()) << found.Format();
  RunDone done{*summary, plant.heard(), plant.bad_frames(), {}};
  for (int m = 0; m < motors->motor_count(); ++m)
    done.tensions_n.push_back(motors->LoadCellForce(m));
  return done;
}

TEST(RunOnBoards, HoldsTheSpineAsTheSimulationDoes) {
  const RunDone boards = RunPush(3.0, Options());
  EXPECT_EQ(boards.bad_frames, 0);
  EXPECT_EQ(boards.heard.link.late_cycles, 0);
  for (const link::BoardView& heard : boards.heard.boards) {
    EXPECT_EQ(heard.status.mode, board::Mode::kImpedance);
    EXPECT_FALSE(heard.status.faulty);
    EXPECT_FALSE(heard.status.overrun);
  }
  Diagnostics found;
  const auto simulated = RunExperiment(Push(3.0), {}, found);
  ASSERT_TRUE(simulated.has_value());
  EXPECT_NEAR(boards.summary.system_max_tension_n, simulated->system_max_tension_n,
              0.02 * simulated->system_max_tension_n);
  EXPECT_NEAR(boards.tensions_n[5], 32.3, 1.0) << "inner_top_1";
}

/// The key `boards` runs the same firmware natively. Tolerance: noise of the load cells, and ticks
/// of the emulated boards that are not synchronous with the physics.
TEST(RunOnBoards, TheBoardsOfAnExperimentDoTheSame) {
  const RunDone boards = RunPush(1.5, Options());
  ExperimentSpec experiment = Push(1.5);
  ControllerSpec& native = experiment.controllers.emplace_back();
  native.name = "boards";
  native.clock = {0.001, 0.0};
  native.boards.emplace();
  Diagnostics found;
  const auto simulated = RunExperiment(experiment, {}, found);
  ASSERT_TRUE(simulated.has_value()) << found.Format();
  ASSERT_EQ(simulated->cables.size(), boards.summary.cables.size());
  for (std::size_t c = 0; c < simulated->cables.size(); ++c) {
    const CableSummary &a = boards.summary.cables[c], &b = simulated->cables[c];
    EXPECT_NEAR(a.tension.max_n, b.tension.max_n, 0.1) << a.name;
  }
  EXPECT_EQ(simulated->status_text, "");
}

TEST(RunOnBoards, TwoRunsAreTheSameAndNoiseIsAnother) {
  BoardsOptions options = Options();
  const RunDone first = RunPush(0.3, options), second = RunPush(0.3, options);
  EXPECT_EQ(first.summary.state_hash, second.summary.state_hash);
  options.robot.seed = 2;
  EXPECT_NE(RunPush(0.3, options).summary.state_hash, first.summary.state_hash);
}

TEST(RunOnBoards, ParametersReachTheBoards) {
  BoardsOptions options = Options();
  options.settings.push_back({true, board::kDutyLimit, 0.0f});
  for (const link::BoardView& heard : RunPush(0.3, options).heard.boards) {
    EXPECT_EQ(heard.status.motors[0].duty, 0);
    EXPECT_EQ(heard.status.motors[1].duty, 0);
  }
}

TEST(RunOnBoards, WhatThePcBelievesOfACellIsWhatItHears) {
  BoardsOptions options = Options();
  CableCalibration cell{"inner_top_1", "2026-01-01", "believed"};
  cell.load_cell_n_per_count = 0.1567 * 0.9;
  options.calibration = Calibration{"believed", "", {cell}};
  const RunDone done = RunPush(0.3, options);
  const auto heard_n = [&](std::size_t m) { return done.heard.motors[m].tension_n; };
  ASSERT_GT(done.tensions_n[5], 10.0);
  // A count is 0.16 N, its noise 0.11 N before the filter.
  EXPECT_NEAR(heard_n(5), 0.9 * done.tensions_n[5], 0.4) << "inner_top_1";
  EXPECT_NEAR(heard_n(4), done.tensions_n[4], 0.4) << "inner_left_1 is believed to be what it is";
  // Parameters of --board are applied last.
  options.settings.push_back({true, board::kNewtonsPerCount, 0.1567f * 0.8f});
  const RunDone all = RunPush(0.3, options);
  EXPECT_NEAR(all.heard.motors[5].tension_n, 0.8 * all.tensions_n[5], 0.4);
}

}  // namespace
}  // namespace taut::virtual_robot
