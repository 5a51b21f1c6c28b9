/// ATmega328P on libsimavr 1.6, with corrections of simavr's errors
/// (docs/hardware/virtual_robot.md).
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "apps/virtual_robot/avr_program.h"
#include "apps/virtual_robot/emulated_time.h"

struct avr_t;
struct avr_irq_t;
struct avr_ioport_t;

namespace taut::virtual_robot {

/// Level of a pin, set from outside of the chip.
struct PinLevel {
  std::uint64_t cycle = 0;
  char port = 'D';
  int bit = 0;
  bool high = false;
};

/// Emulated microcontroller. Not thread-safe. Cycles are counted by the core, across resets.
class AvrCore {
 public:
  explicit AvrCore(const AvrProgram& program);
  ~AvrCore();
  AvrCore(const AvrCore&) = delete;
  AvrCore& operator=(const AvrCore&) = delete;

  avr_t& avr() { return *avr_; }
  std::uint64_t cycle() const;
  /// Runs until `cycle`, or a few cycles beyond, at the end of an instruction.
  void RunUntil(std::uint64_t cycle);
  /// Resets the core. `power_on`: the memory is lost.
  void Reset(std::uint8_t cause, bool power_on);
  /// Puts the core into an endless loop with interrupts off.
  void Hang();

  void SetPin(char port, int bit, bool high);
  /// Schedules levels in order of cycles, after all earlier ones; levels in the past are set at
  /// once.
  void SchedulePins(const std::vector<PinLevel>& levels);
  /// Sets all scheduled levels at once, for a core that does not run.
  void SettlePins();
  /// Returns the level that a pin drives; false if it is an input.
  bool Drives(char port, int bit) const;
  /// Returns the duty of a Timer 1 output, channel 0 (A) or 1 (B): the fraction of time at high.
  double PwmDuty(int channel) const;
  std::uint8_t Memory(std::uint16_t address) const;
  void SetMemory(std::uint16_t address, std::uint8_t value);
  void LoadEeprom(std::uint32_t offset, const std::vector<std::uint8_t>& bytes);
  std::vector<std::uint8_t> Eeprom() const;
  int DeepestStack() const;

  std::function<int(int channel)>
      adc_code;  ///< Called at the start of a conversion; returns 0 to 1023.
  std::function<void(std::uint8_t value)> on_marker;
  /// Called after a reset, before the first instruction. The causes are the bits of MCUSR.
  std::function<void(std::uint8_t cause)> on_reset;
  std::function<void(const std::string& text)>
      on_message;  ///< Receives simavr's warnings and errors.
  /// Called when the program leaves its memory, or sleeps with interrupts off. simavr would stop
  /// for good; here, as on hardware, the watchdog may end this state.
  std::function<void()> on_crash;

 private:
  struct Hooks;  ///< Callbacks of simavr.
  friend struct Hooks;

  void AfterReset();
  /// Processes timers that became due while an interrupt was entered, before its first instruction;
  /// simavr does not count these cycles.
  void CatchUp();
  void StartPinTimer();

  avr_t* avr_;
  avr_ioport_t *port_b_, *port_d_;
  std::uint32_t free_memory_;
  std::deque<PinLevel> levels_;  ///< Scheduled levels.
  std::uint64_t stop_cycle_ = 0;
  bool reset_seen_ = false, asleep_ = false, entered_ = false;
  std::uint8_t causes_ = 0;  ///< MCUSR, cleared only by the program and by loss of power.
  std::uint8_t wanted_cause_ = 0;
  std::uint8_t temp_ = 0;  ///< High byte register shared by all 16-bit registers of Timer 1.
  std::uint16_t compare_[2] = {0, 0}, top_ = 0;  ///< Compare values and top of the timer.
  int converting_ = 0,
      converted_ = 0;           ///< ADC results: of the conversion in progress, and the last one.
  bool result_locked_ = false;  ///< Whether ADCL has been read, but not yet ADCH.
};

}  // namespace taut::virtual_robot
