/// Virtual robot: boards, bus, adapter and plant in lock step and in virtual time. It uses no real
/// clock; two runs are identical to the byte.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_board.h"
#include "apps/virtual_robot/emulated_plant.h"
#include "apps/virtual_robot/emulated_sensors.h"
#include "apps/virtual_robot/emulated_usb_iss.h"
#include "apps/virtual_robot/fault_schedule.h"
#include "apps/virtual_robot/i2c_bus.h"
#include "apps/virtual_robot/robot_log.h"
#include "taut/faults.h"

namespace taut::virtual_robot {

struct RobotOptions {
  std::shared_ptr<const AvrProgram> program;  ///< Program of all boards.
  std::uint64_t seed = 1;                     ///< Seed of all noise.
  std::vector<double> drift_ppm{};     ///< Clock error of each board; 0 for boards beyond the end.
  std::vector<std::uint8_t> eeprom{};  ///< EEPROM bytes of all boards after the identity byte.
  BoardLoadCell load_cell{};
  EncoderOptions encoder{};
  UsbIssOptions usb{};
  /// Step of the plant and of its exchange with the boards: 20 to 100 us. Encoders show the
  /// rotation of a period one period later.
  Time plant_period = 100 * kMicrosecond;
  std::vector<FaultSpec> faults{};
  LogSink log{};            ///< Receiver of log lines; may be empty.
  bool log_frames = false;  ///< Log the USB frames, too.
};

/// The robot as a whole. Not thread-safe.
class Robot {
 public:
  /// Powers the robot on at time 0, with one board for two motors of `plant`, which must outlive
  /// the robot.
  Robot(Plant& plant, const RobotOptions& options);
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  Time now() const { return now_; }
  void AdvanceTo(Time time);
  /// Called after each step of the plant.
  std::function<void(Time now)> after_plant_step;

  // The computer's side of the adapter.
  /// Writes bytes at once. They are lost while the adapter is unplugged or unpowered.
  void HostWrites(std::span<const std::uint8_t> burst);
  /// Returns the reply received so far.
  std::optional<Bytes> HostReads();
  /// Writes, and advances time until the reply arrives. Returns nothing after a timeout.
  std::optional<Bytes> Transfer(std::span<const std::uint8_t> frame,
                                Time timeout = 500 * kMillisecond);
  bool host_alive() const { return !state_.host_killed; }
  bool usb_connected() const { return !state_.usb_lost; }

  int board_count() const { return static_cast<int>(boards_.size()); }
  Board& board(int index) { return *boards_.at(static_cast<std::size_t>(index)); }
  I2cBus& bus() { return bus_; }
  UsbIss& usb() { return usb_; }
  /// Returns the drive of a motor: from its board; off without supply or during a fault of the
  /// drivers.
  MotorDrive Drive(int motor) const;

 private:
  void Advance(Time limit);
  void StepPlant();
  void ApplyFaults();
  int AdcCode(int motor);
  void Log(std::string_view who, std::string_view what) const;
  void LogFrame(const char* arrow, std::span<const std::uint8_t> bytes) const;

  Plant& plant_;
  RobotOptions options_;
  Time now_ = 0, next_plant_step_ = 0;
  std::vector<std::unique_ptr<Board>> boards_;
  I2cBus bus_;
  UsbIss usb_;
  FaultSchedule faults_;
  FaultState state_;  ///< Most recently applied faults.
  std::vector<Encoder> encoders_;
  std::vector<MotorDrive> drives_;
  std::vector<std::uint64_t> conversions_;  ///< Number of load cell conversions of each motor.
  std::vector<double> stuck_at_;            ///< Forces last shown by the load cells [N].
};

}  // namespace taut::virtual_robot
