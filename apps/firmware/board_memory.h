// EEPROM of a board: its identity, number of boots and parameters.
#pragma once

#include "taut/board/board.h"

// Reads identity and parameters and counts the boot. Takes about 14 ms; to be called before the
// watchdog is enabled.
taut::board::Boot ReadMemory(taut::board::Parameters& parameters);

// Executes the request in `board.memory`, at most one byte per call, so that no tick is delayed.
void StepMemory(taut::board::Board& board);
