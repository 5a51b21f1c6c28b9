/// What can be wrong with a board and its motors. Latched: it stays until it is cleared.
#pragma once

#include <stdint.h>

namespace taut {
namespace board {

/// Of a motor. It then has no power (duty 0, which brakes); the board's other motor holds.
enum MotorFault : uint8_t {
  kOverTension = 1,  ///< Five readings above the limit. Pays out until below limit and band.
  kSensor = 2,  ///< The amplifier at an end of its range in five readings, or a reading that stands
                ///< still while much is wound in.
  kSlack = 4,   ///< Wound in a long way and still no tension: the cable is cut.
  kStall = 8,   ///< Much duty for 100 ms and not one count: blocked, or the encoder is dead.
  kPolarity = 16,  ///< Much duty for 100 ms and it runs the other way.
  kRunaway = 32,   ///< Faster than 1.3 times what the motor can.
  kHot = 64,       ///< The winding's temperature, as computed, above its limit.
};

/// Of a board.
enum BoardFault : uint8_t {
  kDriverFault = 1,      ///< The driver says so (nSF): all off.
  kTooManyOverruns = 2,  ///< More than 5 % of the ticks of a second came late.
  kParametersLost = 4,   ///< The EEPROM's checksum is wrong: defaults are in use.
  kUnreferenced = 8,     ///< Told to go to a position without knowing where it is.
  kNotArmed = 16,        ///< Told to run without the two steps of arming.
  kBusStuck = 32,        ///< The bus had to be recovered.
};

/// Which the bits of an ATmega328P's MCUSR are, as a board reports why it began.
enum ResetCause : uint8_t { kPowerOn = 1, kExternal = 2, kBrownOut = 4, kWatchdog = 8 };

}  // namespace board
}  // namespace taut
