/// Motor control loop of a board at 1 kHz. The loop evaluates the load cell and the encoder and
/// computes the duty with the control laws of include/taut/control (Mirletz et al. 2015, section
/// III). Freestanding C++14; float arithmetic gives the same bits on an AVR and on a PC.
#pragma once

#include <stdint.h>

#include "taut/board/parameters.h"
#include "taut/control/filter.h"
#include "taut/control/impedance.h"
#include "taut/control/pid.h"

namespace taut {
namespace board {

constexpr float kTick_s = 0.001f;
constexpr int16_t kFullWidth = 400;  ///< PWM steps at full duty.

/// Parameters of a motor in the units of the control loop. Updated only when a parameter changes,
/// since a division takes 30 us.
struct LoopNumbers {
  /// Gains from tension [N] and from encoder counts to PWM steps. Time unit: `kHalfTick_s`.
  control::Pid<float> force, length;
  float limit_counts;      ///< ADC count of the load cell at which winding in stops.
  float band_from_counts;  ///< ADC count above which winding in is reduced.
  /// Largest drive [PWM steps], and its slope within the band [PWM steps per ADC count].
  float most_drive, drive_per_count;
  float counts_per_n;             ///< ADC counts of the load cell per newton.
  float speed_per_count_m_per_s;  ///< Rate of lengthening at one encoder count per tick.
};

/// Time unit of the PID controllers: half a tick. In this unit, their period is 2, so the compiler
/// removes multiplications by half a period. To save further multiplications, errors are in sensor
/// counts and outputs in PWM steps.
constexpr float kHalfTick_s = 0.5f * kTick_s;
constexpr float kPeriod = 2.0f;

/// Converts gains from duty, unit of error and seconds to PWM steps, counts and half ticks.
inline control::Pid<float> InSteps(float per_unit, float p, float i, float d) noexcept {
  const float scale = per_unit * static_cast<float>(kFullWidth);
  return control::Pid<float>{scale * p, scale * (i * kHalfTick_s), scale * (d / kHalfTick_s)};
}

/// Computes `LoopNumbers` from the parameters of a motor.
inline LoopNumbers NumbersOf(const float* p) noexcept {
  const float counts_per_n = 1.0f / p[kNewtonsPerCount];
  LoopNumbers numbers;
  numbers.force = InSteps(1.0f, p[kForceP], p[kForceI], p[kForceD]);
  numbers.length = InSteps(p[kLengthPerCount], p[kLengthP], p[kLengthI], p[kLengthD]);
  numbers.counts_per_n = counts_per_n;
  numbers.limit_counts = p[kCountsAtZero] + p[kTensionLimit] * counts_per_n;
  const float band_counts = p[kTensionBand] * counts_per_n;
  numbers.band_from_counts = numbers.limit_counts - band_counts;
  numbers.most_drive = p[kDutyLimit] * static_cast<float>(kFullWidth);
  numbers.drive_per_count = numbers.most_drive / band_counts;
  numbers.speed_per_count_m_per_s = -p[kLengthPerCount] / kTick_s;
  return numbers;
}

/// State of the control loop of one motor.
struct MotorLoop {
  // Measured values.
  uint16_t encoder = 0;         ///< Last reading, modulo 2^16.
  int16_t step = 0;             ///< Encoder counts since the previous tick.
  int32_t counts = 0;           ///< Relative to the reference position; winding in is positive.
  float tension_counts = 0.0f;  ///< Filtered load cell reading [ADC counts].
  // Values for impedance control only; other modes do not compute them.
  float counts_per_tick = 0.0f;  ///< Filtered encoder rate.
  float tension_n = 0.0f, rest_length_m = 0.0f, length_m = 0.0f, rate_m_per_s = 0.0f;
  // Commanded values.
  int32_t target_counts = 0;
  float velocity_input_m_per_s = 0.0f;  ///< V0 of impedance control.
  float drive_input = 0.0f;
  control::Impedance<float> gains{};  ///< Effective gains; they follow the parameters slowly.
  // Results of the control law.
  control::PidState<float> pid{};
  float set_point_n = 0.0f;
  float drive = 0.0f;  ///< PWM steps; winding in is positive.
  int16_t width = 0;   ///< `drive`, truncated to an integer.
};

/// Processes new sensor values. `adc`: 0 .. 1023; `encoder`: modulo 2^16.
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

/// Computes length, rate and tension for impedance control. Position control skips this computation
/// to save time on the chip. The rate is the rate of the rest length, because the load cell cannot
/// resolve the rate of the spring's extension.
inline void SenseCable(const float* p, const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  control::StepLowPass(motor.counts_per_tick, static_cast<float>(motor.step), p[kRateShare]);
  motor.rate_m_per_s = motor.counts_per_tick * numbers.speed_per_count_m_per_s;
  motor.tension_n = Tension(p, motor);
  motor.rest_length_m = p[kReferenceLength] - static_cast<float>(motor.counts) * p[kLengthPerCount];
  motor.length_m = control::LengthFromTension(motor.rest_length_m, motor.tension_n, p[kStiffness]);
}

/// Returns the limits of the drive. In the band below the tension limit, the limit for winding in
/// decreases linearly to 0.
inline control::OutputLimits<float> DriveLimits(const LoopNumbers& numbers,
                                                const MotorLoop& motor) noexcept {
  float winding = numbers.most_drive;
  if (motor.tension_counts > numbers.band_from_counts) {
    const float room = numbers.limit_counts - motor.tension_counts;
    winding = room > 0.0f ? numbers.drive_per_count * room : 0.0f;
  }
  return control::OutputLimits<float>{-numbers.most_drive, winding};
}

/// Returns the rest length minus its target [encoder counts]; positive: wind in.
inline float LengthError(const MotorLoop& motor) noexcept {
  return static_cast<float>(motor.target_counts - motor.counts);
}

/// Starts position control from the present drive (bumpless transfer).
inline void StartPosition(const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  motor.set_point_n = 0.0f;
  motor.pid = control::StartPidFrom(numbers.length, LengthError(motor), motor.drive, kPeriod);
}
/// Advances position control by one tick and sets the drive.
inline void StepPosition(const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  motor.drive = control::StepPidLimited(numbers.length, motor.pid, LengthError(motor), kPeriod,
                                        DriveLimits(numbers, motor), control::Windup::kHeld);
}

/// Computes the tension set point from the impedance law (Mirletz et al. 2015, eq. 3).
inline void FindSetPoint(MotorLoop& motor) noexcept {
  motor.set_point_n = control::ImpedanceTension(motor.gains, motor.length_m, motor.rate_m_per_s,
                                                motor.velocity_input_m_per_s);
}

/// Starts impedance control from the present drive (bumpless transfer). With `capture`, L0 and T0
/// become the measured length and tension, also in the parameters. T0 is clamped to its range, so a
/// higher tension decreases to the upper limit of T0.
inline void StartImpedance(float* p, const LoopNumbers& numbers, bool capture,
                           MotorLoop& motor) noexcept {
  motor.counts_per_tick = 0.0f;  // one count while holding would read as 13 mm/s
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
/// Advances impedance control by one tick and sets the drive.
inline void StepImpedance(const float* p, const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  SenseCable(p, numbers, motor);
  FindSetPoint(motor);
  motor.drive =
      control::StepPidLimited(numbers.force, motor.pid, motor.set_point_n - motor.tension_n,
                              kPeriod, DriveLimits(numbers, motor), control::Windup::kHeld);
}

/// Sets the drive to the commanded duty, within the limits.
inline void StepDuty(const LoopNumbers& numbers, MotorLoop& motor) noexcept {
  const control::OutputLimits<float> limits = DriveLimits(numbers, motor);
  motor.drive = control::Clamp(motor.drive_input, limits.low, limits.high);
}

namespace internal {

inline float Towards(float from, float to, float most) noexcept {
  return from + control::Clamp(to - from, -most, most);
}

}  // namespace internal

/// Moves one gain toward its parameter, which it reaches within about a second. `which`: gain, 0 ..
/// 3. `share_s`: time since the previous call for this gain.
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
