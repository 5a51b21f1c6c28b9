#include "apps/virtual_robot/robot_port.h"

#include <algorithm>
#include <utility>

namespace taut::virtual_robot {
namespace {

/// Polling interval for replies.
constexpr Time kLook = 250 * kMicrosecond;

}  // namespace

bool RobotPort::Write(std::span<const std::uint8_t> frame) {
  if (!robot_.usb_connected()) open_ = false;
  if (!open_) return false;
  robot_.HostWrites(frame);
  return true;
}

void RobotPort::Look() {
  if (!robot_.usb_connected()) open_ = false;
  if (const auto bytes = robot_.HostReads(); bytes && open_) {
    arrived_.insert(arrived_.end(), bytes->begin(), bytes->end());
  }
}

link::Bytes RobotPort::Read() {
  Look();
  return std::exchange(arrived_, {});
}

void RobotPort::Wait(double until_s) {
  // A wait that rounds to zero would never advance the time.
  const Time until = std::max(FromSeconds(until_s), robot_.now() + kMicrosecond);
  while (robot_.now() < until) {
    Look();
    if (!arrived_.empty()) return;
    robot_.AdvanceTo(std::min(until, robot_.now() + kLook));
  }
}

bool RobotPort::Reopen() {
  open_ = robot_.usb_connected();
  arrived_.clear();
  return open_;
}

}  // namespace taut::virtual_robot
