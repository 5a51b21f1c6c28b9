/// A motor board: two motors, its modes, what it obeys and when it stops. All of the firmware but
/// the chip's registers, so that the same text runs on an ATmega328P, in its emulator and natively.
/// Freestanding C++14. docs/hardware/firmware.md.
///
/// Not for two threads; on the chip, all is called from the main loop, nothing from an interrupt.
#pragma once

#include "taut/board/requests.h"
#include "taut/board/state.h"
#include "taut/board/tick.h"
