/// Fault bits of a board and its motors. The bits stay set until they are cleared.
#pragma once

#include <stdint.h>

namespace taut {
namespace board {

/// Faults of a motor. A motor with a fault brakes (duty 0), and the other motor of the board holds
/// its position.
enum MotorFault : uint8_t {
  /// Five successive tension readings above the limit. The motor unwinds until the tension is below
  /// the limit minus `kTensionBand`.
  kOverTension = 1,
  /// Five successive readings outside the valid range of the load cell, or the same reading while
  /// the motor winds in more than `kSlackWay`.
  kSensor = 2,
  kSlack = 4,  ///< No tension after winding in more than `kSlackWay`: probably a broken cable.
  /// High duty for 100 ms without an encoder count: blocked motor or defective encoder.
  kStall = 8,
  kPolarity = 16,  ///< High duty for 100 ms, but the motor turns in the opposite direction.
  /// Five successive ticks with a speed above `kSpeedLimit`, 1.3 times the maximum speed of the
  /// motor by default.
  kRunaway = 32,
  kHot = 64,  ///< Computed winding temperature above its limit.
};

/// Faults of a board.
enum BoardFault : uint8_t {
  kDriverFault = 1,      ///< Fault signal of the driver (nSF). The driver is switched off.
  kTooManyOverruns = 2,  ///< More than 5 % of the ticks of a second were late.
  kParametersLost = 4,   ///< Wrong EEPROM checksum; the defaults are in use.
  kUnreferenced = 8,     ///< Position command before the encoder reference was set.
  kNotArmed = 16,        ///< Command to run before both steps of arming.
  kBusStuck = 32,        ///< The I2C bus was restarted.
};

#ifndef __AVR__  // on an AVR, strings take RAM
/// Names of the faults in messages, in the order of the bits, least significant bit first.
constexpr const char* kMotorFaultNames[] = {"over_tension", "sensor",  "slack", "stall",
                                            "polarity",     "runaway", "hot"};
constexpr const char* kBoardFaultNames[] = {"driver",       "overruns",  "parameters_lost",
                                            "unreferenced", "not_armed", "bus_stuck"};
#endif

/// Causes of a board's last reset: bits of MCUSR of an ATmega328P.
enum ResetCause : uint8_t { kPowerOn = 1, kExternal = 2, kBrownOut = 4, kWatchdog = 8 };

}  // namespace board
}  // namespace taut
