/// Parameters of motor boards that follow from an experiment and its model.
#pragma once

#include <vector>

#include "taut/board/parameters.h"
#include "taut/boards.h"
#include "taut/spec.h"

namespace taut::description {

/// Parameter of a motor or a board with a value.
template <class Parameter>
struct BoardSetting {
  Parameter parameter;
  double value;
};
using MotorSettings = std::vector<BoardSetting<board::MotorParameter>>;

/// Return the settings that all motors and all boards have in common.
MotorSettings CommonMotorSettings(const BoardsSpec& boards);
std::vector<BoardSetting<board::BoardParameter>> CommonBoardSettings(const BoardsSpec& boards);

/// Returns the cable length per encoder count [m]. The firmware counts two edges per line.
double LengthPerCount(const DcMotorDef& motor, int encoder_lines);

/// Returns the settings of the motor of a cable: stiffness, reference and, with a DC motor, length
/// per encoder count and speed limit.
MotorSettings SettingsOf(const CableDef& cable, int encoder_lines);

/// Returns the gains of a cable as settings.
MotorSettings SettingsOf(const ImpedanceGains& gains);

/// Returns the gains of a cable in any impedance controller; null if there are none.
const ImpedanceGains* GainsOf(const std::vector<ControllerSpec>& controllers, int cable);

/// Returns the cables with actuators, in the order of their motors.
std::vector<int> ActuatedCables(const ModelDef& def);

}  // namespace taut::description
