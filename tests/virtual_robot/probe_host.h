/// A host program that communicates with boards that run the probe
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/virtual_robot/probe_fixture.h"

namespace taut::virtual_robot {

class ProbeHost {
 public:
  explicit ProbeHost(Robot& robot) : robot_(robot) {}

  bool Configure() { return Ask({0x5A, 0x02, 0x70, 0x04}) == Bytes{0xFF, 0x00}; }
  /// Sends the duties of all motors, -1..1. Returns whether a board acknowledged them.
  bool Send(const std::vector<double>& duties, bool enable) {
    Bytes message(13, 0);
    message[0] = 0xC1;
    for (std::size_t i = 0; i < duties.size(); ++i) {
      message[1 + i] = static_cast<std::uint8_t>(static_cast<int>(std::lround(duties[i] * 127)));
    }
    message.push_back(enable ? 1 : 0);
    Bytes frame{0x54, 0x00, static_cast<std::uint8_t>(message.size())};
    frame.insert(frame.end(), message.begin(), message.end());
    return Ask(frame) == Bytes{0xFF};
  }
  /// Reads sixteen bytes of a board; empty without a reply. This command cannot detect a missing
  /// board.
  Bytes Read(int board) {
    return Ask({0x54, static_cast<std::uint8_t>((0x10 + board) << 1 | 1), 16});
  }
  /// The same by I2C_DIRECT, which returns {0, error} for a missing board.
  Bytes ReadDirect(int board) {
    return Ask({0x57, 0x01, 0x30, static_cast<std::uint8_t>((0x10 + board) << 1 | 1), 0x2E, 0x04,
                0x20, 0x03});
  }
  Bytes Ask(const Bytes& frame) { return robot_.Transfer(frame).value_or(Bytes{}); }

  static std::vector<double> Angles(const Plant& plant) {
    std::vector<double> angles;
    for (int motor = 0; motor < plant.motor_count(); ++motor) {
      angles.push_back(plant.RotorAngle(motor));
    }
    return angles;
  }

 private:
  Robot& robot_;
};

}  // namespace taut::virtual_robot
