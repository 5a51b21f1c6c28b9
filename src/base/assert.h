/// Assertions of internal invariants. TAUT_ASSERT(condition) prints the condition and its place and
/// ends the program, in builds with the CMake option TAUT_ASSERTS (CONTRIBUTING.md); in others it
/// costs nothing. No input and no state of a world may violate one. Without the standard library:
/// the step includes it.
#pragma once

#ifdef TAUT_ASSERTS

namespace taut::base {
[[noreturn]] void AssertionFailed(const char* file, int line, const char* condition) noexcept;
}  // namespace taut::base

#define TAUT_ASSERT(condition) \
  ((condition) ? (void)0 : ::taut::base::AssertionFailed(__FILE__, __LINE__, #condition))

#else

// The condition must still compile.
#define TAUT_ASSERT(condition) ((void)sizeof(!(condition)))

#endif
