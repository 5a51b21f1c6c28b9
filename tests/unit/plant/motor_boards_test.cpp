// Motor boards of an experiment: firmware in simulations, its readings, modes and faults
#include <cmath>
#include <numbers>

#include "description/robot/board_settings.h"
#include "taut/study.h"
#include "tests/unit/plant/simulation_fixture.h"
#include "unit/plant/recorder_fixture.h"

namespace taut::test {
namespace {

ControllerSpec Boards(const BoardsSpec& boards) {
  ControllerSpec controller;
  controller.name = "boards";
  controller.clock = {0.001, 0.0};
  controller.boards = boards;
  return controller;
}

/// The push on boards.
ExperimentSpec PushOnBoards(double duration_s, const BoardsSpec& boards = {}) {
  ExperimentSpec experiment = Load("push_20n_motors", duration_s);
  experiment.controllers.push_back(Boards(boards));
  return experiment;
}

/// A weight of 1 kg on a rope of 1 m with a motor.
ExperimentSpec Crane(double duration_s, const BoardsSpec& boards) {
  ExperimentSpec experiment =
      RecordedExperiment(CraneOf(1, 2000, 10), duration_s, {"cable/*", "sensor/*"});
  experiment.controllers.push_back(Boards(boards));
  return experiment;
}

/// Adds impedance control of the rope, without a stiffness.
void AddImpedance(double tension_n, double velocity_m_per_s, ExperimentSpec& experiment) {
  ControllerSpec law;
  law.name = "law";
  law.impedance.emplace().cables = {{0, tension_n, 1.0, 0.0, 100.0, velocity_m_per_s}};
  experiment.controllers.insert(experiment.controllers.begin(), law);
}

TEST(BoardsSpec, HasTheDefaultsOfTheFirmware) {
  for (const auto& [parameter, value] : description::CommonMotorSettings({})) {
    const float usual = board::MotorRange(parameter).value;
    EXPECT_NEAR(static_cast<float>(value), usual, 1e-3 * std::fabs(usual)) << int{parameter};
  }
  for (const auto& [parameter, value] : description::CommonBoardSettings({})) {
    EXPECT_EQ(static_cast<float>(value), board::BoardRange(parameter).value) << int{parameter};
  }
}

/// The limits of the keys are those of the firmware, so that boards accept all values of a file.
TEST(BoardsSpec, StudiesVaryItWithinTheLimitsOfTheFirmware) {
  ExperimentSpec experiment = PushOnBoards(1);
  std::vector<ScaleSpec> none;
  int found = 0;
  for (const Tunable& tunable : FindTunables(experiment.controllers, none, experiment.robot)) {
    if (tunable.name.rfind("boards.", 0) != 0) continue;
    const std::string key = tunable.name.substr(7);
    for (std::uint8_t i = 0; i < board::kMotorParameters; ++i) {
      const board::Range range = board::MotorRange(i);
      const bool same = [&] {
#define TAUT_SAME(name, text, value, least, greatest) \
  if (i == board::name) return key == text;
        TAUT_MOTOR_PARAMETERS(TAUT_SAME)
#undef TAUT_SAME
        return false;
      }();
      if (!same) continue;
      ++found;
      EXPECT_EQ(static_cast<float>(tunable.min), range.least) << key;
      EXPECT_EQ(static_cast<float>(tunable.max), range.greatest) << key;
    }
  }
  EXPECT_EQ(found, 12);
}

/// A hanging weight does not move by more than the servo's error: the integral removes it.
TEST(MotorBoards, HoldAWeight) {
  BoardsSpec boards;
  boards.hold_s = 10;
  boards.load_cell.noise_counts = 0;
  const ExperimentSpec experiment = Crane(2, boards);
  const Recording run(experiment);
  const double m_per_count = description::LengthPerCount(
      *experiment.robot.def.cables[0].actuator.dc_motor, boards.encoder_lines);
  EXPECT_NEAR(run.Last("cable/rope/rest_length_m"), 1 - 9.81 / 2000, 1.5 * m_per_count);
  EXPECT_GT(run.Last("cable/rope/duty"), 0.01);
  // The readings are those of the status frames: quarters of a count, whole encoder counts.
  const double tension_n = run.Last("sensor/rope/tension_n");
  EXPECT_NEAR(tension_n, 9.81, 0.1567);
  const double quarters = (tension_n + 4.9363) / (0.1567 / 4);
  EXPECT_NEAR(quarters, std::round(quarters), 0.01);
  EXPECT_EQ(run.summary.status_text, "");
}

/// Impedance control without a stiffness controls the tension. A weight rises or falls until its
/// speed makes the set point, T0 + B (V - V0), equal to the weight.
TEST(MotorBoards, ControlTheTensionOfARisingWeight) {
  ExperimentSpec experiment = Crane(4, {});  // with noise: a constant reading would be a fault
  AddImpedance(9.81 + 2, 0.0, experiment);
  const Recording run(experiment);
  // (T0 - weight) / B = 0.02 m/s upward.
  EXPECT_NEAR(run.Last("cable/rope/length_m") - run.At("cable/rope/length_m", 2000), -0.04, 0.001);
  EXPECT_NEAR(run.Last("cable/rope/setpoint_n"), 9.81, 0.2);
  EXPECT_EQ(run.summary.status_text, "");
}

TEST(MotorBoards, ScaleTheVelocityInput) {
  BoardsSpec boards;
  boards.load_cell.noise_counts = 0;
  boards.velocity_input_scale = 0.5;
  ExperimentSpec experiment = Crane(4, boards);
  AddImpedance(9.81, 0.04, experiment);  // lengthens by 0.04 m/s, half of it on the board
  const Recording run(experiment);
  EXPECT_NEAR(run.Last("cable/rope/rate_m_per_s"), 0.02, 0.002);
}

/// After the capture, the set point is the tension at that time, not that of the file.
TEST(MotorBoards, CaptureTensionAndLength) {
  BoardsSpec boards;
  boards.load_cell.noise_counts = 0;
  boards.hold_s = 0.5;
  boards.capture = true;
  ExperimentSpec experiment = Crane(2, boards);
  AddImpedance(20, 0.0, experiment);
  const Recording run(experiment);
  EXPECT_EQ(run.At("cable/rope/setpoint_n", 450), 0) << "holds";
  EXPECT_NEAR(run.Last("cable/rope/setpoint_n"), 9.81, 0.1567);
  EXPECT_NEAR(run.Last("cable/rope/rest_length_m"), 1 - 9.81 / 2000, 0.01);
}

TEST(MotorBoards, ReportTheFirstFault) {
  BoardsSpec boards;
  boards.tension_limit_n = 5;
  boards.tension_band_n = 1;
  const Recording run(Crane(0.5, boards));
  EXPECT_EQ(run.summary.status_text,
            "the board of rope reported a fault: over_tension at 0.004 s; then all motors held");
  EXPECT_GT(run.Last("cable/rope/rest_length_m"), 1.0) << "unwinds";
}

TEST(MotorBoards, HaveTheSameBitsInEveryLane) {
  const ExperimentSpec experiment = PushOnBoards(0.5);
  const auto variants = Variants(experiment, 5);
  const auto together = Create(experiment, {.variants = variants});
  together->RunUntil(0.5);
  for (int w = 0; w < 5; ++w) {
    const std::vector<RolloutWorld> one{variants[static_cast<std::size_t>(w)]};
    const auto alone = Create(experiment, {.variants = one, .simd = Simd::kScalar});
    alone->RunUntil(0.5);
    EXPECT_EQ(alone->Hash(), together->Hash(w)) << w;
  }
}

TEST(MotorBoards, ContinueFromASnapshot) {
  BoardsSpec boards;
  boards.hold_s = 0.2;
  boards.capture = true;
  const ExperimentSpec experiment = PushOnBoards(1.0, boards);
  const auto variants = Variants(experiment, 3);
  const auto simulation = Create(experiment, {.variants = variants});
  simulation->RunUntil(0.4037);
  const auto saved = simulation->Save(2);
  simulation->RunUntil(0.9);
  const auto other = Create(experiment, {.variants = variants, .simd = Simd::kScalar});
  other->RunUntil(0.1);
  Diagnostics out;
  ASSERT_TRUE(other->Restore(saved, out, 0)) << out.Format();
  other->RunUntil(0.9);
  EXPECT_EQ(other->Hash(0), simulation->Hash(2));
}

}  // namespace
}  // namespace taut::test
