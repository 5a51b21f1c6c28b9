/// Motor boards between the controllers and the simulated DC motors of all lanes
/// (docs/theory/boards.md).
#pragma once

#include <memory>

#include "taut/plant.h"

namespace taut::plant {

/// Sensors and controller of the boards. The sensors read load cells and encoders at each tick and
/// return the readings of the last status; the controller runs the firmware and sets duties.
struct MotorBoards {
  std::unique_ptr<SensorModel> sensors;
  std::unique_ptr<Controller> controller;
};

/// Creates the boards of an experiment with `BoardsOf`. The controller must act after all others.
MotorBoards MakeBoards(const ControlSetup& setup);

}  // namespace taut::plant
