// Load cells and encoders of a motor board.
#pragma once

#include <stdint.h>

void StartSensors();
// Starts the conversions of both load cells, one after the other (0.21 ms); called at the start of
// a tick.
void StartConversions();
// Returns the last conversion [counts].
uint16_t LoadCell(uint8_t motor);
// Returns the encoder's count, modulo 2^16.
uint16_t Encoder(uint8_t motor);
