// A robot as a plant: readings for controllers, the effect of their commands, and the settings of
// an experiment for the boards.
#include "taut/link/robot_plant.h"

#include "link/fake_robot.h"

namespace taut::link {
namespace {

using board::Mode;

ExperimentSpec Load(const std::string& name) {
  Diagnostics found;
  auto experiment =
      LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/" + name + ".yaml", {}, found);
  EXPECT_TRUE(experiment.has_value()) << found.Format();
  return *experiment;
}
const ExperimentSpec& Push() {
  static const ExperimentSpec experiment = Load("push_20n_motors");
  return experiment;
}
const ExperimentSpec& Sway() {
  static const ExperimentSpec experiment = Load("rest_length_sine");
  return experiment;
}

/// Returns the value of this motor and parameter among settings; NaN: none.
double Of(const std::vector<Setting>& settings, int motor, int parameter) {
  for (const Setting& setting : settings) {
    if (setting.place.board == motor / 2 && setting.place.index == motor % 2 &&
        setting.place.parameter == parameter) {
      return double{setting.value};
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

struct PlantRig : Rig {
  explicit PlantRig(const ExperimentSpec& experiment) : plant(experiment, *driver) {
    std::vector<Setting> settings = SettingsFor(experiment.robot, 16);
    const std::vector<Setting> gains = GainsFor(experiment);
    settings.insert(settings.end(), gains.begin(), gains.end());
    EXPECT_TRUE(Configure(settings)) << out.Format();
    cables = MotorCables(experiment.robot, out);
    for (int m = 0; m < 12; ++m) {
      const auto c = static_cast<std::size_t>(cables[static_cast<std::size_t>(m)]);
      EXPECT_TRUE(driver->SetReference(m, experiment.robot.def.cables[c].rest_length_m, out));
    }
    driver->ClearFaults();
    driver->Cycle(2);
  }
  void Advance(double to_s) {
    const double step_s = to_s - plant.Observe().time_s[0];
    plant.Advance(&step_s, &to_s);
  }
  std::size_t Row(int motor) const {
    return static_cast<std::size_t>(cables[static_cast<std::size_t>(motor)]);
  }
  RobotPlant plant;
  std::vector<int> cables;
};

TEST(SettingsFor, AModelAreGearSpoolAndSpring) {
  const std::vector<Setting> settings = SettingsFor(Push().robot, 16);
  const CableDef& first = Push().robot.def.cables[static_cast<std::size_t>(
      MotorCables(Push().robot, *std::make_unique<Diagnostics>())[0])];
  EXPECT_NEAR(Of(settings, 0, board::kStiffness), first.stiffness_n_per_m, 1e-4);
  EXPECT_NEAR(Of(settings, 0, board::kReferenceLength), first.rest_length_m, 1e-7);
  // 7 cm/s at 9800 turns a minute, of 32 states each.
  EXPECT_NEAR(Of(settings, 7, board::kLengthPerCount), 0.07 / (9800.0 / 60) / 32, 1e-9);
  const DcMotorDef& motor = *first.actuator.dc_motor;
  EXPECT_NEAR(Of(settings, 7, board::kSpeedLimit),
              1.3 * motor.spool_radius_m / motor.gear_ratio * 12 / motor.torque_constant_n_m_per_a,
              1e-6);
  EXPECT_NEAR(Of(SettingsFor(Push().robot, 32), 7, board::kLengthPerCount),
              0.07 / (9800.0 / 60) / 64, 1e-9);
}

TEST(GainsFor, AnExperimentAreThoseOfItsImpedanceControl) {
  const std::vector<Setting> gains = GainsFor(Push());
  EXPECT_EQ(gains.size(), 48u);
  const std::vector<std::string> names = MotorNames(Push().robot);
  const auto motor =
      static_cast<int>(std::find(names.begin(), names.end(), "inner_top_1") - names.begin());
  EXPECT_EQ(Of(gains, motor, board::kTensionOffset), 28);
  EXPECT_NEAR(Of(gains, motor, board::kLengthOffset), 0.190, 1e-7);
  EXPECT_EQ(Of(gains, motor, board::kPositionGain), 500);
  EXPECT_EQ(Of(gains, motor, board::kVelocityGain), 150);
  EXPECT_TRUE(GainsFor(Sway()).empty());
}

TEST(SettingsFor, ACalibrationAreWhatWasMeasured) {
  const std::vector<std::string> names = MotorNames(Push().robot);
  Calibration calibration;
  calibration.cables = {{names[5], "2026-11-23", "", 0.16, {}, {}, 0.21, {}},
                        {names[8], "2026-11-23", "", {}, 30.0, 1.3e-5, {}, 230.0}};
  const std::vector<Setting> settings = SettingsFor(calibration, Push().robot);
  EXPECT_EQ(settings.size(), 5u);
  EXPECT_NEAR(Of(settings, 5, board::kNewtonsPerCount), 0.16, 1e-7);
  EXPECT_NEAR(Of(settings, 5, board::kReferenceLength), 0.21, 1e-7);
  EXPECT_EQ(Of(settings, 8, board::kCountsAtZero), 30);
  EXPECT_NEAR(Of(settings, 8, board::kLengthPerCount), 1.3e-5, 1e-11);
  EXPECT_EQ(Of(settings, 8, board::kStiffness), 230);
}

TEST(ModeFor, IsOneForAllMotors) {
  Diagnostics out;
  EXPECT_EQ(ModeFor(Push(), out), Mode::kImpedance);
  EXPECT_EQ(ModeFor(Sway(), out), Mode::kPosition);
  EXPECT_TRUE(out.ok());
  ExperimentSpec mixed = Push();
  mixed.controllers[0].impedance->cables.pop_back();
  EXPECT_FALSE(ModeFor(mixed, out));
  EXPECT_NE(out.Format().find("impedance control is missing for "), std::string::npos)
      << out.Format();
  PlantRig rig(mixed);
  rig.out = {};
  EXPECT_FALSE(rig.plant.Hold(rig.out));
  EXPECT_FALSE(rig.robot.AnyPower());
}

TEST(MotorCables, AreOneToTwelve) {
  Diagnostics out;
  EXPECT_EQ(MotorCables(Push().robot, out).size(), 12u);
  EXPECT_EQ(MotorNames(Push().robot).size(), 12u);
  RobotSpec robot = Push().robot;
  robot.def.cables.push_back(robot.def.cables.front());
  EXPECT_TRUE(MotorCables(robot, out).empty());
  EXPECT_NE(out.Format().find("13 cables have an actuator"), std::string::npos) << out.Format();
  for (CableDef& cable : robot.def.cables) cable.actuator = {};
  EXPECT_TRUE(MotorCables(robot, out).empty());
  EXPECT_NE(out.Format().find("no cable has an actuator"), std::string::npos) << out.Format();
}

TEST(RobotPlant, ShowsWhatBoardsSense) {
  PlantRig rig(Push());
  ASSERT_TRUE(rig.plant.Hold(rig.out)) << rig.out.Format();
  rig.plant.Begin();
  rig.Advance(0.05);
  for (int m = 0; m < 12; ++m) {
    const CableState cable = rig.plant.Observe().Cable(static_cast<int>(rig.Row(m)));
    const MotorView& motor = rig.state().motors[static_cast<std::size_t>(m)];
    EXPECT_EQ(cable.tension_n, motor.tension_n) << m;
    EXPECT_EQ(cable.rest_length_m, motor.rest_length_m) << m;
    EXPECT_EQ(cable.length_m, motor.length_m) << m;
    EXPECT_EQ(rig.plant.Observe().faults[rig.Row(m)], kFaultNone) << m;
    EXPECT_NEAR(rig.plant.commands().set_point_n[rig.Row(m)], motor.set_point_n, 1e-9) << m;
  }
  EXPECT_EQ(rig.plant.Observe().time_s[0], 0.05);
  EXPECT_TRUE(rig.plant.IsRunning(0));
}

TEST(RobotPlant, RatesAreOfRestLengths) {
  PlantRig rig(Sway());
  ASSERT_TRUE(rig.plant.Hold(rig.out)) << rig.out.Format();
  rig.plant.Begin();
  double to_s = 0;
  for (int i = 0; i < 100; ++i) {
    rig.plant.commands().rest_length_m[rig.Row(3)] += 0.02 * 0.01;
    rig.Advance(to_s += 0.01);
  }
  EXPECT_NEAR(rig.plant.Observe().Cable(static_cast<int>(rig.Row(3))).rate_m_per_s, 0.02, 0.004);
}

TEST(RobotPlant, CommandsPositions) {
  PlantRig rig(Sway());
  ASSERT_TRUE(rig.plant.Hold(rig.out)) << rig.out.Format();
  rig.plant.Begin();
  const double before_m = rig.state().motors[4].rest_length_m;
  for (int m = 0; m < 12; ++m) {
    rig.plant.commands().rest_length_m[rig.Row(m)] =
        rig.state().motors[static_cast<std::size_t>(m)].rest_length_m;
  }
  rig.plant.commands().rest_length_m[rig.Row(4)] -= 0.01;
  rig.Advance(0.8);
  rig.ExpectAll(Mode::kPosition);
  EXPECT_NEAR(rig.state().motors[4].rest_length_m, before_m - 0.01, 3e-4);
}

TEST(RobotPlant, CommandsVelocitiesOfImpedanceControl) {
  PlantRig rig(Push());
  ASSERT_TRUE(rig.plant.Hold(rig.out)) << rig.out.Format();
  rig.plant.Begin();
  rig.Advance(0.02);
  rig.plant.commands().velocity_input_m_per_s[rig.Row(9)] = 0.03;
  rig.Advance(0.05);
  rig.ExpectAll(Mode::kImpedance);
  EXPECT_EQ(rig.robot.Broadcasts().back().values[9], 1500);
  EXPECT_EQ(rig.robot.Broadcasts().back().values[8], 0);
}

TEST(RobotPlant, SaysWhatIsWrongWithACable) {
  PlantRig rig(Push());
  ASSERT_TRUE(rig.plant.Hold(rig.out)) << rig.out.Format();
  rig.plant.Begin();
  rig.Advance(0.05);
  rig.board(0).core.faults[0] = board::kSensor;
  rig.board(1).core.faults[1] = board::kStall;
  rig.board(2).core.board_faults = board::kBusStuck;
  rig.Advance(0.15);
  const std::uint32_t* const faults = rig.plant.Observe().faults;
  EXPECT_EQ(faults[rig.Row(0)], kFaultSensor);
  EXPECT_EQ(faults[rig.Row(1)], kFaultNone);
  EXPECT_EQ(faults[rig.Row(3)], kFaultActuator);
  EXPECT_EQ(faults[rig.Row(4)], kFaultActuator);
  EXPECT_EQ(faults[rig.Row(5)], kFaultActuator);
  EXPECT_TRUE(rig.plant.IsRunning(0)) << "motors hold";
  rig.board(4).there = false;
  rig.Advance(0.25);
  EXPECT_EQ(rig.plant.Observe().faults[rig.Row(8)], kFaultNoReading);
  EXPECT_EQ(rig.plant.Observe().faults[rig.Row(10)], kFaultNone);
  EXPECT_FALSE(rig.plant.IsRunning(0)) << "all were stopped";
}

TEST(RobotPlant, WithoutAnAdapterHasNoReadings) {
  PlantRig rig(Push());
  ASSERT_TRUE(rig.plant.Hold(rig.out)) << rig.out.Format();
  rig.plant.Begin();
  rig.Advance(0.05);
  rig.robot.gone = true;
  rig.Advance(0.3);
  EXPECT_EQ(rig.plant.Observe().time_s[0], 0.3) << "time goes on";
  for (int m = 0; m < 12; ++m) {
    EXPECT_EQ(rig.plant.Observe().faults[rig.Row(m)], kFaultNoReading) << m;
  }
  rig.robot.gone = false;
  rig.Advance(0.9);
  EXPECT_EQ(rig.plant.Observe().faults[rig.Row(0)], kFaultNone);
}

}  // namespace
}  // namespace taut::link
