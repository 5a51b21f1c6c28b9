// The motors' driver: 20 kHz, as Pololu's library for the MC33926 does it; duty 0 brakes.
#pragma once

#include <stdint.h>

void StartDrive();
// Of motor 0 or 1, -kFullWidth .. kFullWidth, winding in positive.
void SetWidth(uint8_t motor, int16_t width);
void SetPower(bool on);
bool DriverSaysFault();
