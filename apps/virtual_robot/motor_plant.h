/// Plant of the virtual robot: a taut simulation whose actuated cables are wound by motors.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_plant.h"
#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut::virtual_robot {

class MotorPlant : public Plant {
 public:
  static constexpr int kMostMotors = 12;  ///< Two per board, for six addresses.

  /// Creates the robot in its described pose, with its motors off. Returns null, with errors in
  /// `out`, if the model does not compile, has no motor or too many, or an actuator that is not a
  /// motor.
  static std::unique_ptr<MotorPlant> Make(const RobotSpec& robot, Diagnostics& out);

  int motor_count() const override { return static_cast<int>(cables_.size()); }
  void Advance(double duration_s, std::span<const MotorDrive> drives) override;
  double LoadCellForce(int motor) const override;
  double RotorAngle(int motor) const override;
  void CutCable(int motor) override;

  /// Returns the cables with motors, in the model's order.
  const std::vector<std::string>& cable_names() const { return names_; }
  const WorldBatch& batch() const { return batch_; }
  WorldBatch& batch() { return batch_; }
  /// Holds the robot on a stand: nothing moves, and load cells measure the forces at the start.
  void SetHeld(bool held) { held_ = held; }
  bool held() const { return held_; }
  int cable(int motor) const { return cables_.at(static_cast<std::size_t>(motor)); }

 private:
  MotorPlant(std::shared_ptr<const Model> model, std::vector<int> cables,
             std::vector<std::string> names);

  WorldBatch batch_;  ///< Batch of one world.
  std::vector<int> cables_;
  std::vector<std::string> names_;
  std::vector<bool> cut_;
  bool held_ = false;
};

}  // namespace taut::virtual_robot
