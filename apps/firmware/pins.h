// Pin assignment of the Arduino Nano (docs/hardware/firmware.md).
//
//   D2, D3    INT0, INT1   encoder A of motor 0, 1 (any edge)
//   D4, D5    PD4, PD5     encoder B of motor 0, 1
//   D6        PD6          driver enable, high: on (a resistor pulls it down while the chip starts)
//   D7, D8    PD7, PB0     direction of motor 0, 1, high: winds in
//   D9, D10   OC1A, OC1B   PWM of motor 0, 1
//   D12       PB4          nSF of the driver, low: fault
//   A0, A1    ADC0, ADC1   load cells
//   A4, A5    SDA, SCL     the bus
#pragma once

#include <avr/io.h>

constexpr uint8_t kEncoderB[2] = {1 << PD4, 1 << PD5};  // bits in PIND
constexpr uint8_t kEnable = 1 << PD6;                   // bit in PORTD
constexpr uint8_t kDirection0 = 1 << PD7;               // bit in PORTD
constexpr uint8_t kDirection1 = 1 << PB0;               // bit in PORTB
constexpr uint8_t kPwmPins = 1 << PB1 | 1 << PB2;       // bits in PORTB
constexpr uint8_t kDriverFaultPin = 1 << PB4;           // bit in PINB

// Progress marks in GPIOR0, a register without a pin, for emulators and debuggers.
enum Mark : uint8_t {
  kMarkTick = 0x10,      // start of a tick; low half: mode
  kMarkTickDone = 0x20,  // duties of the tick are set; low half: mode at its end
  kMarkIdle = 0x30,      // all work of the tick is done
  kMarkMessage = 0x40,   // start of processing a message
};
