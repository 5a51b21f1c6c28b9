/// Parameters of a motor board, stored in its EEPROM. To add a parameter, add one line to a list
/// below. All parameters are floats in the units of their keys. Freestanding C++14.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/board/crc.h"

/// Parameters of a motor: X(name, key, default, least, greatest). Each key ends with its unit.
/// Defaults marked "assumed" in docs/hardware/parameters.md are neither measured nor published.
#define TAUT_MOTOR_PARAMETERS(X)                                       \
  X(kTensionOffset, "tension_offset_n", 10.0f, 0.0f, 50.0f)            \
  X(kLengthOffset, "length_offset_m", 0.2f, 0.0f, 2.0f)                \
  X(kPositionGain, "position_gain_n_per_m", 100.0f, 0.0f, 5000.0f)     \
  X(kVelocityGain, "velocity_gain_n_s_per_m", 100.0f, 0.0f, 2000.0f)   \
  X(kForceP, "force_p_per_n", 0.06f, 0.0f, 10.0f)                      \
  X(kForceI, "force_i_per_n_s", 0.6f, 0.0f, 100.0f)                    \
  X(kForceD, "force_d_s_per_n", 0.0f, 0.0f, 1.0f)                      \
  X(kLengthP, "length_p_per_m", 400.0f, 0.0f, 10000.0f)                \
  X(kLengthI, "length_i_per_m_s", 4000.0f, 0.0f, 100000.0f)            \
  X(kLengthD, "length_d_s_per_m", 0.0f, 0.0f, 100.0f)                  \
  X(kNewtonsPerCount, "load_cell_n_per_count", 0.1567f, 0.001f, 10.0f) \
  X(kCountsAtZero, "load_cell_counts_at_zero", 31.5f, 0.0f, 1023.0f)   \
  X(kLengthPerCount, "encoder_m_per_count", 1.34e-5f, 1e-8f, 1e-3f)    \
  X(kReferenceLength, "rest_length_at_reference_m", 0.2f, 0.0f, 2.0f)  \
  X(kStiffness, "stiffness_n_per_m", 227.0f, 1.0f, 1e6f)               \
  X(kTensionShare, "tension_filter_share", 0.2f, 0.001f, 1.0f)         \
  X(kRateShare, "rate_filter_share", 0.1f, 0.001f, 1.0f)               \
  X(kWindingCounts, "winding_counts_per_count", 0.0f, 0.0f, 10.0f)     \
  X(kTensionLimit, "tension_limit_n", 50.0f, 1.0f, 110.0f)             \
  X(kTensionBand, "tension_band_n", 10.0f, 0.1f, 50.0f)                \
  X(kDutyLimit, "duty_limit", 1.0f, 0.0f, 1.0f)                        \
  X(kSpeedLimit, "speed_limit_m_per_s", 0.091f, 0.001f, 10.0f)         \
  X(kSlackWay, "slack_way_m", 0.03f, 0.001f, 1.0f)                     \
  X(kStallDuty, "stall_duty", 0.6f, 0.05f, 1.1f)

/// Parameters of the board.
#define TAUT_BOARD_PARAMETERS(X)                                       \
  X(kOnTimeout, "on_timeout_0_hold_1_off", 0.0f, 0.0f, 1.0f)           \
  X(kSupply, "supply_v", 12.0f, 5.0f, 28.0f)                           \
  X(kResistance, "winding_ohm", 19.8f, 0.1f, 1000.0f)                  \
  X(kBackEmf, "back_emf_v_s_per_m", 169.0f, 0.0f, 10000.0f)            \
  X(kWindingRise, "winding_to_housing_k_per_w", 10.0f, 0.01f, 1000.0f) \
  X(kHousingRise, "housing_to_air_k_per_w", 29.0f, 0.01f, 1000.0f)     \
  X(kWindingTime, "winding_time_s", 5.6f, 0.1f, 1000.0f)               \
  X(kHousingTime, "housing_time_s", 220.0f, 1.0f, 10000.0f)            \
  X(kAirTemperature, "air_temperature_c", 25.0f, -40.0f, 60.0f)        \
  X(kTemperatureLimit, "winding_limit_c", 110.0f, 40.0f, 155.0f)

namespace taut {
namespace board {

/// Numbers of motor parameters in messages. The first `kGains` may be set while a motor runs; their
/// effective values then change slowly.
enum MotorParameter : uint8_t {
#define TAUT_MOTOR_ENUM(name, key, value, least, greatest) name,
  TAUT_MOTOR_PARAMETERS(TAUT_MOTOR_ENUM)
#undef TAUT_MOTOR_ENUM
      kMotorParameters
};
constexpr uint8_t kGains = 4;

/// Numbers of board parameters in messages.
enum BoardParameter : uint8_t {
#define TAUT_BOARD_ENUM(name, key, value, least, greatest) name,
  TAUT_BOARD_PARAMETERS(TAUT_BOARD_ENUM)
#undef TAUT_BOARD_ENUM
      kBoardParameters
};

/// Default and limits of a parameter.
struct Range {
  float value, least, greatest;
};

/// Returns default and limits of a parameter. Code instead of a table, since an AVR keeps tables in
/// RAM.
constexpr Range MotorRange(uint8_t parameter) noexcept {
  Range range{0.0f, 0.0f, 0.0f};
  switch (parameter) {
#define TAUT_CASE(name, key, usual, low, high) \
  case name:                                   \
    range.value = usual;                       \
    range.least = low;                         \
    range.greatest = high;                     \
    break;
    TAUT_MOTOR_PARAMETERS(TAUT_CASE)
    default:
      break;
  }
  return range;
}
constexpr Range BoardRange(uint8_t parameter) noexcept {
  Range range{0.0f, 0.0f, 0.0f};
  switch (parameter) {
    TAUT_BOARD_PARAMETERS(TAUT_CASE)
#undef TAUT_CASE
    default:
      break;
  }
  return range;
}

/// All parameters of a board, as stored in its EEPROM.
struct Parameters {
  float motor[2][kMotorParameters];
  float board[kBoardParameters];
};

/// Sets all parameters to their defaults.
constexpr void SetDefaults(Parameters& all) noexcept {
  for (uint8_t i = 0; i < kMotorParameters; ++i) {
    all.motor[0][i] = all.motor[1][i] = MotorRange(i).value;
  }
  for (uint8_t i = 0; i < kBoardParameters; ++i) all.board[i] = BoardRange(i).value;
}

/// Returns whether a value is within its limits; false for NaN.
constexpr bool IsWithin(const Range& range, float value) noexcept {
  return value >= range.least && value <= range.greatest;
}

/// Checksum of parameter names and their order. If PC and board have different checksums, parameter
/// numbers have different meanings on them.
constexpr uint16_t kParametersVersion = 0x5bee;

#ifndef __AVR__  // on an AVR, strings take RAM, even if used only at compile time
namespace internal {

constexpr uint16_t AddKey(uint16_t crc, const char* key) noexcept {
  for (; *key != '\0'; ++key) crc = AddToCrc16(crc, static_cast<uint8_t>(*key));
  return crc;
}
constexpr uint16_t VersionOfParameters() noexcept {
  uint16_t crc = kCrc16Start;
#define TAUT_ADD(name, key, value, least, greatest) crc = AddKey(crc, key);
  TAUT_MOTOR_PARAMETERS(TAUT_ADD)
  TAUT_BOARD_PARAMETERS(TAUT_ADD)
#undef TAUT_ADD
  return crc;
}
template <uint16_t kIs>
struct TheParametersVersion {
  static_assert(kIs == kParametersVersion, "kParametersVersion has to become kIs");
};
template struct TheParametersVersion<VersionOfParameters()>;

}  // namespace internal
#endif

}  // namespace board
}  // namespace taut
