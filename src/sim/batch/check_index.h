/// The indices that callers give. A wrong one is a mistake of theirs, and would write what belongs
/// to something else: it is named and ends the program, in every build.
#pragma once

#include <cstddef>

namespace taut::sim {

/// `function` and `what` as the caller knows them: "Cable", "cable".
[[noreturn]] void WrongIndex(const char* function, const char* what, int index, int count) noexcept;

inline void CheckIndex(const char* function, const char* what, int index, int count) noexcept {
  if (index < 0 || index >= count) [[unlikely]] {
    WrongIndex(function, what, index, count);
  }
}

/// A cable that no motor winds.
[[noreturn]] void NoMotor(const char* function, int cable) noexcept;

[[noreturn]] void WrongCount(const char* function, const char* what, std::size_t given,
                             std::size_t needed) noexcept;

/// For arrays with one value for `what`.
inline void CheckCount(const char* function, const char* what, std::size_t given,
                       std::size_t needed) noexcept {
  if (given != needed) [[unlikely]] {
    WrongCount(function, what, given, needed);
  }
}

}  // namespace taut::sim
