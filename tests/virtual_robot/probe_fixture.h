/// Fixture of the virtual robot: boards that run the probe, and a plant in closed form
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "apps/virtual_robot/emulated_board.h"
#include "apps/virtual_robot/emulated_plant.h"
#include "apps/virtual_robot/emulated_robot.h"
#include "tests/virtual_robot/probes/mailbox.h"

namespace taut::virtual_robot {

inline std::shared_ptr<const AvrProgram> ProbeProgram() {
  static const std::shared_ptr<const AvrProgram> program = [] {
    Diagnostics found;
    auto read = ReadAvrProgram(TAUT_PROBE_ELF, found);
    EXPECT_TRUE(found.ok()) << found.Format();
    return read;
  }();
  return program;
}

inline std::uint16_t Word(const Board& board, std::uint16_t address) {
  return static_cast<std::uint16_t>(board.Memory(address) | board.Memory(address + 1) << 8);
}
inline std::uint32_t Long(const Board& board, std::uint16_t address) {
  return Word(board, address) | static_cast<std::uint32_t>(Word(board, address + 2)) << 16;
}
inline std::int32_t Count(const Board& board, int motor) {
  return static_cast<std::int32_t>(Long(board, static_cast<std::uint16_t>(kBoxCounts + 4 * motor)));
}
inline std::vector<std::uint8_t> Bytes8(const Board& board, std::uint16_t address, int count) {
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < count; ++i) {
    bytes.push_back(board.Memory(static_cast<std::uint16_t>(address + i)));
  }
  return bytes;
}

/// Independent motors, each with a spring at its cable: a duty sets the speed immediately, and the
/// spring force follows the wound angle, so that the effect of any board output has a closed form.
class SpringPlant : public Plant {
 public:
  static constexpr double kSpeed = 1000.0;  ///< Shaft speed at full duty [rad/s].
  static constexpr double kNewtonsPerRadian = 0.05;
  explicit SpringPlant(int motors = 12)
      : angles_(static_cast<std::size_t>(motors)), cut_(static_cast<std::size_t>(motors)) {}

  int motor_count() const override { return static_cast<int>(angles_.size()); }
  void Advance(double duration_s, std::span<const MotorDrive> drives) override {
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      if (drives[i].enabled) angles_[i] += drives[i].duty * kSpeed * duration_s;
    }
    time_s_ += duration_s;
  }
  double LoadCellForce(int motor) const override {
    const auto i = static_cast<std::size_t>(motor);
    return cut_[i] || angles_[i] < 0 ? 0.0 : angles_[i] * kNewtonsPerRadian;
  }
  double RotorAngle(int motor) const override { return angles_[static_cast<std::size_t>(motor)]; }
  void CutCable(int motor) override { cut_[static_cast<std::size_t>(motor)] = true; }

  void Set(int motor, double angle) { angles_[static_cast<std::size_t>(motor)] = angle; }
  double time_s() const { return time_s_; }

 private:
  std::vector<double> angles_;
  std::vector<bool> cut_;
  double time_s_ = 0;
};

}  // namespace taut::virtual_robot
