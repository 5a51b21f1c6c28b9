/// Bounds checks of indices, counts and steps from callers. A wrong index is a programming error
/// and would overwrite other data. Therefore every build reports it and aborts.
#pragma once

#include <cstddef>

#include "taut/time_limits.h"

namespace taut::sim {

/// `function` and `what` are names that the caller knows, such as "Cable" and "cable".
[[noreturn]] void WrongIndex(const char* function, const char* what, int index, int count) noexcept;

inline void CheckIndex(const char* function, const char* what, int index, int count) noexcept {
  if (index < 0 || index >= count) [[unlikely]] {
    WrongIndex(function, what, index, count);
  }
}

/// Reports that a cable has no motor.
[[noreturn]] void NoMotor(const char* function, int cable) noexcept;

[[noreturn]] void WrongCount(const char* function, const char* what, std::size_t given,
                             std::size_t needed) noexcept;

/// Checks the size of an array with one value for each `what`.
inline void CheckCount(const char* function, const char* what, std::size_t given,
                       std::size_t needed) noexcept {
  if (given != needed) [[unlikely]] {
    WrongCount(function, what, given, needed);
  }
}

[[noreturn]] void WrongStep(const char* function, double step_s, int count) noexcept;

/// Checks the length and the number of steps.
inline void CheckStep(const char* function, double step_s, int count) noexcept {
  if (!(step_s > 0 && step_s <= kLongestStep_s && count >= 0)) [[unlikely]] {
    WrongStep(function, step_s, count);
  }
}

}  // namespace taut::sim
