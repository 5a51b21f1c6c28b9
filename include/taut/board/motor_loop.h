/// Motor control loop of a board at 1 kHz: evaluates load cell and encoder and computes the duty by
/// the laws of include/taut/control (paper section III). Freestanding C++14; float arithmetic gives
/// the same bits on an AVR and on a PC.
#pragma once

#include <stdint.h>

#include "taut/board/parameters.h"
#include "taut/control/filter.h"
#include "taut/control/impedance.h"
#include "taut/control/pid.h"

namespace taut {
namespace board {

constexpr float kTick_s = 0.001f;
constexpr int16_t kFullWidth = 400;  ///< Steps of the PWM at full duty.

/// A motor's parameters in the units of its loop. Computed when a parameter changes, since a
/// division takes 30 us.
struct LoopNumbers {
  /// From N and from counts to steps of the PWM; time in units of `kHalfTick_s`.
  control::Pid<float> force, length;
  float limit_counts;             ///< Of the load cell: winding in stops here.
  float band_from_counts;         ///< Of the load cell: winding in is reduced from here on.
  float most, most_per_count;     ///< Largest drive [steps of the PWM], and per count of the band.
  float counts_per_n;             ///< Of the load cell.
  float speed_per_count_m_per_s;  ///< Rate of lengthening for one count per tick.
};

/// Time unit of the PIDs: half a tick. Their period is 2, so that the compiler removes
/// multiplications by half a period. For the same reason errors are in counts of the sensors and
/// outputs in steps of the PWM.
constexpr float kHalfTick_s = 0.5f * kTick_s;
constexpr float kPeriod = 2.0f;

/// Converts gains from duty per unit of error to steps of the PWM and half ticks.
inline control::Pid<float> InSteps(float per_unit, float p, float i, float d) noexcept {
  const float scale = per_unit * static_cast<float>(kFullWidth);
  return control::Pid<float>{scale * p, scale * (i * kHalfTick_s), scale * (d / kHalfTick_s)};
}

/// Computes the loop's numbers from a motor's parameters.
inline LoopNumbers NumbersOf(const float* p) noexcept {
  const float counts_per_n = 1.0f / p[kNewtonsPerCount];
  LoopNumbers numbers;
  numbers.force = InSteps(1.0f, p[kForceP], p[kForceI], p[kForceD]);
  numbers.length = InSteps(p[kLengthPerCount], p[kLengthP], p[kLengthI], p[kLengthD]);
  numbers.counts_per_n = counts_per_n;
  numbers.limit_counts = p[kCountsAtZero] + p[kTensionLimit] * counts_per_n;
  const float band_counts = p[kTensionBand] * counts_per_n;
  numbers.band_from_counts = numbers.limit_counts - band_counts;
  numbers.most = p[kDutyLimit] * static_cast<float>(kFullWidth);
  numbers.most_per_count = numbers.most / band_counts;
  numbers.speed_per_count_m_per_s = -p[kLengthPerCount] / kTick_s;
  return numbers;
}

/// State of a motor's loop.
struct MotorLoop {
  // measured
  uint16_t encoder = 0;         ///< Last reading, modulo 2^16.
  int16_t step = 0;             ///< Counts since the previous tick.
  int32_t counts = 0;           ///< From the reference; winding in is positive.
  float tension_counts = 0.0f;  ///< Filtered.
  // for impedance control only, so that other modes have no cost
  float counts_per_tick = 0.0f;  ///< Filtered.
  float tension_n = 0.0f, rest_length_m = 0.0f, length_m = 0.0f, rate_m_per_s = 0.0f;
  // commanded
  int32_t target_counts = 0;
  float velocity_input_m_per_s = 0.0f;  ///< V0.
  float drive_input = 0.0f;
  control::Impedance<float> gains{};  ///< Gains now in effect.
  // results
  control::PidState<float> pid{};
  float set_point_n = 0.0f;
  float drive = 0.0f;  ///< Steps of the PWM, winding in is positive.
  int16_t width = 0;   ///< `drive`, truncated.
};

/// Updates sensor values. `adc`: 0 .. 1023; `encoder`: modulo 2^16.
inline void Sense(const float* p, uint16_t adc, uint16_t encoder, MotorLoop& motor) noexcept {
  motor.step = static_cast<int16_t>(static_cast<uint16_t>(encoder - motor.encoder));
  motor.encoder = encoder;
  motor.counts += motor.step;
  const float measured = static_cast<float>(adc);
  if (p[kWindingCounts] > 0.0f) {
    control::StepComplementary(motor.tension_counts, measured,
                               static_cast<float>(motor.step) * p[kWindingCounts],
                               p[kTensionShare]);
  } else {
    control::StepLowPass(motor.tension_counts, measured, p[kTensionShare]);
  }
}

/// Returns the filtered tension [N].
inline float Tension(const float* p, const MotorLoop& motor) noexcept {
  return (motor.tension_counts - p[kCountsAtZero]) * p[kNewtonsPerCount];
}

/// Computes the quantities of impedance control that position control does not use (the paper: it
/// "consumes additional computational time"). The rate is the rest length's rate: the spring's rate
/// is below the resolution of the load cell.
inline void SenseCable(const float* p, const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  control::StepLowPass(motor.counts_per_tick, static_cast<float>(motor.step), p[kRateShare]);
  motor.rate_m_per_s = motor.counts_per_tick * numbers.speed_per_count_m_per_s;
  motor.tension_n = Tension(p, motor);
  motor.rest_length_m = p[kReferenceLength] - static_cast<float>(motor.counts) * p[kLengthPerCount];
  motor.length_m = control::LengthFromTension(motor.rest_length_m, motor.tension_n, p[kStiffness]);
}

/// Returns the limits of the drive: winding in decreases linearly in the band below the tension
/// limit, to 0 at the limit.
inline control::OutputLimits<float> DriveLimits(const LoopNumbers& numbers,
                                                const MotorLoop& motor) noexcept {
  float winding = numbers.most;
  if (motor.tension_counts > numbers.band_from_counts) {
    const float room = numbers.limit_counts - motor.tension_counts;
    winding = room > 0.0f ? numbers.most_per_count * room : 0.0f;
  }
  return control::OutputLimits<float>{-numbers.most, winding};
}

/// Returns the rest length minus its target [counts]: the length to wind in.
inline float LengthError(const MotorLoop& motor) noexcept {
  return static_cast<float>(motor.target_counts - motor.counts);
}

/// Starts position control with the present drive (bumpless transfer).
inline void StartPosition(const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  motor.set_point_n = 0.0f;
  motor.pid = control::StartPidFrom(numbers.length, LengthError(motor), motor.drive, kPeriod);
}
/// Computes the drive of one tick of position control.
inline void StepPosition(const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  motor.drive = control::StepPidLimited(numbers.length, motor.pid, LengthError(motor), kPeriod,
                                        DriveLimits(numbers, motor), control::Windup::kHeld);
}

/// Computes the tension set point (paper eq. 3).
inline void FindSetPoint(MotorLoop& motor) noexcept {
  motor.set_point_n = control::ImpedanceTension(motor.gains, motor.length_m, motor.rate_m_per_s,
                                                motor.velocity_input_m_per_s);
}

/// Starts impedance control with the present drive (bumpless transfer). `capture`: the measured
/// length and tension become L0 and T0, also in the parameters; T0 is limited to its range, so that
/// a higher tension is reduced.
inline void StartImpedance(float* p, const LoopNumbers& numbers, bool capture,
                           MotorLoop& motor) noexcept {
  motor.counts_per_tick = 0.0f;  // one count of a motor that holds would count as 13 mm/s
  SenseCable(p, numbers, motor);
  if (capture) {
    const Range range = MotorRange(kTensionOffset);
    p[kTensionOffset] = control::Clamp(motor.tension_n, range.least, range.greatest);
    p[kLengthOffset] = motor.length_m;
  }
  motor.gains = control::Impedance<float>{p[kTensionOffset], p[kLengthOffset], p[kPositionGain],
                                          p[kVelocityGain]};
  FindSetPoint(motor);
  motor.pid = control::StartPidFrom(numbers.force, motor.set_point_n - motor.tension_n, motor.drive,
                                    kPeriod);
}
/// Computes the drive of one tick of impedance control.
inline void StepImpedance(const float* p, const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  SenseCable(p, numbers, motor);
  FindSetPoint(motor);
  motor.drive =
      control::StepPidLimited(numbers.force, motor.pid, motor.set_point_n - motor.tension_n,
                              kPeriod, DriveLimits(numbers, motor), control::Windup::kHeld);
}

/// Sets the commanded duty as drive, within its limits.
inline void StepDuty(const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  const control::OutputLimits<float> limits = DriveLimits(numbers, motor);
  motor.drive = control::Clamp(motor.drive_input, limits.low, limits.high);
}

namespace internal {

inline float Towards(float from, float to, float most) noexcept {
  return from + control::Clamp(to - from, -most, most);
}

}  // namespace internal

/// Moves a gain toward its parameter, within about a second, if it was set while the motor runs.
/// One gain per call, `which` = 0 .. 3; `share_s`: time since the previous call for this gain.
inline void SlewGain(const float* p, uint8_t which, float share_s, MotorLoop& motor) noexcept {
  control::Impedance<float>& gains = motor.gains;
  switch (which) {
    case 0:
      gains.tension_offset_n =
          internal::Towards(gains.tension_offset_n, p[kTensionOffset], 20.0f * share_s);
      break;
    case 1:
      gains.length_offset_m =
          internal::Towards(gains.length_offset_m, p[kLengthOffset], 0.05f * share_s);
      break;
    case 2:
      gains.position_gain_n_per_m =
          internal::Towards(gains.position_gain_n_per_m, p[kPositionGain], 500.0f * share_s);
      break;
    default:
      gains.velocity_gain_n_s_per_m =
          internal::Towards(gains.velocity_gain_n_s_per_m, p[kVelocityGain], 500.0f * share_s);
  }
}

}  // namespace board
}  // namespace taut
