/// Firmware of a motor board for two motors: modes, commands and safety reactions. It is everything
/// but access to the chip's registers, so that the same source runs on an ATmega328P, in its
/// emulator and natively. Freestanding C++14. docs/hardware/firmware.md.
///
/// Not thread safe; on the chip, all functions are called from the main loop, none from an
/// interrupt.
#pragma once

#include "taut/board/requests.h"
#include "taut/board/state.h"
#include "taut/board/tick.h"
