/// Firmware of a board for two motors: modes, commands and safety reactions. Access to chip
/// registers is in other files, so this source runs on an ATmega328P, in an emulator and on a PC.
/// Freestanding C++14. See docs/hardware/firmware.md.
///
/// Not thread safe. On the chip, only the main loop calls these functions, never an interrupt.
#pragma once

#include "taut/board/requests.h"
#include "taut/board/state.h"
#include "taut/board/tick.h"
