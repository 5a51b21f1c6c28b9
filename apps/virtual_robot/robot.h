/// Six boards, their bus, the adapter to the computer and what they move, in lock step and in
/// virtual time: nothing here looks at a clock, and two runs are the same to the byte.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/virtual_robot/board.h"
#include "apps/virtual_robot/fault_schedule.h"
#include "apps/virtual_robot/i2c_bus.h"
#include "apps/virtual_robot/log.h"
#include "apps/virtual_robot/plant.h"
#include "apps/virtual_robot/sensors.h"
#include "apps/virtual_robot/usb_iss.h"
#include "taut/faults.h"

namespace taut::virtual_robot {

struct RobotOptions {
  std::shared_ptr<const AvrProgram> program;  ///< Of all boards.
  std::uint64_t seed = 1;                     ///< Of all noise.
  std::vector<double> drift_ppm{};            ///< A board each; 0 for those beyond the end.
  std::vector<std::uint8_t> eeprom{};         ///< Of all boards, behind their identity.
  LoadCellOptions load_cell{};
  EncoderOptions encoder{};
  UsbIssOptions usb{};
  /// How often the plant moves on and boards see it: 20 to 100 us. What turned in a period, the
  /// encoders show in the next.
  Time plant_period = 100 * kMicrosecond;
  std::vector<FaultSpec> faults{};
  LogSink log{};            ///< May be empty.
  bool log_frames = false;  ///< What goes over USB, too.
};

/// One thread calls it.
class Robot {
 public:
  /// Switched on at time 0, with a board for two motors of the plant, which outlives it.
  Robot(Plant& plant, const RobotOptions& options);
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  Time now() const { return now_; }
  void AdvanceTo(Time time);
  /// Called after each step of the plant.
  std::function<void(Time now)> after_plant_step;

  // The computer's side of the adapter.
  /// Writes at one go. Lost while nobody is there who could write, or nothing to write to.
  void HostWrites(std::span<const std::uint8_t> burst);
  /// What has come back by now.
  std::optional<Bytes> HostReads();
  /// Writes, and lets time pass until the reply is there. Nothing: there was none in time.
  std::optional<Bytes> Transfer(std::span<const std::uint8_t> frame,
                                Time timeout = 500 * kMillisecond);
  bool host_alive() const { return !state_.host_killed; }
  bool usb_connected() const { return !state_.usb_lost; }

  int board_count() const { return static_cast<int>(boards_.size()); }
  Board& board(int index) { return *boards_.at(static_cast<std::size_t>(index)); }
  I2cBus& bus() { return bus_; }
  UsbIss& usb() { return usb_; }
  /// As the boards have it, without supply or with a fault of the drivers: off.
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
  FaultState state_;  ///< As it was applied last.
  std::vector<Encoder> encoders_;
  std::vector<MotorDrive> drives_;
  std::vector<std::uint64_t> conversions_;  ///< A motor each.
  std::vector<double> stuck_at_;            ///< Forces that cells last showed [N].
};

}  // namespace taut::virtual_robot
