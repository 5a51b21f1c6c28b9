/// Callbacks of simavr for an AvrCore.
#pragma once

#include <cstdarg>
#include <cstdint>

#include "apps/virtual_robot/avr_core.h"
#include "apps/virtual_robot/simavr.h"

namespace taut::virtual_robot {

struct AvrCore::Hooks {
  static AvrCore& Self(avr_t* avr) { return *static_cast<AvrCore*>(avr->custom.data); }
  static avr_ioport_t* FindPort(avr_t& avr, char name);
  static void Install(AvrCore& core);

  static void Log(avr_t* avr, int level, const char* format, va_list arguments);
  static avr_cycle_count_t Stop(avr_t* avr, avr_cycle_count_t when, void* core);
  static avr_cycle_count_t Pins(avr_t* avr, avr_cycle_count_t when, void* core);
  static void InterruptBegins(avr_irq_t* irq, std::uint32_t value, void* core);
  static void ConversionBegins(avr_irq_t* irq, std::uint32_t value, void* core);

  static std::uint8_t ReadResultLow(avr_t* avr, avr_io_addr_t address, void* core);
  static std::uint8_t ReadResultHigh(avr_t* avr, avr_io_addr_t address, void* core);
  static void LatchResult(AvrCore& core);

  static void WriteMarker(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* core);
  static void WriteCauses(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* core);
  static void WritePlain(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* core);
  static void WriteTimerHigh(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* core);
  static void WriteTimerLow(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* core);
};

}  // namespace taut::virtual_robot
