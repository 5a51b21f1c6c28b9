/// Fault bits of a board and its motors. Latched until cleared.
#pragma once

#include <stdint.h>

namespace taut {
namespace board {

/// Faults of a motor. The motor then has no power (duty 0, which brakes); the board's other motor
/// holds.
enum MotorFault : uint8_t {
  kOverTension = 1,  ///< Five readings above the limit. Pays out until below limit minus band.
  /// Five readings at an end of the amplifier's range, or an unchanged reading while the cable is
  /// wound in far.
  kSensor = 2,
  kSlack = 4,  ///< No tension after winding in far: the cable is cut.
  /// High duty for 100 ms without an encoder count: blocked motor or defective encoder.
  kStall = 8,
  kPolarity = 16,  ///< High duty for 100 ms with motion in the opposite direction.
  kRunaway = 32,   ///< Faster than 1.3 times the motor's maximum speed.
  kHot = 64,       ///< Computed temperature of the winding above its limit.
};

/// Faults of a board.
enum BoardFault : uint8_t {
  kDriverFault = 1,      ///< Fault signal of the driver (nSF): all off.
  kTooManyOverruns = 2,  ///< More than 5 % of the ticks of a second were late.
  kParametersLost = 4,   ///< Wrong checksum of the EEPROM: defaults are used.
  kUnreferenced = 8,     ///< Position command without a reference of the encoder.
  kNotArmed = 16,        ///< Command to run without the two steps of arming.
  kBusStuck = 32,        ///< The bus had to be restarted.
};

/// Causes of a board's last reset: bits of MCUSR of an ATmega328P.
enum ResetCause : uint8_t { kPowerOn = 1, kExternal = 2, kBrownOut = 4, kWatchdog = 8 };

}  // namespace board
}  // namespace taut
