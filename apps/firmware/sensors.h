// Load cells and encoders.
#pragma once

#include <stdint.h>

void StartSensors();
// Converts both load cells, one after the other (0.21 ms); called at the start of a tick.
void StartConversions();
// As converted last.
uint16_t LoadCell(uint8_t motor);
// Modulo 2^16.
uint16_t Encoder(uint8_t motor);
