// Memory shared by the probe and its tests: the first 256 bytes, which the linker leaves free.
// Plain C, for both compilers.
#pragma once

#include <stdint.h>

enum {
  kBoxId = 0x100,           // from the EEPROM
  kBoxCause = 0x101,        // MCUSR at the start
  kBoxBoots = 0x102,        // starts since power on
  kBoxTicks = 0x104,        // 4 bytes, 1 kHz
  kBoxCounts = 0x108,       // 4 bytes per motor
  kBoxAdc = 0x110,          // 2 bytes per motor
  kBoxConversions = 0x114,  // 2 bytes
  kBoxStatusCount = 0x116,
  kBoxReceivedCount = 0x117,
  kBoxMissed = 0x118,  // milliseconds since the last broadcast, up to 255
  kBoxBandgap = 0x119,
  kBoxEarly = 0x11A,       // 2 bytes: value read directly after the start of a conversion
  kBoxCausesRead = 0x11C,  // MCUSR after kOrderSetCauses
  // Orders of tests
  kBoxStretch = 0x120,   // tens of microseconds added to each interrupt of the bus
  kBoxNackFrom = 0x121,  // refuse this byte and later ones; 0: take all
  kBoxLastByte = 0x122,  // mark this as the last byte to send; 0: never
  kBoxOrder = 0x123,     // action at the next tick: one of the orders below
  kBoxNewDuty = 0x124,   // 1: apply the four values below
  kBoxDuty = 0x126,      // 2 bytes per motor, 0..400
  kBoxWindsIn = 0x12A,   // bit m: motor m
  kBoxEnable = 0x12B,
  kBoxLetGo = 0x12C,     // leave the bus at this byte of a message; 0: never
  kBoxTimer1 = 0x12D,    // for kOrderTimer1: TCCR1A, TCCR1B
  kBoxStatus = 0x140,    // 32 bytes: values of TWSR, in a ring
  kBoxReceived = 0x160,  // 64 bytes: the last message
  kBoxSend = 0x1A0,      // 64 bytes: data for reads

  kOrderNone = 0,
  kOrderHang = 1,          // with interrupts off
  kOrderSleepForever = 2,  // the same
  kOrderLeave = 3,         // jump beyond the flash
  kOrderSetCauses = 4,     // write ones to MCUSR
  kOrderTimer1 = 5         // another mode
};
