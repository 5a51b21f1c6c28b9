// What a board keeps in its EEPROM: which board it is, how often it began, its parameters.
#pragma once

#include "taut/board/board.h"

// Reads identity and parameters, counts the boot. Takes some 14 ms; before the watchdog runs.
taut::board::Boot ReadMemory(taut::board::Parameters& parameters);

// Works on what `board.memory` wants; a byte each call at most, so that no tick waits.
void StepMemory(taut::board::Board& board);
