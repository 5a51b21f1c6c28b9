/// What a board watches its motors for, every tick. Counts rather than computes: a tick has little
/// time. Freestanding C++14.
#pragma once

#include <stdint.h>

#include "taut/board/faults.h"
#include "taut/board/motor_loop.h"

namespace taut {
namespace board {

constexpr uint16_t kSensorLow = 2;     ///< Compression clips there [counts].
constexpr uint16_t kSensorHigh = 735;  ///< The amplifier ends at some 741 [counts].
constexpr uint8_t kReadings = 5;       ///< So many in a row count.
constexpr uint8_t kMuchDutyTicks = 100;
constexpr float kSlackTension_n = 0.5f;
constexpr uint8_t kThermalTicks = 64;  ///< A motor's temperatures are computed every so many ticks.

/// Limits of a motor in the units of its sensors: computed when a parameter changed.
struct WatchLimits {
  uint16_t over_counts = 0, slack_counts = 0;
  int16_t step_counts = 0;  ///< In a tick.
  int16_t slack_way_counts = 0;
  int16_t stall_width = 0;      ///< Steps of the PWM.
  int16_t polarity_counts = 0;  ///< In kMuchDutyTicks: a tenth of the speed limit.
};

namespace internal {

inline int16_t Saturated(float x) noexcept {
  return x < 32767.0f ? static_cast<int16_t>(x) : INT16_MAX;
}

}  // namespace internal

inline WatchLimits LimitsOf(const float* p) noexcept {
  const float per_n = 1.0f / p[kNewtonsPerCount], per_m = 1.0f / p[kLengthPerCount];
  const float speed = p[kSpeedLimit] * per_m * kTick_s;  // counts a tick
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

struct Watch {
  uint8_t sensor = 0, over = 0, fast = 0;  ///< Readings in a row.
  uint8_t much_duty = 0;                   ///< Ticks in a row, of one sign.
  bool winds = false;                      ///< That sign.
  int16_t way = 0;                         ///< Counts in them.
  int16_t slack_way = 0;        ///< Wound in while slack, or while nothing was felt of it.
  uint16_t adc = 0;             ///< The reading before.
  float winding_rise_k = 0.0f;  ///< Above the housing.
  float housing_rise_k = 0.0f;  ///< Above the air.
  // Of the ticks since temperatures were computed last, in steps of the PWM and counts.
  int32_t width_width = 0, width_step = 0, step_step = 0;
  uint8_t felt = 0;  ///< How many ticks these are.
};

namespace internal {

inline uint8_t InARow(bool so, uint8_t count) noexcept {
  return so ? (count < 255 ? static_cast<uint8_t>(count + 1) : count) : uint8_t{0};
}

}  // namespace internal

/// What is wrong now. `step`: counts since the tick before; `width`: the duty of the tick before.
inline uint8_t Look(const WatchLimits& limits, uint16_t adc, int16_t step, int16_t width,
                    Watch& watch) noexcept {
  uint8_t wrong = 0;
  watch.sensor = internal::InARow(adc <= kSensorLow || adc >= kSensorHigh, watch.sensor);
  if (watch.sensor >= kReadings) wrong |= kSensor;
  watch.over = internal::InARow(adc > limits.over_counts, watch.over);
  if (watch.over >= kReadings) wrong |= kOverTension;
  watch.fast =
      internal::InARow(step > limits.step_counts || step < -limits.step_counts, watch.fast);
  if (watch.fast >= kReadings) wrong |= kRunaway;

  // No converter gives the same number over and over while the cable is being wound.
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

/// How a motor's temperatures follow from what it felt in kThermalTicks: current from duty and
/// speed, two thermal masses (docs/theory/motor.md). Computed when a parameter changes.
struct HeatNumbers {
  float width_width_w, width_step_w, step_step_w;  ///< Mean heat [W] of the sums of `Watch`.
  float winding_share, housing_share;              ///< Of the way to where a temperature goes.
};

inline HeatNumbers HeatOf(const float* board, float length_per_count_m) noexcept {
  constexpr float kTime_s = kThermalTicks * kTick_s;
  const float width_v = board[kSupply] / kFullWidth;
  const float step_v = board[kBackEmf] * length_per_count_m / kTick_s;
  const float per_v2_w = 1.0f / (kThermalTicks * board[kResistance]);
  return HeatNumbers{width_v * width_v * per_v2_w, -2.0f * width_v * step_v * per_v2_w,
                     step_v * step_v * per_v2_w, kTime_s / board[kWindingTime],
                     kTime_s / board[kHousingTime]};
}

constexpr int16_t kMostStep = 2000;  ///< Of what is felt, a tick [counts].

/// What heats a winding is the current's square, tick by tick: a drive that changes its sign ten
/// times a second has a mean of nothing.
inline void FeelHeat(int16_t width, int16_t step, Watch& watch) noexcept {
  // No encoder counts more, and of this much the sums hold what is felt between two looks.
  if (step > kMostStep) step = kMostStep;
  if (step < -kMostStep) step = -kMostStep;
  watch.width_width += int32_t{width} * width;
  watch.width_step += int32_t{width} * step;
  watch.step_step += int32_t{step} * step;
  if (watch.felt < 255) ++watch.felt;
}

/// The winding's temperature [deg C] after what was felt, which counts as kThermalTicks.
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
