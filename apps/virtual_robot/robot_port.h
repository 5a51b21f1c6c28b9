/// The adapter of an emulated robot as a port of the driver, in the robot's own time.
#pragma once

#include "apps/virtual_robot/robot.h"
#include "taut/link/port.h"

namespace taut::virtual_robot {

/// One thread calls it.
class RobotPort final : public link::Port {
 public:
  /// The robot outlives it.
  explicit RobotPort(Robot& robot) : robot_(robot) {}

  bool Write(std::span<const std::uint8_t> frame) override;
  link::Bytes Read() override;
  /// Lets the robot's time pass.
  void Wait(double until_s) override;
  double now_s() const override { return ToSeconds(robot_.now()); }
  bool is_open() const override { return open_ && robot_.usb_connected(); }
  bool Reopen() override;

 private:
  void Look();

  Robot& robot_;
  link::Bytes arrived_;
  bool open_ = true;  ///< A device that went has to be opened again.
};

}  // namespace taut::virtual_robot
