/// One board of the robot: an ATmega328P at 16 MHz as an Arduino Nano has it, run by libsimavr,
/// with what that library lacks or gets wrong made good (docs/hardware/virtual_robot.md lists it).
///
/// Pins, all seen from outside:
///
///   D2, D3    encoder A of motor 0, 1        D12       fault of the drivers, low is a fault
///   D4, D5    encoder B                      A0, A1    load cells
///   D7, D8    direction, high winds in       A4, A5    two-wire bus
///   D9, D10   PWM                            D6        drivers on, high is on
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/virtual_robot/avr_core.h"
#include "apps/virtual_robot/avr_program.h"
#include "apps/virtual_robot/emulated_time.h"
#include "apps/virtual_robot/plant.h"
#include "apps/virtual_robot/twi_slave.h"

namespace taut::virtual_robot {

/// Why a core began anew: the bits of MCUSR.
enum class ResetCause : std::uint8_t { kPowerOn = 1, kExternal = 2, kBrownOut = 4, kWatchdog = 8 };
const char* Name(ResetCause cause);

struct BoardOptions {
  int id = 0;                          ///< 0..5; byte 0 of the EEPROM.
  std::vector<std::uint8_t> eeprom{};  ///< What follows it; the rest is 0xFF.
  double drift_ppm = 0;                ///< How fast the crystal is.
};

/// A change of the two lines of an encoder.
struct EncoderEdge {
  Time at = 0;
  bool a = false, b = false;
};

/// One thread calls it.
class Board {
 public:
  /// Switched on at time 0.
  Board(std::shared_ptr<const AvrProgram> program, const BoardOptions& options);
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  int id() const { return id_; }
  /// Runs until the first instruction that ends at `until` or later.
  void RunUntil(Time until);
  I2cSlave& bus_side() { return *twi_; }

  // What the plant reads.
  MotorDrive Drive(int motor) const;

  // What the plant writes.
  /// Changes of encoder `motor`, from the end of the last `RunUntil` on, in order, up to 64.
  void SetEncoderEdges(int motor, const std::vector<EncoderEdge>& edges);
  /// True: something is wrong with the drivers.
  void SetDriverFault(bool fault);
  /// The code, 0..1023, that a conversion beginning at a time finds at pin A0 + channel.
  std::function<int(int channel, Time at)> adc_code;

  // What watchers hear.
  /// The program wrote GPIOR0, which on hardware does nothing; the cycle is exact.
  std::function<void(std::uint64_t cycle, std::uint8_t value)> on_marker;
  std::function<void(Time at, ResetCause cause)> on_reset;
  std::function<void(Time at, const std::string& what)> on_trouble;  ///< A crash, a warning.

  // Faults.
  void SetDrift(Time now, double ppm);
  /// Without power nothing answers and no pin drives. With it, the core begins anew.
  void SetPower(Time now, bool on);
  /// Held in reset while the supply is too low; then it begins anew, its memory kept.
  void SetBrownOut(Time now, bool low);
  /// The program hangs with interrupts off.
  void Hang();
  bool running() const { return powered_ && !brown_out_; }

  // What a debugger would see.
  std::uint64_t cycle() const;
  Time now() const;
  std::uint8_t Memory(std::uint16_t address) const;           ///< Of the data space, 0x000..0x8FF.
  void SetMemory(std::uint16_t address, std::uint8_t value);  ///< 0x100..0x8FF.
  std::uint8_t last_marker() const { return marker_; }
  std::uint8_t stack_probe() const;  ///< GPIOR1.
  /// The most bytes that the stack ever held since power came: memory is painted before.
  int DeepestStack() const;
  int StaticMemory() const;  ///< Bytes of variables.
  std::vector<std::uint8_t> Eeprom() const;
  std::uint64_t resets() const { return resets_; }    ///< Since time 0.
  std::uint64_t crashes() const { return crashes_; }  ///< Ways to hang that simavr knows.

 private:
  void Reset(Time now, ResetCause cause);
  void Trouble(const std::string& what) const;

  int id_;
  std::shared_ptr<const AvrProgram> program_;
  double drift_ppm_;
  BoardClock clock_;
  std::unique_ptr<AvrCore> core_;
  std::unique_ptr<TwiSlave> twi_;
  std::array<EncoderEdge, 2> encoder_{};  ///< As the core will have seen it last.
  bool powered_ = true, brown_out_ = false;
  std::uint8_t marker_ = 0;
  std::uint64_t resets_ = 0, crashes_ = 0;
};

}  // namespace taut::virtual_robot
