// Where the probe and its tests meet: the first 256 bytes of memory, which the linker leaves free.
// Plain C, for both compilers.
#pragma once

#include <stdint.h>

enum {
  kBoxId = 0x100,           // of the EEPROM
  kBoxCause = 0x101,        // MCUSR at the start
  kBoxBoots = 0x102,        // since power came
  kBoxTicks = 0x104,        // 4 bytes, of 1 kHz
  kBoxCounts = 0x108,       // 4 bytes a motor
  kBoxAdc = 0x110,          // 2 bytes a motor
  kBoxConversions = 0x114,  // 2 bytes
  kBoxStatusCount = 0x116,
  kBoxReceivedCount = 0x117,
  kBoxMissed = 0x118,  // milliseconds since the last broadcast, up to 255
  kBoxBandgap = 0x119,
  kBoxEarly = 0x11A,       // 2 bytes: what was read of a conversion that had just begun
  kBoxCausesRead = 0x11C,  // MCUSR after kOrderSetCauses
  // Orders of tests.
  kBoxStretch = 0x120,   // tens of microseconds that each interrupt of the bus takes longer
  kBoxNackFrom = 0x121,  // refuse this byte and those behind it; 0: take all
  kBoxLastByte = 0x122,  // say that this is the last byte to send; 0: never
  kBoxOrder = 0x123,     // what to do at the next tick: one of the below
  kBoxNewDuty = 0x124,   // 1: take over the four bytes below
  kBoxDuty = 0x126,      // 2 bytes a motor, 0..400
  kBoxWindsIn = 0x12A,   // bit m: of motor m
  kBoxEnable = 0x12B,
  kBoxLetGo = 0x12C,     // let go of the bus at this byte of a message; 0: never
  kBoxTimer1 = 0x12D,    // for kOrderTimer1: TCCR1A, TCCR1B
  kBoxStatus = 0x140,    // 32 bytes: what TWSR said, in a ring
  kBoxReceived = 0x160,  // 64 bytes: the last message
  kBoxSend = 0x1A0,      // 64 bytes: what reads get

  kOrderNone = 0,
  kOrderHang = 1,          // with interrupts off
  kOrderSleepForever = 2,  // the same
  kOrderLeave = 3,         // jump beyond the flash
  kOrderSetCauses = 4,     // write ones to MCUSR
  kOrderTimer1 = 5         // another mode
};
