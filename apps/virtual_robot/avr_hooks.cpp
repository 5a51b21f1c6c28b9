#include "apps/virtual_robot/avr_hooks.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "base/assert.h"

namespace taut::virtual_robot {
namespace {

// Cycles before the first instruction of an interrupt, and additional cycles from sleep (data
// sheet, "Interrupt Response Time"). simavr counts none.
constexpr int kEntryCycles = 4, kWakeCycles = 4;

constexpr std::uint8_t kAdsc = 0x40;   // in ADCSRA: conversion in progress
constexpr std::uint8_t kAdlar = 0x20;  // in ADMUX: left-adjusted result
constexpr int kBandgapChannel = 14;
constexpr int kBandgapCode = 1100 * 1024 / 5000;

}  // namespace

avr_ioport_t* AvrCore::Hooks::FindPort(avr_t& avr, char name) {
  for (avr_io_t* one = avr.io_port; one; one = one->next) {
    if (std::string_view(one->kind) != "port") continue;
    auto* port = reinterpret_cast<avr_ioport_t*>(one);
    if (port->name == name) return port;
  }
  TAUT_ASSERT(false);
  return nullptr;
}

void AvrCore::Hooks::Install(AvrCore& core) {
  avr_t& avr = *core.avr_;
  OnWrite(avr, kGpior0, WriteMarker, &core);
  OnWrite(avr, kMcusr, WriteCauses, &core);
  OnRead(avr, kAdcl, ReadResultLow, &core);
  OnRead(avr, kAdch, ReadResultHigh, &core);
  // Timer 1 only generates the PWM, so that its registers suffice. simavr's timer would fire three
  // times per period of 50 us and counts this period wrong.
  for (const std::uint16_t address : {kTccr1a, kTccr1b, kTccr1c}) {
    OnWrite(avr, address, WritePlain, &core);
  }
  for (const std::uint16_t address : {kTcnt1h, kIcr1h, kOcr1ah, kOcr1bh}) {
    OnWrite(avr, address, WriteTimerHigh, &core);
  }
  for (const std::uint16_t address : {kTcnt1l, kIcr1l, kOcr1al, kOcr1bl}) {
    OnWrite(avr, address, WriteTimerLow, &core);
    OnRead(avr, address, nullptr, nullptr);
  }
  for (int i = 0; i < avr.interrupts.vector_count; ++i) {
    avr_irq_register_notify(avr.interrupts.vector[i]->irq + AVR_INT_IRQ_RUNNING, InterruptBegins,
                            &core);
  }
  avr_irq_t* begins = avr_io_getirq(&avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER);
  TAUT_ASSERT(begins != nullptr);
  avr_irq_register_notify(begins, ConversionBegins, &core);
}

void AvrCore::Hooks::Log(avr_t* avr, int level, const char* format, va_list arguments) {
  if (!avr || level > LOG_WARNING || !avr->custom.data) return;
  const AvrCore& core = Self(avr);
  if (!core.on_message) return;
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  std::string plain;
  for (const char* c = text; *c; ++c) {
    if (*c == '\033') {
      while (*c && *c != 'm') ++c;  // skips a color code
      if (!*c) break;
    } else if (*c != '\n') {
      plain += *c;
    }
  }
  core.on_message(plain);
}

avr_cycle_count_t AvrCore::Hooks::Stop(avr_t*, avr_cycle_count_t, void*) { return 0; }

avr_cycle_count_t AvrCore::Hooks::Pins(avr_t* avr, avr_cycle_count_t /*when*/, void* self) {
  AvrCore& core = *static_cast<AvrCore*>(self);
  if (core.levels_.empty()) return 0;
  const PinLevel level = core.levels_.front();
  core.levels_.pop_front();
  core.SetPin(level.port, level.bit, level.high);
  // One edge per cycle: the core's flags would merge two edges, and simavr requires a later time.
  if (core.levels_.empty()) return 0;
  return std::max<avr_cycle_count_t>(core.levels_.front().cycle, avr->cycle + 1);
}

void AvrCore::Hooks::InterruptBegins(avr_irq_t*, std::uint32_t value, void* self) {
  if (value == 0) return;
  AvrCore& core = *static_cast<AvrCore*>(self);
  avr_t& avr = *core.avr_;
  const std::uint64_t cycles = kEntryCycles + (core.asleep_ ? kWakeCycles : 0);
  avr.cycle += cycles;
  core.entered_ = true;
  avr.run_cycle_count = avr.run_cycle_count > cycles ? avr.run_cycle_count - cycles : 1;
}

void AvrCore::Hooks::ConversionBegins(avr_irq_t*, std::uint32_t, void* self) {
  AvrCore& core = *static_cast<AvrCore*>(self);
  if (!core.result_locked_) core.converted_ = core.converting_;
  const int channel = core.avr_->data[kAdmux] & 0x0F;
  if (channel == kBandgapChannel) {
    core.converting_ = kBandgapCode;
  } else if (channel < 8 && core.adc_code) {
    core.converting_ = core.adc_code(channel);
    TAUT_ASSERT(core.converting_ >= 0 && core.converting_ < 1024);
  } else {
    core.converting_ = 0;
  }
}

void AvrCore::Hooks::LatchResult(AvrCore& core) {
  const bool under_way = (core.avr_->data[kAdcsra] & kAdsc) != 0;
  if (!under_way && !core.result_locked_) core.converted_ = core.converting_;
}

std::uint8_t AvrCore::Hooks::ReadResultLow(avr_t* avr, avr_io_addr_t, void* self) {
  AvrCore& core = *static_cast<AvrCore*>(self);
  LatchResult(core);
  core.result_locked_ = true;
  const int shift = (avr->data[kAdmux] & kAdlar) != 0 ? 6 : 0;
  return static_cast<std::uint8_t>(core.converted_ << shift);
}

std::uint8_t AvrCore::Hooks::ReadResultHigh(avr_t* avr, avr_io_addr_t, void* self) {
  AvrCore& core = *static_cast<AvrCore*>(self);
  LatchResult(core);
  core.result_locked_ = false;
  const int shift = (avr->data[kAdmux] & kAdlar) != 0 ? 6 : 0;
  return static_cast<std::uint8_t>((core.converted_ << shift) >> 8);
}

void AvrCore::Hooks::WriteMarker(avr_t* avr, avr_io_addr_t address, std::uint8_t value,
                                 void* self) {
  avr->data[address] = value;
  const AvrCore& core = *static_cast<AvrCore*>(self);
  if (core.on_marker) core.on_marker(value);
}

void AvrCore::Hooks::WriteCauses(avr_t* avr, avr_io_addr_t address, std::uint8_t value,
                                 void* self) {
  AvrCore& core = *static_cast<AvrCore*>(self);
  core.causes_ &= value;  // a program can clear these bits, but not set them
  avr->data[address] = core.causes_;
}

void AvrCore::Hooks::WritePlain(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void*) {
  avr->data[address] = value;
}

void AvrCore::Hooks::WriteTimerHigh(avr_t*, avr_io_addr_t, std::uint8_t value, void* self) {
  static_cast<AvrCore*>(self)->temp_ = value;
}

void AvrCore::Hooks::WriteTimerLow(avr_t* avr, avr_io_addr_t address, std::uint8_t value,
                                   void* self) {
  AvrCore& core = *static_cast<AvrCore*>(self);
  const auto whole = static_cast<std::uint16_t>(core.temp_ << 8 | value);
  avr->data[address] = value;
  avr->data[address + 1] = core.temp_;
  if (address == kOcr1al) core.compare_[0] = whole;
  if (address == kOcr1bl) core.compare_[1] = whole;
  if (address == kIcr1l) core.top_ = whole;
}

}  // namespace taut::virtual_robot
