/// Stand that holds the robot until its motors do.
#pragma once

#include "apps/virtual_robot/emulated_robot.h"
#include "apps/virtual_robot/motor_plant.h"
#include "apps/virtual_robot/robot_log.h"

namespace taut::virtual_robot {

/// Releases the robot when all drivers are on. For use on the robot's thread only.
class Stand {
 public:
  /// Time for which the motor drivers of all boards must be on without interruption.
  static constexpr Time kDrivenFor = 100 * kMillisecond;

  /// Holds the plant from now on. The arguments must outlive the stand; `log` may be empty.
  Stand(MotorPlant& plant, const Robot& robot, LogSink log);
  /// To be called after each step of the plant: releases the robot, once and for good, when all
  /// boards hold their motors.
  void Step(Time now);

 private:
  bool AllDriversOn() const;

  MotorPlant& plant_;
  const Robot& robot_;
  LogSink log_;
  Time driven_since_ = -1;  ///< Negative: not all drivers are on.
};

}  // namespace taut::virtual_robot
