/// An ATmega328P by libsimavr 1.6, with what that gets wrong made good. What each correction is for
/// stands in docs/hardware/virtual_robot.md.
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

/// A level that a pin gets from outside.
struct PinLevel {
  std::uint64_t cycle = 0;
  char port = 'D';
  int bit = 0;
  bool high = false;
};

/// One thread calls it. Cycles are the core's own; they go on through resets.
class AvrCore {
 public:
  explicit AvrCore(const AvrProgram& program);
  ~AvrCore();
  AvrCore(const AvrCore&) = delete;
  AvrCore& operator=(const AvrCore&) = delete;

  avr_t& avr() { return *avr_; }
  std::uint64_t cycle() const;
  /// Runs until `cycle` or a few beyond, as instructions end.
  void RunUntil(std::uint64_t cycle);
  /// Begins anew. With `power_on`, memory has been lost.
  void Reset(std::uint8_t cause, bool power_on);
  /// Interrupts off, and round in a circle.
  void Hang();

  void SetPin(char port, int bit, bool high);
  /// In order of cycles, after all that came before; those in the past happen at once.
  void SchedulePins(const std::vector<PinLevel>& levels);
  /// What was scheduled happens now, all at once: nobody looks.
  void SettlePins();
  /// What a pin drives; false if it is an input.
  bool Drives(char port, int bit) const;
  /// The part of the time for which the output of Timer 1 is high, channel 0 (A) or 1 (B).
  double PwmDuty(int channel) const;
  std::uint8_t Memory(std::uint16_t address) const;
  void SetMemory(std::uint16_t address, std::uint8_t value);
  void LoadEeprom(std::uint32_t offset, const std::vector<std::uint8_t>& bytes);
  std::vector<std::uint8_t> Eeprom() const;
  int DeepestStack() const;

  std::function<int(int channel)> adc_code;  ///< When a conversion begins; 0..1023.
  std::function<void(std::uint8_t value)> on_marker;
  /// After a reset, before the first instruction. The causes are those of MCUSR.
  std::function<void(std::uint8_t cause)> on_reset;
  std::function<void(const std::string& text)> on_message;  ///< simavr's warnings and errors.
  /// The program left its memory, or sleeps with interrupts off. Simavr would stop for good; here
  /// as on hardware the watchdog may end it.
  std::function<void()> on_crash;

 private:
  struct Hooks;  ///< Functions that simavr calls.
  friend struct Hooks;

  void AfterReset();
  /// Entering an interrupt takes cycles of which simavr knows nothing: what was due in them happens
  /// before its first instruction.
  void CatchUp();
  void StartPinTimer();

  avr_t* avr_;
  avr_ioport_t *port_b_, *port_d_;
  std::uint32_t free_memory_;
  std::deque<PinLevel> levels_;  ///< Still to come.
  std::uint64_t stop_cycle_ = 0;
  bool reset_seen_ = false, asleep_ = false, entered_ = false;
  std::uint8_t causes_ = 0;  ///< MCUSR, which only its reader and loss of power clear.
  std::uint8_t wanted_cause_ = 0;
  std::uint8_t temp_ = 0;                        ///< The high byte that all of Timer 1 shares.
  std::uint16_t compare_[2] = {0, 0}, top_ = 0;  ///< As the timer has them.
  int converting_ = 0, converted_ = 0;           ///< Of the ADC: under way, and the last.
  bool result_locked_ = false;                   ///< From reading ADCL until ADCH.
};

}  // namespace taut::virtual_robot
