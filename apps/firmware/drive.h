// Motor driver MC33926: PWM at 20 kHz, as in Pololu's library; duty 0 brakes.
#pragma once

#include <stdint.h>

void StartDrive();
// Sets the PWM width of motor 0 or 1, from -kFullWidth to kFullWidth; positive winds in.
void SetWidth(uint8_t motor, int16_t width);
void SetPower(bool on);
bool DriverSaysFault();
