/// A stand that holds the robot until its boards do.
#pragma once

#include "apps/virtual_robot/log.h"
#include "apps/virtual_robot/motor_plant.h"
#include "apps/virtual_robot/robot.h"

namespace taut::virtual_robot {

/// One thread calls it, that of the robot.
class Stand {
 public:
  /// The motor drivers of all boards have to be on for so long, without a break.
  static constexpr Time kDrivenFor = 100 * kMillisecond;

  /// Holds the plant from now on. What is given outlives it; `log` may be empty.
  Stand(MotorPlant& plant, const Robot& robot, LogSink log);
  /// After each step of the plant: lets go, once and for good, when all boards hold their motors.
  void Step(Time now);

 private:
  bool AllDriversOn() const;

  MotorPlant& plant_;
  const Robot& robot_;
  LogSink log_;
  Time driven_since_ = -1;  ///< Not all of them are on, while negative.
};

}  // namespace taut::virtual_robot
