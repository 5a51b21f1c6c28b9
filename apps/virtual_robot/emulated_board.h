/// Emulated motor board: an Arduino Nano (ATmega328P at 16 MHz) on libsimavr, with corrections for
/// errors and gaps of that library (listed in docs/hardware/virtual_robot.md).
///
/// Pins, as seen from outside:
///
///   D2, D3    encoder A of motor 0, 1        D12       fault of the drivers, low: fault
///   D4, D5    encoder B                      A0, A1    load cells
///   D7, D8    direction, high: winds in      A4, A5    two-wire bus
///   D9, D10   PWM                            D6        driver enable, high: on
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/virtual_robot/avr_core.h"
#include "apps/virtual_robot/avr_program.h"
#include "apps/virtual_robot/emulated_plant.h"
#include "apps/virtual_robot/emulated_time.h"
#include "apps/virtual_robot/twi_slave.h"

namespace taut::virtual_robot {

/// Cause of a reset: the bits of MCUSR.
enum class ResetCause : std::uint8_t { kPowerOn = 1, kExternal = 2, kBrownOut = 4, kWatchdog = 8 };
const char* Name(ResetCause cause);

struct BoardOptions {
  int id = 0;                          ///< Number of the board, 0 to 5: byte 0 of the EEPROM.
  std::vector<std::uint8_t> eeprom{};  ///< Further bytes of the EEPROM; the rest is 0xFF.
  double drift_ppm = 0;                ///< Frequency error of the crystal; positive: fast.
};

/// A change of the two lines of an encoder.
struct EncoderEdge {
  Time at = 0;
  bool a = false, b = false;
};

/// Emulated board. Not thread-safe.
class Board {
 public:
  /// Powers the board on at time 0.
  Board(std::shared_ptr<const AvrProgram> program, const BoardOptions& options);
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  int id() const { return id_; }
  /// Runs to the end of the first instruction that ends at `until` or later.
  void RunUntil(Time until);
  I2cSlave& bus_side() { return *twi_; }

  // Outputs to the plant.
  MotorDrive Drive(int motor) const;

  // Inputs from the plant.
  /// Sets the changes of encoder `motor`, from the end of the last `RunUntil` on, in order, up to
  /// 64.
  void SetEncoderEdges(int motor, const std::vector<EncoderEdge>& edges);
  /// `fault`: sets the fault input of the drivers.
  void SetDriverFault(bool fault);
  /// Returns the code, 0 to 1023, of a conversion that begins at this time at pin A0 + channel.
  std::function<int(int channel, Time at)> adc_code;

  // Notifications.
  /// Called when the program writes GPIOR0, which has no effect on hardware; the cycle is exact.
  std::function<void(std::uint64_t cycle, std::uint8_t value)> on_marker;
  std::function<void(Time at, ResetCause cause)> on_reset;
  std::function<void(Time at, const std::string& what)>
      on_trouble;  ///< Reports crashes and warnings.

  // Injected faults.
  void SetDrift(Time now, double ppm);
  /// Without power, the board does not answer and drives no pin. When power returns, the core
  /// restarts.
  void SetPower(Time now, bool on);
  /// Holds the core in reset while the supply is too low; then it restarts with its memory
  /// preserved.
  void SetBrownOut(Time now, bool low);
  /// Makes the program hang with interrupts off.
  void Hang();
  bool running() const { return powered_ && !brown_out_; }

  // Debugger access.
  std::uint64_t cycle() const;
  Time now() const;
  std::uint8_t Memory(std::uint16_t address) const;  ///< Address in the data space, 0x000 to 0x8FF.
  void SetMemory(std::uint16_t address, std::uint8_t value);  ///< Address: 0x100 to 0x8FF.
  std::uint8_t last_marker() const { return marker_; }
  std::uint8_t stack_probe() const;  ///< Content of the register GPIOR1.
  /// Returns the largest depth of the stack since power-on [bytes]. Power-on fills the memory with
  /// a pattern; the depth reaches to the first byte that differs from it.
  int DeepestStack() const;
  int StaticMemory() const;  ///< Returns the bytes of variables.
  std::vector<std::uint8_t> Eeprom() const;
  std::uint64_t resets() const { return resets_; }    ///< Number of resets since time 0.
  std::uint64_t crashes() const { return crashes_; }  ///< Number of hangs that simavr has detected.

 private:
  void Reset(Time now, ResetCause cause);
  void Trouble(const std::string& what) const;

  int id_;
  std::shared_ptr<const AvrProgram> program_;
  double drift_ppm_;
  BoardClock clock_;
  std::unique_ptr<AvrCore> core_;
  std::unique_ptr<TwiSlave> twi_;
  std::array<EncoderEdge, 2> encoder_{};  ///< State after the scheduled edges.
  bool powered_ = true, brown_out_ = false;
  std::uint8_t marker_ = 0;
  std::uint64_t resets_ = 0, crashes_ = 0;
};

}  // namespace taut::virtual_robot
