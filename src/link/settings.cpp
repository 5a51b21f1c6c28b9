// Settings of the boards from an experiment and its model.
#include "description/robot/board_settings.h"
#include "taut/link/robot_plant.h"

namespace taut::link {
namespace {

using board::Mode;

Setting Of(std::size_t motor, board::MotorParameter parameter, double value) {
  return {PlaceOf(static_cast<int>(motor), parameter), static_cast<float>(value)};
}

void Add(std::size_t motor, const description::MotorSettings& from, std::vector<Setting>& to) {
  for (const auto& [parameter, value] : from) to.push_back(Of(motor, parameter, value));
}

const CableDef& CableAt(const RobotSpec& robot, int cable) {
  return robot.def.cables[static_cast<std::size_t>(cable)];
}

}  // namespace

std::vector<std::string> MotorNames(const RobotSpec& robot) {
  std::vector<std::string> names;
  for (const int cable : description::ActuatedCables(robot.def))
    names.push_back(CableAt(robot, cable).name);
  return names;
}

std::vector<int> MotorCables(const RobotSpec& robot, Diagnostics& out) {
  std::vector<int> cables = description::ActuatedCables(robot.def);
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
  const std::vector<int> cables = description::ActuatedCables(experiment.robot.def);
  std::vector<std::string> with, without;
  for (const int cable : cables) {
    (description::GainsOf(experiment.controllers, cable) != nullptr ? with : without)
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
  const std::vector<int> cables = description::ActuatedCables(robot.def);
  for (std::size_t motor = 0; motor < cables.size(); ++motor) {
    Add(motor, description::SettingsOf(CableAt(robot, cables[motor]), encoder_lines), settings);
  }
  return settings;
}

std::vector<Setting> GainsFor(const ExperimentSpec& experiment) {
  std::vector<Setting> settings;
  description::MotorSettings common;
  if (const BoardsSpec* const boards = BoardsOf(experiment.controllers)) {
    common = description::CommonMotorSettings(*boards);
    // Omit the experiment's load cell scales: a robot's load cells are calibrated.
    std::erase_if(common, [](const auto& setting) {
      return setting.parameter == board::kNewtonsPerCount ||
             setting.parameter == board::kCountsAtZero;
    });
  }
  const std::vector<int> cables = description::ActuatedCables(experiment.robot.def);
  for (std::size_t motor = 0; motor < cables.size(); ++motor) {
    const ImpedanceGains* const gains = description::GainsOf(experiment.controllers, cables[motor]);
    if (gains != nullptr) Add(motor, description::SettingsOf(*gains), settings);
    Add(motor, common, settings);
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
