/// Port through which the link's driver accesses the adapter of an emulated robot. Its clock is the
/// robot's virtual time.
#pragma once

#include "apps/virtual_robot/emulated_robot.h"
#include "taut/link/port.h"

namespace taut::virtual_robot {

/// Port that exchanges bytes with the emulated adapter. Not thread-safe.
class RobotPort final : public link::Port {
 public:
  /// The robot must outlive the port.
  explicit RobotPort(Robot& robot) : robot_(robot) {}

  bool Write(std::span<const std::uint8_t> frame) override;
  link::Bytes Read() override;
  /// Advances the robot's time.
  void Wait(double until_s) override;
  double now_s() const override { return ToSeconds(robot_.now()); }
  bool is_open() const override { return open_ && robot_.usb_connected(); }
  bool Reopen() override;

 private:
  void Look();

  Robot& robot_;
  link::Bytes arrived_;
  bool open_ = true;  ///< A device that disappeared must be opened again.
};

}  // namespace taut::virtual_robot
