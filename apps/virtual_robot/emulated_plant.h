/// Interface between the boards' pins and the mechanics: motors, cables, robot.
#pragma once

#include <span>

namespace taut::virtual_robot {

/// Drive of one motor by its board.
struct MotorDrive {
  double duty = 0;  ///< Fraction of the supply voltage, -1 to 1. Positive winds the cable in.
  /// Bridge on: with a duty of 0 it brakes. Off: the winding is open.
  bool enabled = false;
};

/// Mechanics of a robot with one cable per motor. Motor m of board b has number 2 b + m and winds
/// the actuated cable of this number, in the model's order.
///
/// A plant belongs to one robot and is called by its thread.
class Plant {
 public:
  virtual ~Plant() = default;

  virtual int motor_count() const = 0;
  /// Advances by `duration_s`, 20 to 100 us, with constant drives, one per motor.
  virtual void Advance(double duration_s, std::span<const MotorDrive> drives) = 0;
  /// Returns the force on the load cell at the cable's end; tension is positive [N].
  virtual double LoadCellForce(int motor) const = 0;
  /// Returns the angle of the motor's shaft, before the gear; winding in is positive [rad].
  virtual double RotorAngle(int motor) const = 0;
  /// Cuts the cable: from now on its tension and the force on its load cell are 0.
  virtual void CutCable(int motor) = 0;
};

}  // namespace taut::virtual_robot
