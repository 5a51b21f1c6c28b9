// Motor boards of an experiment: checks, and conversion to the last controller.
#include <cmath>
#include <utility>

#include "description/experiment/control_keys.h"
#include "description/experiment/experiment_parts.h"
#include "description/robot/board_settings.h"

namespace taut::description {
namespace {

/// Checks that boards can drive the actuated cables of the robot.
void CheckCables(const RobotSpec& robot, const std::vector<ControllerSpec>& controllers,
                 const SourceRef& at, const Scope& scope) {
  std::vector<int> without_motor, with_gains, without_gains;
  const std::vector<int> cables = ActuatedCables(robot.def);
  for (const int cable : cables) {
    const ActuatorDef& actuator = robot.def.cables[static_cast<std::size_t>(cable)].actuator;
    if (actuator.kind != ActuatorDef::Kind::kDcMotor) without_motor.push_back(cable);
    (GainsOf(controllers, cable) != nullptr ? with_gains : without_gains).push_back(cable);
  }
  if (cables.empty()) {
    scope.out.Error("boards.no_motors", at, "boards: no cable has an actuator",
                    "give the cables' builders in the model an `actuator: {dc_motor: {...}}`");
  }
  if (!without_motor.empty()) {
    scope.out.Error(
        "boards.not_a_motor", at,
        "boards: the actuators of " + CableNames(robot, without_motor) + " are not DC motors",
        "write `actuator: {dc_motor: {...}}` in the model");
  }
  if (!with_gains.empty() && !without_gains.empty()) {
    scope.out.Error("boards.mixed_modes", at,
                    "boards: impedance control is missing for " + CableNames(robot, without_gains),
                    "boards run it for all cables with actuators, or for none");
  }
}

}  // namespace

void Check(const MapReader& map, BoardsText& boards) {
  boards.at = map.at();
  for (const auto& [key, time_s] : {std::pair{"broadcast_s", boards.broadcast_s},
                                    std::pair{"broadcast_delay_s", boards.broadcast_delay_s}}) {
    const double ticks = time_s / 0.001;
    if (!map.Has(key) || std::fabs(ticks - std::round(ticks)) <= 1e-6) continue;
    map.Error(
        "boards.time_not_whole", key,
        map.Path(key) + " must be a whole number of milliseconds, got " + Shown(time_s) + " s",
        "the firmware's tick is 1 ms");
  }
  if (boards.broadcast_delay_s > boards.broadcast_s - 0.0005) {
    const char* const key = map.Has("broadcast_delay_s") ? "broadcast_delay_s" : "broadcast_s";
    map.Error("boards.delay_too_long", key,
              map.Path("broadcast_delay_s") + " (" + Shown(boards.broadcast_delay_s) +
                  " s) must be less than broadcast_s (" + Shown(boards.broadcast_s) + " s)");
  }
  if (map.Has("capture")) boards.capture_at = map.KeyAt("capture");
}

void AddBoards(const BoardsText& boards, const RobotSpec* robot, const Scope& scope,
               ExperimentSpec& experiment) {
  if (experiment.sensors) {
    scope.out.Error("boards.sensors_given_twice", boards.at,
                    "the experiment has both `sensors` and `boards`",
                    "boards have their own load cells and encoders; remove `sensors`");
  }
  for (const ControllerSpec& controller : experiment.controllers) {
    if (controller.name != "boards") continue;
    scope.out.Error("boards.name_taken", boards.at, "boards: a controller has the name \"boards\"",
                    "rename the controller");
  }
  if (robot != nullptr) CheckCables(*robot, experiment.controllers, boards.at, scope);
  bool has_gains = false;
  for (const ControllerSpec& controller : experiment.controllers) {
    has_gains = has_gains || controller.impedance.has_value();
  }
  if (boards.capture && !has_gains) {
    scope.out.Error("boards.capture_without_effect", boards.capture_at,
                    "boards.capture has no effect without impedance control",
                    "it replaces the set points T0 and L0 of `impedance`");
  }
  ControllerSpec& last = experiment.controllers.emplace_back();
  last.name = "boards";
  last.clock = {0.001, 0.0};
  last.boards = boards;
}

}  // namespace taut::description
