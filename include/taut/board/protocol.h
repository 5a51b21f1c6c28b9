/// Communication protocol between the PC and the motor boards over I2C, version 1. Firmware, driver
/// and virtual robot all use this definition. docs/hardware/protocol.md lists each byte.
///
/// Messages have at most 32 bytes; numbers are little endian. Freestanding C++14.
#pragma once

#include "taut/board/board_commands.h"
#include "taut/board/board_frames.h"
