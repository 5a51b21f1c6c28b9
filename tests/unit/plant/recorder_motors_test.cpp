// Recording and summary of motors, and effects of commands on them
#include <cmath>

#include "unit/plant/recorder_fixture.h"

namespace taut::test {
namespace {

ModelDef Crane() { return CraneOf(2, 5000, 20); }

TEST(RecordedMotor, ShowsWhatItDraws) {
  const Recording run(RecordedExperiment(Crane(), 0.5, {}));
  // The weight drives it back until the servo's duty holds the weight.
  EXPECT_GT(run.Last("cable/rope/duty"), 0.01);
  EXPECT_GT(run.Last("cable/rope/current_a"), 0);
  EXPECT_EQ(run.Last("cable/rope/supply_voltage_v"), 12);
  EXPECT_LT(run.Last("cable/rope/rotor_angle_rad"), 0);
  EXPECT_EQ(run.Last("cable/rope/rotor_speed_rad_per_s"), 0);
  EXPECT_GT(run.Last("cable/rope/winding_temperature_c"), 22);
  EXPECT_LT(run.Last("cable/rope/energy_to_cable_j"), 0);
  double from_supply_j = 0;
  for (std::size_t row = 1; row < run.rows(); ++row) {
    from_supply_j += 1e-3 * run.At("cable/rope/duty", row) * run.At("cable/rope/current_a", row) *
                     run.At("cable/rope/supply_voltage_v", row);
  }
  EXPECT_NEAR(run.Last("cable/rope/energy_from_supply_j"), from_supply_j, 1e-9);
  ASSERT_TRUE(run.summary.cables[0].motor);
  const MotorSummary& motor = *run.summary.cables[0].motor;
  EXPECT_EQ(motor.energy_from_supply_j, run.Last("cable/rope/energy_from_supply_j"));
  EXPECT_EQ(motor.energy_to_cable_j, run.Last("cable/rope/energy_to_cable_j"));
  EXPECT_EQ(motor.max_winding_temperature_c, run.Last("cable/rope/winding_temperature_c"));
  EXPECT_GE(motor.max_current_a, run.Last("cable/rope/current_a"));
}

TEST(RecordedMotor, IsThereForMotorsOnly) {
  ModelDef def = Crane();
  def.cables[0].actuator = {};
  const Recording run(RecordedExperiment(def, 0.01, {}));
  EXPECT_FALSE(run.Has("cable/rope/duty"));
  EXPECT_FALSE(run.summary.cables[0].motor);
}

TEST(RecordedMotor, SensorsOfCountsShowThem) {
  ExperimentSpec experiment = RecordedExperiment(Crane(), 0.1, {"sensor/*", "cable/rope/*"});
  experiment.sensors.emplace();
  experiment.sensors->load_cell.emplace().counts.emplace();
  experiment.sensors->encoder = EncoderSpec{1e-5};
  const Recording run(experiment);
  const std::size_t row = run.rows() - 1;
  const double seen = run.At("sensor/rope/tension_n", row);
  EXPECT_EQ(0.1567 * run.At("sensor/rope/tension_count", row) - 4.9363, seen);
  EXPECT_NEAR(1e-5 * run.At("sensor/rope/encoder_count", row),
              run.At("sensor/rope/rest_length_m", row), 1e-12);
  EXPECT_LT(std::fabs(run.At("cable/rope/tension_n", row) - seen), 1.0);
  EXPECT_NE(run.At("cable/rope/tension_n", row), seen);
}

/// Commands motor modes, each from a given time.
class Switch final : public Controller {
 public:
  explicit Switch(std::vector<std::pair<double, CommandMode>> when) : when_(std::move(when)) {}
  ClockSpec clock() const override { return {0.001, 0.0}; }
  void Act(const Tick&, const Observation& seen, Commands& commands) override {
    for (const auto& [time_s, mode] : when_) {
      if (*seen.time_s >= time_s) *commands.mode = mode;
    }
  }

 private:
  std::vector<std::pair<double, CommandMode>> when_;
};

TEST(CommandedMotor, GoesOffAndOn) {
  Diagnostics out;
  ExperimentSpec experiment = RecordedExperiment(Crane(), 1, {});
  experiment.step_s = 1e-3;
  WorldBatch batch(Model::Compile(experiment.robot.def, out), {});
  const auto plant = PlantOf(batch);
  RunOptions options;
  options.plant = plant.get();
  options.extensions.controllers.push_back([](const ControlSetup&) {
    return std::make_unique<Switch>(std::vector<std::pair<double, CommandMode>>{
        {0.0, CommandMode::kOff}, {0.3, CommandMode::kRestLength}});
  });
  experiment.duration_s = 0.3;
  ASSERT_TRUE(RunExperiment(experiment, options, out)) << out.Format();
  EXPECT_EQ(batch.Motor(0, 0).mode, MotorMode::kOff);
  EXPECT_EQ(batch.Motor(0, 0).current_a, 0);
  const double sunk_m = batch.Cable(0, 0).rest_length_m;
  EXPECT_GT(sunk_m, 1.0);  // friction cannot hold the weight
  double time_s = 0.3;
  plant->commands().mode[0] = CommandMode::kRestLength;
  for (int i = 0; i < 2000; ++i) {
    const double step_s = 1e-3;
    time_s += step_s;
    plant->Advance(&step_s, &time_s);
  }
  EXPECT_EQ(batch.Motor(0, 0).mode, MotorMode::kServo);
  // The target followed the motor, so that there is no jerk: the weight is held where it was.
  EXPECT_NEAR(batch.Cable(0, 0).rest_length_m, sunk_m, 3e-3);
}

}  // namespace
}  // namespace taut::test
