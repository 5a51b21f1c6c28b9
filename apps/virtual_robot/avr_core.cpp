#include "apps/virtual_robot/avr_core.h"

#include <algorithm>
#include <cstdlib>

#include "apps/virtual_robot/avr_hooks.h"
#include "base/assert.h"

namespace taut::virtual_robot {
namespace {

constexpr std::uint8_t kPaint = 0xC5;
/// Address of an endless loop (rjmp .-2), at the end of the flash.
constexpr std::uint32_t kTrapAddress = AvrProgram::kFlashBytes - 2;
/// Cycles that simavr may run without processing its timers if none is due.
constexpr std::uint64_t kRunLimit = 100'000;

constexpr std::uint8_t Bit(int bit) { return static_cast<std::uint8_t>(1U << bit); }

}  // namespace

AvrCore::AvrCore(const AvrProgram& program)
    : avr_(avr_make_mcu_by_name("atmega328p")), free_memory_(program.free_memory) {
  TAUT_ASSERT(avr_ != nullptr);
  avr_global_logger_set(&Hooks::Log);
  avr_->custom.data = this;
  avr_init(avr_);
  avr_->frequency = BoardClock::kNominalHz;
  avr_->vcc = avr_->avcc = avr_->aref = 5000;
  std::vector<std::uint8_t> flash = program.flash;
  TAUT_ASSERT(flash.size() <= kTrapAddress);
  flash.resize(AvrProgram::kFlashBytes, 0xFF);
  flash[kTrapAddress] = 0xFF;
  flash[kTrapAddress + 1] = 0xCF;
  avr_loadcode(avr_, flash.data(), static_cast<std::uint32_t>(flash.size()), 0);
  avr_->codeend = AvrProgram::kFlashBytes;
  LoadEeprom(0, program.eeprom);
  // simavr's sleep function suspends the thread and wakes the core one cycle late. If a core falls
  // asleep with the last instruction of a run, the scheduled stop is in the past, and the core
  // would jump to the next timer.
  avr_->sleep = [](avr_t* avr, avr_cycle_count_t most) {
    const std::uint64_t stop = std::max(avr->cycle, Hooks::Self(avr).stop_cycle_);
    if (avr->cycle + most > stop) avr->cycle = stop - most;
    --avr->cycle;
  };
  avr_->reset = [](avr_t* avr) { Hooks::Self(avr).reset_seen_ = true; };
  port_b_ = Hooks::FindPort(*avr_, 'B');
  port_d_ = Hooks::FindPort(*avr_, 'D');
  Hooks::Install(*this);
}

AvrCore::~AvrCore() {
  avr_terminate(avr_);
  std::free(avr_);  // NOLINT: allocated by simavr with malloc
}

std::uint64_t AvrCore::cycle() const { return avr_->cycle; }

void AvrCore::RunUntil(std::uint64_t cycle) {
  if (avr_->cycle >= cycle) return;
  stop_cycle_ = cycle;
  // Wakes a sleeping core, which would otherwise jump to simavr's next timer.
  avr_cycle_timer_register(avr_, cycle - avr_->cycle, &Hooks::Stop, this);
  while (avr_->cycle < cycle) {
    asleep_ = avr_->state == cpu_Sleeping;
    const int state = avr_run(avr_);
    if (reset_seen_) AfterReset();
    if (state == cpu_Done || state == cpu_Crashed) {
      if (on_crash) on_crash();
      Hang();
    }
    CatchUp();
  }
  // A sleeping core has jumped to this cycle. simavr would process timers due in it only at the
  // start of the next run, after the caller has read the state.
  const bool sleeps = avr_->state == cpu_Sleeping;
  avr_cycle_timer_process(avr_);
  if (!sleeps) return;
  asleep_ = true;
  if (avr_->interrupt_state) avr_service_interrupts(avr_);
  CatchUp();
}

void AvrCore::CatchUp() {
  if (!entered_) return;
  entered_ = false;
  avr_cycle_timer_process(avr_);
}

void AvrCore::Reset(std::uint8_t cause, bool power_on) {
  if (power_on) {
    std::fill(avr_->data + AvrProgram::kMemoryStart, avr_->data + AvrProgram::kMemoryEnd, kPaint);
    causes_ = 0;
  }
  wanted_cause_ = cause;
  avr_->run = avr_callback_run_raw;  // a watchdog reset in progress replaces this function
  avr_reset(avr_);
  AfterReset();
}

void AvrCore::AfterReset() {
  reset_seen_ = false;
  // avr_reset restores values that make the core slow and cause interrupt storms of the encoders.
  avr_->run_cycle_limit = kRunLimit;
  for (std::uint8_t line = 0; line < 2; ++line) avr_extint_set_strict_lvl_trig(avr_, line, 0);
  // avr_reset also clears the pins, and raising a level that a pin already has does nothing.
  avr_->data[port_b_->r_pin] = port_b_->external.pull_value;
  avr_->data[port_d_->r_pin] = port_d_->external.pull_value;
  const std::uint8_t by_watchdog = avr_->data[kMcusr];
  const std::uint8_t cause = wanted_cause_ != 0 ? wanted_cause_ : by_watchdog;
  wanted_cause_ = 0;
  causes_ = static_cast<std::uint8_t>(causes_ | cause);
  avr_->data[kMcusr] = causes_;
  temp_ = 0;
  compare_[0] = compare_[1] = top_ = 0;
  converting_ = converted_ = 0;
  result_locked_ = false;
  if (stop_cycle_ > avr_->cycle) {
    avr_cycle_timer_register(avr_, stop_cycle_ - avr_->cycle, &Hooks::Stop, this);
  }
  StartPinTimer();
  if (on_reset) on_reset(cause);
}

void AvrCore::Hang() {
  avr_->sreg[S_I] = 0;
  avr_->state = cpu_Running;
  avr_->pc = kTrapAddress;
}

void AvrCore::SetPin(char port, int bit, bool high) {
  avr_ioport_t& p = port == 'B' ? *port_b_ : *port_d_;
  const std::uint8_t mask = Bit(bit);
  // Without the mask, every write to the port would set pins with a pull-up to high.
  p.external.pull_mask |= mask;
  if (high) {
    p.external.pull_value |= mask;
  } else {
    p.external.pull_value &= static_cast<std::uint8_t>(~mask);
  }
  avr_raise_irq(p.io.irq + bit, high ? 1 : 0);
}

void AvrCore::SchedulePins(const std::vector<PinLevel>& levels) {
  for (const PinLevel& level : levels) {
    // The lists of the two encoders arrive one after the other, each sorted by time.
    const auto later = [](const PinLevel& a, const PinLevel& b) { return a.cycle < b.cycle; };
    levels_.insert(std::upper_bound(levels_.begin(), levels_.end(), level, later), level);
  }
  if (!levels.empty()) StartPinTimer();
}

void AvrCore::SettlePins() {
  for (const PinLevel& level : levels_) SetPin(level.port, level.bit, level.high);
  levels_.clear();
}

void AvrCore::StartPinTimer() {
  if (levels_.empty()) return;
  const std::uint64_t at = levels_.front().cycle;
  avr_cycle_timer_register(avr_, at > avr_->cycle ? at - avr_->cycle : 0, &Hooks::Pins, this);
}

bool AvrCore::Drives(char port, int bit) const {
  const bool b = port == 'B';
  const std::uint8_t levels = avr_->data[b ? kPortb : kPortd];
  return (avr_->data[b ? kDdrb : kDdrd] & levels & Bit(bit)) != 0;
}

double AvrCore::PwmDuty(int channel) const {
  const int pin = channel == 0 ? 1 : 2;
  if ((avr_->data[kDdrb] & Bit(pin)) == 0) return 0.0;
  const std::uint8_t a = avr_->data[kTccr1a], b = avr_->data[kTccr1b];
  const bool non_inverting = ((a >> (channel == 0 ? 6 : 4)) & 3) == 2;
  const int mode = ((b >> 3) & 3) << 2 | (a & 3);
  const bool runs = (b & 7) != 0;
  if (!non_inverting) return Drives('B', pin) ? 1.0 : 0.0;
  if (!runs || mode != 8 || top_ == 0) return 0.0;
  return static_cast<double>(std::min(compare_[channel], top_)) / static_cast<double>(top_);
}

std::uint8_t AvrCore::Memory(std::uint16_t address) const {
  TAUT_ASSERT(address < AvrProgram::kMemoryEnd);
  return avr_->data[address];
}

void AvrCore::SetMemory(std::uint16_t address, std::uint8_t value) {
  TAUT_ASSERT(address >= AvrProgram::kMemoryStart && address < AvrProgram::kMemoryEnd);
  avr_->data[address] = value;
}

void AvrCore::LoadEeprom(std::uint32_t offset, const std::vector<std::uint8_t>& bytes) {
  if (bytes.empty()) return;
  TAUT_ASSERT(offset + bytes.size() <= AvrProgram::kEepromBytes);
  std::vector<std::uint8_t> copy = bytes;
  avr_eeprom_desc_t range{copy.data(), static_cast<std::uint16_t>(offset),
                          static_cast<std::uint32_t>(copy.size())};
  avr_ioctl(avr_, AVR_IOCTL_EEPROM_SET, &range);
}

std::vector<std::uint8_t> AvrCore::Eeprom() const {
  std::vector<std::uint8_t> bytes(AvrProgram::kEepromBytes);
  avr_eeprom_desc_t range{bytes.data(), 0, static_cast<std::uint32_t>(bytes.size())};
  avr_ioctl(avr_, AVR_IOCTL_EEPROM_GET, &range);
  return bytes;
}

int AvrCore::DeepestStack() const {
  std::uint32_t address = free_memory_;
  while (address < AvrProgram::kMemoryEnd && avr_->data[address] == kPaint) ++address;
  return static_cast<int>(AvrProgram::kMemoryEnd - address);
}

}  // namespace taut::virtual_robot
