/// What the controllers ask of a number: float on a microcontroller, double in a simulation, or a
/// wide number with one world a lane.
///
/// Everything in this folder is C++14 without a standard library, heap, exceptions or libm, and
/// uses only + - * / and comparisons, which give the same bits on an AVR and on a PC
/// (docs/theory/control.md). A wide number brings its own `Max`, `Min`, `Select` and, of its
/// conditions, `Any`, found by its namespace, and a static `Splat`.
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

/// A number that is the same in all lanes, as a `Real`.
template <class Real, class Scalar>
constexpr Real FromScalar(Scalar x) noexcept {
  return internal::FromScalar<Real>(x, 0);
}

/// A constant as a `Real`. It must be exact as a float (0, 0.5, 1), so that every `Real` has it.
template <class Real>
constexpr Real Literal(float x) noexcept {
  return FromScalar<Real>(x);
}

/// Whether it is so in any lane.
[[gnu::always_inline]] constexpr bool Any(bool condition) noexcept { return condition; }

template <class Real>
constexpr Real Select(bool condition, Real yes, Real no) noexcept {
  return condition ? yes : no;
}

/// The greater of two; `b` if either is NaN. So pass as `b` what may be NaN and must stay seen.
template <class Real>
constexpr Real Max(Real a, Real b) noexcept {
  return Select(a > b, a, b);
}

/// The smaller of two; `b` if either is NaN.
template <class Real>
constexpr Real Min(Real a, Real b) noexcept {
  return Select(a < b, a, b);
}

/// `x`, but not below `low` and not above `high`; NaN stays NaN.
template <class Real>
constexpr Real Clamp(Real x, Real low, Real high) noexcept {
  return Min(high, Max(low, x));
}

}  // namespace control
}  // namespace taut
