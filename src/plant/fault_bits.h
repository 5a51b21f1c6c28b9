/// Faults of motor boards as `FaultBits` of observations.
#pragma once

#include <cstdint>

#include "taut/board/faults.h"
#include "taut/plant.h"

namespace taut::plant {

/// Returns the `FaultBits` of a motor with these `board::MotorFault` bits.
constexpr std::uint32_t FaultBitsOf(std::uint8_t motor_faults) noexcept {
  std::uint32_t bits = kFaultNone;
  if ((motor_faults & board::kSensor) != 0) bits |= kFaultSensor;
  if ((motor_faults & ~board::kSensor) != 0) bits |= kFaultActuator;
  return bits;
}

}  // namespace taut::plant
