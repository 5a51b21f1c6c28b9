/// Fault detection and temperature model of a motor, run in every tick. Detection only counts
/// events, which takes little time. Freestanding C++14.
#pragma once

#include <stdint.h>

#include "taut/board/faults.h"
#include "taut/board/motor_loop.h"

namespace taut {
namespace board {

/// Lower limit of readings; clipped under compression [ADC counts].
constexpr uint16_t kSensorLow = 2;
/// Upper limit of readings; the amplifier saturates at about 741 [ADC counts].
constexpr uint16_t kSensorHigh = 735;
constexpr uint8_t kReadings = 5;  ///< Consecutive bad readings that make a fault.
constexpr uint8_t kMuchDutyTicks = 100;
constexpr float kSlackTension_n = 0.5f;
constexpr uint8_t kThermalTicks = 64;  ///< Ticks between temperature updates of a motor.

/// Limits of a motor in sensor counts. Updated only when a parameter changes.
struct WatchLimits {
  uint16_t over_counts = 0, slack_counts = 0;
  int16_t step_counts = 0;  ///< Encoder counts per tick at the speed limit.
  int16_t slack_way_counts = 0;
  int16_t stall_width = 0;      ///< Stall duty [PWM steps].
  int16_t polarity_counts = 0;  ///< Encoder counts in kMuchDutyTicks at a tenth of the speed limit.
};

namespace internal {

/// Converts to int16_t, clamped to INT16_MAX.
inline int16_t Saturated(float x) noexcept {
  return x < 32767.0f ? static_cast<int16_t>(x) : INT16_MAX;
}

}  // namespace internal

/// Computes the limits from the parameters of a motor.
inline WatchLimits LimitsOf(const float* p) noexcept {
  const float per_n = 1.0f / p[kNewtonsPerCount], per_m = 1.0f / p[kLengthPerCount];
  const float speed = p[kSpeedLimit] * per_m * kTick_s;  // encoder counts per tick
  WatchLimits limits;
  limits.over_counts =
      static_cast<uint16_t>(internal::Saturated(p[kCountsAtZero] + p[kTensionLimit] * per_n));
  limits.slack_counts =
      static_cast<uint16_t>(internal::Saturated(p[kCountsAtZero] + kSlackTension_n * per_n));
  limits.step_counts = internal::Saturated(speed + 1.5f);
  limits.stall_width = internal::Saturated(p[kStallDuty] * static_cast<float>(kFullWidth));
  limits.slack_way_counts = internal::Saturated(p[kSlackWay] * per_m);
  limits.polarity_counts = internal::Saturated(speed * (0.1f * kMuchDutyTicks));
  return limits;
}

/// State of a motor's fault detection and temperatures.
struct Watch {
  uint8_t sensor = 0, over = 0, fast = 0;  ///< Numbers of consecutive readings beyond each limit.
  uint8_t much_duty = 0;                   ///< Consecutive ticks with high duty of one sign.
  bool winds = false;                      ///< Sign of this duty: true winds in.
  int16_t way = 0;                         ///< Encoder counts during these ticks.
  /// Counts wound in while the cable is slack or the reading stays the same.
  int16_t slack_way = 0;
  uint16_t adc = 0;             ///< Previous reading.
  float winding_rise_k = 0.0f;  ///< Temperature of the winding above the housing.
  float housing_rise_k = 0.0f;  ///< Temperature of the housing above the air.
  // Sums of products of duty [PWM steps] and step [counts] since the last temperature update.
  int32_t width_width = 0, width_step = 0, step_step = 0;
  uint8_t felt = 0;  ///< Number of ticks in these sums.
};

namespace internal {

/// Returns the updated number of consecutive events, at most 255.
inline uint8_t InARow(bool so, uint8_t count) noexcept {
  return so ? (count < 255 ? static_cast<uint8_t>(count + 1) : count) : uint8_t{0};
}

}  // namespace internal

/// Returns the faults detected in this tick. `step`: encoder counts since the previous tick;
/// `width`: duty of the previous tick.
inline uint8_t DetectFaults(const WatchLimits& limits, uint16_t adc, int16_t step, int16_t width,
                            Watch& watch) noexcept {
  uint8_t wrong = 0;
  watch.sensor = internal::InARow(adc <= kSensorLow || adc >= kSensorHigh, watch.sensor);
  if (watch.sensor >= kReadings) wrong |= kSensor;
  watch.over = internal::InARow(adc > limits.over_counts, watch.over);
  if (watch.over >= kReadings) wrong |= kOverTension;
  watch.fast =
      internal::InARow(step > limits.step_counts || step < -limits.step_counts, watch.fast);
  if (watch.fast >= kReadings) wrong |= kRunaway;

  // While a cable is wound, noise changes the readings of a working converter.
  const bool slack = adc <= limits.slack_counts;
  if (!slack && adc != watch.adc) {
    watch.slack_way = 0;
  } else if (step > 0 || watch.slack_way > 0) {
    watch.slack_way = static_cast<int16_t>(watch.slack_way + step);
    if (watch.slack_way > limits.slack_way_counts) {
      wrong = static_cast<uint8_t>(wrong | (slack ? kSlack : kSensor));
      watch.slack_way = 0;
    }
  }
  watch.adc = adc;

  const bool winds = width > 0;
  if ((winds ? width : -width) < limits.stall_width || winds != watch.winds) {
    watch.much_duty = 0;
    watch.way = 0;
    watch.winds = winds;
  } else {
    watch.way = static_cast<int16_t>(watch.way + (winds ? step : -step));
    if (++watch.much_duty >= kMuchDutyTicks) {
      if (watch.way == 0) wrong |= kStall;
      if (watch.way < -limits.polarity_counts) wrong |= kPolarity;
      watch.much_duty = 0;
      watch.way = 0;
    }
  }
  return wrong;
}
[[deprecated("DetectFaults")]] inline uint8_t Look(const WatchLimits& limits, uint16_t adc,
                                                   int16_t step, int16_t width,
                                                   Watch& watch) noexcept {
  return DetectFaults(limits, adc, step, width, watch);
}

/// Coefficients of the temperature model: the current follows from duty and speed and heats two
/// thermal masses (docs/theory/motor.md). Updated only when a parameter changes.
struct HeatNumbers {
  /// Mean heat [W] per unit of the sums in `Watch`.
  float width_width_w, width_step_w, step_step_w;
  /// An update moves each temperature toward its steady state by this fraction of the difference.
  float winding_share, housing_share;
};

/// Computes the coefficients from the board parameters and the motor's cable length per count [m].
inline HeatNumbers HeatOf(const float* board, float length_per_count_m) noexcept {
  constexpr float kTime_s = kThermalTicks * kTick_s;
  const float width_v = board[kSupply] / kFullWidth;
  const float step_v = board[kBackEmf] * length_per_count_m / kTick_s;
  const float per_v2_w = 1.0f / (kThermalTicks * board[kResistance]);
  return HeatNumbers{width_v * width_v * per_v2_w, -2.0f * width_v * step_v * per_v2_w,
                     step_v * step_v * per_v2_w, kTime_s / board[kWindingTime],
                     kTime_s / board[kHousingTime]};
}

constexpr int16_t kMostStep = 2000;  ///< Largest step that the heat sums accept [counts per tick].

/// Adds a tick to the heat sums. The heat follows the square of the current in each tick: a current
/// that alternates ten times per second has zero mean but heats the winding.
inline void FeelHeat(int16_t width, int16_t step, Watch& watch) noexcept {
  // Real steps are smaller, and up to this limit the sums do not overflow between two updates.
  if (step > kMostStep) step = kMostStep;
  if (step < -kMostStep) step = -kMostStep;
  watch.width_width += int32_t{width} * width;
  watch.width_step += int32_t{width} * step;
  watch.step_step += int32_t{step} * step;
  if (watch.felt < 255) ++watch.felt;
}

/// Updates both temperatures from the heat sums of the last kThermalTicks. Returns the winding
/// temperature [deg C].
inline float StepTemperature(const HeatNumbers& numbers, const float* board,
                             Watch& watch) noexcept {
  const float heat_w = numbers.width_width_w * static_cast<float>(watch.width_width) +
                       numbers.width_step_w * static_cast<float>(watch.width_step) +
                       numbers.step_step_w * static_cast<float>(watch.step_step);
  watch.width_width = watch.width_step = watch.step_step = 0;
  watch.felt = 0;
  watch.winding_rise_k +=
      (heat_w * board[kWindingRise] - watch.winding_rise_k) * numbers.winding_share;
  watch.housing_rise_k +=
      (heat_w * board[kHousingRise] - watch.housing_rise_k) * numbers.housing_share;
  return board[kAirTemperature] + watch.housing_rise_k + watch.winding_rise_k;
}

}  // namespace board
}  // namespace taut
