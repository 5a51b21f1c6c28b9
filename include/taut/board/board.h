/// Firmware of a board for two motors: modes, commands and safety reactions. Only access to the
/// registers of the chip is elsewhere, so the same source runs on an ATmega328P, in an emulator of
/// it and on a PC. Freestanding C++14. See docs/hardware/firmware.md.
///
/// Not thread safe. On the chip, only the main loop calls these functions, never an interrupt.
#pragma once

#include "taut/board/requests.h"
#include "taut/board/state.h"
#include "taut/board/tick.h"
