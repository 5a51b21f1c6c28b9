/// Wrapper of libsimavr's C headers, with compiler warnings disabled. GPL-3: only the virtual robot
/// may include this file.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
extern "C" {
#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_twi.h>
#include <simavr/sim_avr.h>
}
#pragma GCC diagnostic pop

namespace taut::virtual_robot {

/// Addresses of registers in the data space (data sheet, "Register Summary").
enum Register : std::uint16_t {
  kPind = 0x29,
  kDdrb = 0x24,
  kPortb = 0x25,
  kDdrd = 0x2A,
  kPortd = 0x2B,
  kGpior0 = 0x3E,
  kGpior1 = 0x4A,
  kMcusr = 0x54,
  kAdcl = 0x78,
  kAdch = 0x79,
  kAdcsra = 0x7A,
  kAdmux = 0x7C,
  kTccr1a = 0x80,
  kTccr1b = 0x81,
  kTccr1c = 0x82,
  kTcnt1l = 0x84,
  kTcnt1h = 0x85,
  kIcr1l = 0x86,
  kIcr1h = 0x87,
  kOcr1al = 0x88,
  kOcr1ah = 0x89,
  kOcr1bl = 0x8A,
  kOcr1bh = 0x8B,
  kTwbr = 0xB8,
  kTwsr = 0xB9,
  kTwar = 0xBA,
  kTwdr = 0xBB,
  kTwcr = 0xBC,
  kTwamr = 0xBD
};

/// Returns the peripheral of a kind in `avr`; null if there is none.
inline avr_io_t* FindPeripheral(avr_t& avr, const char* kind) {
  for (avr_io_t* one = avr.io_port; one; one = one->next) {
    const char *a = one->kind, *b = kind;
    while (*a && *a == *b) ++a, ++b;
    if (*a == *b) return one;
  }
  return nullptr;
}

/// Sets a register's write handler in simavr's tables, because simavr's functions refuse to replace
/// a handler.
inline void OnWrite(avr_t& avr, std::uint16_t address, avr_io_write_t handler, void* self) {
  avr.io[AVR_DATA_TO_IO(address)].w.c = handler;
  avr.io[AVR_DATA_TO_IO(address)].w.param = self;
}
inline void OnRead(avr_t& avr, std::uint16_t address, avr_io_read_t handler, void* self) {
  avr.io[AVR_DATA_TO_IO(address)].r.c = handler;
  avr.io[AVR_DATA_TO_IO(address)].r.param = self;
}

}  // namespace taut::virtual_robot
