/// Virtual time of the emulation, and the clocks of the boards relative to it.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/assert.h"

namespace taut::virtual_robot {

/// Picoseconds since the robot was powered on. Fine enough to distinguish, within one cycle, a
/// clock with an error of one part per million. Range: 106 days.
using Time = std::int64_t;

inline constexpr Time kNanosecond = 1'000;
inline constexpr Time kMicrosecond = 1'000'000;
inline constexpr Time kMillisecond = 1'000'000'000;
inline constexpr Time kSecond = 1'000'000'000'000;
inline constexpr Time kNever = INT64_MAX;

/// Rounds to the nearest picosecond. `seconds` must be finite and below 100 days.
inline Time FromSeconds(double seconds) noexcept { return std::llround(seconds * 1e12); }
inline double ToSeconds(Time time) noexcept { return static_cast<double>(time) * 1e-12; }

/// Conversion between time and the cycles of a board's crystal. Integers throughout, so that runs
/// are reproducible without drift.
class BoardClock {
 public:
  static constexpr std::int64_t kNominalHz = 16'000'000;

  /// From `now` on, when the board is in cycle `cycle`, its clock is fast by `drift_ppm` millionths
  /// (negative: slow), rounded to a hundredth of a millionth.
  void Set(Time now, std::uint64_t cycle, double drift_ppm) noexcept {
    const double exact = static_cast<double>(kNominalHz) * (1.0 + drift_ppm * 1e-6) * 1e3;
    TAUT_ASSERT(exact > 0.0);
    millihertz_ = static_cast<std::uint64_t>(std::llround(exact));
    start_ = now;
    start_cycle_ = cycle;
  }

  /// Returns the first cycle that begins at `time` or later. `time` must not precede the last
  /// `Set`.
  std::uint64_t CycleAt(Time time) const noexcept {
    const Wide scaled = Wide{static_cast<std::uint64_t>(time - start_)} * millihertz_;
    return start_cycle_ + static_cast<std::uint64_t>((scaled + kScale - 1) / kScale);
  }
  /// Returns the start of a cycle, rounded up to a picosecond.
  Time StartOf(std::uint64_t cycle) const noexcept {
    const Wide scaled = Wide{cycle - start_cycle_} * kScale;
    return start_ + static_cast<Time>((scaled + millihertz_ - 1) / millihertz_);
  }

 private:
  __extension__ using Wide = unsigned __int128;
  static constexpr std::uint64_t kScale =
      1'000'000'000'000'000;  ///< Picoseconds times millihertz per cycle.

  std::uint64_t millihertz_ = kNominalHz * 1000, start_cycle_ = 0;
  Time start_ = 0;
};

}  // namespace taut::virtual_robot
