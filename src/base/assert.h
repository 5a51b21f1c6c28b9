/// Assertions of internal invariants. If the condition is false, TAUT_ASSERT(condition) prints it
/// with its file and line and ends the program. Only builds with the CMake option TAUT_ASSERTS
/// (CONTRIBUTING.md) check the condition; other builds have no cost. No input and no state of a
/// world may make an assertion fail. This header does not use the standard library, because a step
/// includes it.
#pragma once

#ifdef TAUT_ASSERTS

namespace taut::base {
[[noreturn]] void AssertionFailed(const char* file, int line, const char* condition) noexcept;
}  // namespace taut::base

#define TAUT_ASSERT(condition) \
  ((condition) ? (void)0 : ::taut::base::AssertionFailed(__FILE__, __LINE__, #condition))

#else

// The condition is not evaluated, but it must compile.
#define TAUT_ASSERT(condition) ((void)sizeof(!(condition)))

#endif
