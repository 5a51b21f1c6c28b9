/// Number types of the controllers: float on a microcontroller, double in a simulation, or a SIMD
/// type with one world per lane.
///
/// All code in this folder is C++14 without standard library, heap, exceptions or libm. The code
/// uses only + - * / and comparisons, which give the same bits on an AVR and on a PC
/// (docs/theory/control.md). A SIMD type must have a static `Splat` and, in its namespace for
/// argument-dependent lookup, `Max`, `Min`, `Select` and, for its conditions, `Any`.
#pragma once

namespace taut {
namespace control {
namespace internal {

template <class Real, class Scalar>
constexpr auto FromScalar(Scalar x, int) noexcept -> decltype(Real::Splat(x)) {
  return Real::Splat(x);
}
template <class Real, class Scalar>
constexpr Real FromScalar(Scalar x, long) noexcept {
  return static_cast<Real>(x);
}

}  // namespace internal

/// Converts a number to a `Real` with the same value in all lanes.
template <class Real, class Scalar>
constexpr Real FromScalar(Scalar x) noexcept {
  return internal::FromScalar<Real>(x, 0);
}

/// Converts a constant to a `Real`. The constant must be exact in float (0, 0.5, 1), so that its
/// value is the same for every `Real`.
template <class Real>
constexpr Real Literal(float x) noexcept {
  return FromScalar<Real>(x);
}

/// Returns whether a condition holds in any lane.
[[gnu::always_inline]] constexpr bool Any(bool condition) noexcept { return condition; }

/// Returns `yes` in lanes where the condition holds, otherwise `no`.
template <class Real>
constexpr Real Select(bool condition, Real yes, Real no) noexcept {
  return condition ? yes : no;
}

/// Returns the maximum of two numbers, or `b` if either is NaN. To propagate a NaN, pass the number
/// that may be NaN as `b`.
template <class Real>
constexpr Real Max(Real a, Real b) noexcept {
  return Select(a > b, a, b);
}

/// Returns the minimum of two numbers, or `b` if either is NaN.
template <class Real>
constexpr Real Min(Real a, Real b) noexcept {
  return Select(a < b, a, b);
}

/// Returns `x` clamped to `low`..`high`; NaN stays NaN.
template <class Real>
constexpr Real Clamp(Real x, Real low, Real high) noexcept {
  return Min(high, Max(low, x));
}

}  // namespace control
}  // namespace taut
