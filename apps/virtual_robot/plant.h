/// What the pins of the boards stand on: motors, cables, whatever they move.
#pragma once

#include <span>

namespace taut::virtual_robot {

/// What a board does to one motor.
struct MotorDrive {
  double duty = 0;  ///< Of the supply, -1..1. Positive winds the cable in.
  /// The bridge is on: with a duty of 0 it brakes. Off: the winding is open.
  bool enabled = false;
};

/// The mechanics of a robot with one cable a motor. Motor m of board b is number 2 b + m; it is
/// the actuated cable of that number, in the model's order.
///
/// A plant belongs to one robot and is called by its thread.
class Plant {
 public:
  virtual ~Plant() = default;

  virtual int motor_count() const = 0;
  /// Moves on by `duration_s`, 20 to 100 us, in which the drives stay as they are. One drive a
  /// motor.
  virtual void Advance(double duration_s, std::span<const MotorDrive> drives) = 0;
  /// What the load cell at the cable's end feels; tension is positive [N].
  virtual double LoadCellForce(int motor) const = 0;
  /// Where the shaft of the motor stands, before the gear; winding in is positive [rad].
  virtual double RotorAngle(int motor) const = 0;
  /// From now on the cable is cut: its tension is 0 and its load cell feels nothing.
  virtual void CutCable(int motor) = 0;
};

}  // namespace taut::virtual_robot
