/// Interface of the SIMD numbers (simd/wide.h) for plain doubles, so that both use the same code.
/// Compiler builtins replace the standard library, which a step must not use.
#pragma once

/// SIMD numbers must stay in registers. A call would pass them through memory, and compilers would
/// not inline these functions on their own.
#define TAUT_INLINE [[gnu::always_inline]] inline

/// Marks a loop without dependencies between iterations. clang++ detects this itself and warns
/// about a pragma that it cannot use.
#if defined(__clang__)
#define TAUT_NO_OVERLAP
#else
#define TAUT_NO_OVERLAP _Pragma("GCC ivdep")
#endif

/// Marks a short loop of known length for unrolling, which removes the cost of indices.
#define TAUT_UNROLL _Pragma("GCC unroll 12")

namespace taut {

TAUT_INLINE double Sqrt(double a) noexcept { return __builtin_sqrt(a); }
TAUT_INLINE double Abs(double a) noexcept { return __builtin_fabs(a); }
/// Returns the maximum of two numbers; `b` if either is NaN.
TAUT_INLINE double Max(double a, double b) noexcept { return a > b ? a : b; }
/// Returns the minimum of two numbers; `b` if either is NaN.
TAUT_INLINE double Min(double a, double b) noexcept { return a < b ? a : b; }
TAUT_INLINE double Select(bool which, double yes, double no) noexcept { return which ? yes : no; }
TAUT_INLINE bool Any(bool which) noexcept { return which; }

/// Converts a constant to a number of type `S`.
template <class S>
struct Constant {
  TAUT_INLINE static S Of(double x) noexcept { return S::Splat(x); }
};
template <>
struct Constant<double> {
  TAUT_INLINE static double Of(double x) noexcept { return x; }
};

}  // namespace taut
