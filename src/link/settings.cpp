// Settings of the boards from an experiment and its model.
#include <numbers>

#include "taut/link/robot_plant.h"

namespace taut::link {
namespace {

using board::Mode;

const ImpedanceGains* GainsOf(const ExperimentSpec& experiment, int cable) {
  for (const ControllerSpec& controller : experiment.controllers) {
    if (!controller.impedance) continue;
    for (const ImpedanceGains& gains : controller.impedance->cables) {
      if (gains.cable == cable) return &gains;
    }
  }
  return nullptr;
}

Setting Of(std::size_t motor, board::MotorParameter parameter, double value) {
  return {PlaceOf(static_cast<int>(motor), parameter), static_cast<float>(value)};
}

std::vector<int> CablesOf(const RobotSpec& robot) {
  std::vector<int> cables;
  for (std::size_t c = 0; c < robot.def.cables.size(); ++c) {
    if (robot.def.cables[c].actuator.kind != ActuatorDef::Kind::kNone) {
      cables.push_back(static_cast<int>(c));
    }
  }
  return cables;
}

const CableDef& CableAt(const RobotSpec& robot, int cable) {
  return robot.def.cables[static_cast<std::size_t>(cable)];
}

}  // namespace

std::vector<std::string> MotorNames(const RobotSpec& robot) {
  std::vector<std::string> names;
  for (const int cable : CablesOf(robot)) names.push_back(CableAt(robot, cable).name);
  return names;
}

std::vector<int> MotorCables(const RobotSpec& robot, Diagnostics& out) {
  std::vector<int> cables = CablesOf(robot);
  const SourceRef file{robot.files.empty() ? "model" : robot.files.front()};
  if (cables.empty()) {
    out.Error("robot.no_actuators", file, "no cable has an actuator",
              "a robot needs 1 to 12 actuators");
  } else if (cables.size() > board::kCables) {
    out.Error("robot.too_many_actuators", file,
              std::to_string(cables.size()) + " cables have an actuator",
              "six boards drive 12 at most");
  } else {
    return cables;
  }
  return {};
}

std::optional<Mode> ModeFor(const ExperimentSpec& experiment, Diagnostics& out) {
  const std::vector<int> cables = CablesOf(experiment.robot);
  std::vector<std::string> with, without;
  for (const int cable : cables) {
    (GainsOf(experiment, cable) != nullptr ? with : without)
        .push_back(CableAt(experiment.robot, cable).name);
  }
  if (with.empty()) return Mode::kPosition;
  if (without.empty()) return Mode::kImpedance;
  std::string names;
  for (const std::string& name : without) names += (names.empty() ? "" : ", ") + name;
  const SourceRef file{experiment.files.empty() ? "experiment" : experiment.files.front()};
  out.Error("robot.no_impedance_control", file, "impedance control is missing for cables " + names,
            "use it for all cables with actuators, or for none");
  return std::nullopt;
}

std::vector<Setting> SettingsFor(const RobotSpec& robot, int encoder_lines) {
  std::vector<Setting> settings;
  const std::vector<int> cables = CablesOf(robot);
  const double counts_per_rad = 2 * encoder_lines / (2 * std::numbers::pi);
  for (std::size_t motor = 0; motor < cables.size(); ++motor) {
    const CableDef& cable = CableAt(robot, cables[motor]);
    settings.push_back(Of(motor, board::kReferenceLength, cable.rest_length_m));
    settings.push_back(Of(motor, board::kStiffness, cable.stiffness_n_per_m));
    if (!cable.actuator.dc_motor) continue;
    const DcMotorDef& figures = *cable.actuator.dc_motor;
    const double per_rotor_m = figures.spool_radius_m / figures.gear_ratio;
    const double free_m_per_s =
        per_rotor_m * figures.supply_voltage_v / figures.torque_constant_n_m_per_a;
    settings.push_back(Of(motor, board::kLengthPerCount, per_rotor_m / counts_per_rad));
    settings.push_back(Of(motor, board::kSpeedLimit, 1.3 * free_m_per_s));
  }
  return settings;
}

std::vector<Setting> GainsFor(const ExperimentSpec& experiment) {
  std::vector<Setting> settings;
  const std::vector<int> cables = CablesOf(experiment.robot);
  for (std::size_t motor = 0; motor < cables.size(); ++motor) {
    const ImpedanceGains* const gains = GainsOf(experiment, cables[motor]);
    if (gains == nullptr) continue;
    settings.push_back(Of(motor, board::kTensionOffset, gains->tension_offset_n));
    settings.push_back(Of(motor, board::kLengthOffset, gains->length_offset_m));
    settings.push_back(Of(motor, board::kPositionGain, gains->position_gain_n_per_m));
    settings.push_back(Of(motor, board::kVelocityGain, gains->velocity_gain_n_s_per_m));
  }
  return settings;
}

std::vector<Setting> SettingsFor(const Calibration& calibration, const RobotSpec& robot) {
  std::vector<Setting> settings;
  const std::vector<std::string> names = MotorNames(robot);
  for (const CableCalibration& cable : calibration.cables) {
    for (std::size_t motor = 0; motor < names.size(); ++motor) {
      if (names[motor] != cable.cable) continue;
      const auto add = [&](board::MotorParameter parameter, const std::optional<double>& value) {
        if (value) settings.push_back(Of(motor, parameter, *value));
      };
      add(board::kNewtonsPerCount, cable.load_cell_n_per_count);
      add(board::kCountsAtZero, cable.load_cell_counts_at_zero);
      add(board::kLengthPerCount, cable.encoder_m_per_count);
      add(board::kReferenceLength, cable.rest_length_at_reference_m);
      add(board::kStiffness, cable.stiffness_n_per_m);
    }
  }
  return settings;
}

}  // namespace taut::link
