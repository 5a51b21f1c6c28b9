/// Bounds checks of the indices that callers pass. A wrong index is a programming error and would
/// overwrite other data: it is reported and aborts the program, in every build.
#pragma once

#include <cstddef>

namespace taut::sim {

/// `function` and `what` in the caller's terms: "Cable", "cable".
[[noreturn]] void WrongIndex(const char* function, const char* what, int index, int count) noexcept;

inline void CheckIndex(const char* function, const char* what, int index, int count) noexcept {
  if (index < 0 || index >= count) [[unlikely]] {
    WrongIndex(function, what, index, count);
  }
}

/// Reports a cable without a motor.
[[noreturn]] void NoMotor(const char* function, int cable) noexcept;

[[noreturn]] void WrongCount(const char* function, const char* what, std::size_t given,
                             std::size_t needed) noexcept;

/// Checks the size of an array with one value per `what`.
inline void CheckCount(const char* function, const char* what, std::size_t given,
                       std::size_t needed) noexcept {
  if (given != needed) [[unlikely]] {
    WrongCount(function, what, given, needed);
  }
}

}  // namespace taut::sim
