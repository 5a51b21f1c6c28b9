#include "apps/virtual_robot/motor_plant.h"

#include <utility>

#include "base/assert.h"

namespace taut::virtual_robot {
namespace {

/// Stiffness of a cut cable: forces below round-off.
constexpr double kNoStiffness_n_per_m = 1e-12;

}  // namespace

std::unique_ptr<MotorPlant> MotorPlant::Make(const RobotSpec& robot, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  std::vector<int> cables;
  std::vector<std::string> names;
  const SourceRef file{robot.files.empty() ? "model" : robot.files.front()};
  for (std::size_t i = 0; i < robot.def.cables.size(); ++i) {
    const CableDef& cable = robot.def.cables[i];
    if (cable.actuator.kind == ActuatorDef::Kind::kNone) continue;
    if (cable.actuator.kind != ActuatorDef::Kind::kDcMotor) {
      const SourceRef at = i < robot.cable_sources.size() ? robot.cable_sources[i] : file;
      out.Error("actuator.not_a_motor", at,
                "the actuator of cable " + cable.name + " is not a motor",
                "expected `actuator: {dc_motor: {}}`");
    }
    cables.push_back(static_cast<int>(i));
    names.push_back(cable.name);
  }
  if (cables.empty()) {
    out.Error("robot.no_motors", file, "no cable has a motor",
              "expected 1 to 12 cables with motors");
  } else if (cables.size() > kMostMotors) {
    out.Error("robot.too_many_motors", file, std::to_string(cables.size()) + " cables have a motor",
              "six boards drive at most 12");
  }
  if (out.items().size() != errors_before) return nullptr;
  auto model = Model::Compile(robot.def, out);
  if (!model) return nullptr;
  std::unique_ptr<MotorPlant> plant(
      new MotorPlant(std::move(model), std::move(cables), std::move(names)));
  for (const int cable : plant->cables_) plant->batch_.SetMotorEnabled(0, cable, false);
  return plant;
}

MotorPlant::MotorPlant(std::shared_ptr<const Model> model, std::vector<int> cables,
                       std::vector<std::string> names)
    : batch_(std::move(model), WorldBatchOptions{}),
      cables_(std::move(cables)),
      names_(std::move(names)),
      cut_(cables_.size(), false) {}

void MotorPlant::Advance(double duration_s, std::span<const MotorDrive> drives) {
  TAUT_ASSERT(drives.size() == cables_.size());
  if (held_) return;
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    batch_.SetDuty(0, cables_[i], drives[i].duty);
    batch_.SetMotorEnabled(0, cables_[i], drives[i].enabled);
  }
  batch_.Step(duration_s);
}

double MotorPlant::LoadCellForce(int motor) const {
  const auto i = static_cast<std::size_t>(motor);
  return cut_[i] ? 0.0 : batch_.Cable(0, cables_[i]).tension_n;
}

double MotorPlant::RotorAngle(int motor) const {
  return batch_.Motor(0, cable(motor)).rotor_angle_rad;
}

void MotorPlant::CutCable(int motor) {
  cut_[static_cast<std::size_t>(motor)] = true;
  batch_.SetParameter(0, Parameter::kCableStiffness, cable(motor), kNoStiffness_n_per_m);
  batch_.SetParameter(0, Parameter::kCableDamping, cable(motor), 0.0);
}

}  // namespace taut::virtual_robot
