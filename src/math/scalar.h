/// Plain doubles under the names that wide numbers have (simd/wide.h), so that one text serves
/// both. Builtins: the standard library has no place in a step.
#pragma once

/// Wide numbers travel in registers or not at all: a call passes them through memory, and the
/// compilers' rules of thumb would call.
#define TAUT_INLINE [[gnu::always_inline]] inline

/// Before a loop whose turns may run side by side: what it writes, no other turn reads. clang++
/// finds that out by itself, and complains where it cannot make use of being told.
#if defined(__clang__)
#define TAUT_NO_OVERLAP
#else
#define TAUT_NO_OVERLAP _Pragma("GCC ivdep")
#endif

/// Before a loop of few turns, whose number is known: written out, indices cost nothing.
#define TAUT_UNROLL _Pragma("GCC unroll 12")

namespace taut {

TAUT_INLINE double Sqrt(double a) noexcept { return __builtin_sqrt(a); }
TAUT_INLINE double Abs(double a) noexcept { return __builtin_fabs(a); }
/// The greater of two; `b` if either is NaN.
TAUT_INLINE double Max(double a, double b) noexcept { return a > b ? a : b; }
/// The smaller of two; `b` if either is NaN.
TAUT_INLINE double Min(double a, double b) noexcept { return a < b ? a : b; }
TAUT_INLINE double Select(bool which, double yes, double no) noexcept { return which ? yes : no; }
TAUT_INLINE bool Any(bool which) noexcept { return which; }

/// A constant as a number of type `S`.
template <class S>
struct Constant {
  TAUT_INLINE static S Of(double x) noexcept { return S::Splat(x); }
};
template <>
struct Constant<double> {
  TAUT_INLINE static double Of(double x) noexcept { return x; }
};

}  // namespace taut
