/// SIMD vectors of N doubles, one lane per world. Lane i never reads lane j, so a batch of N worlds
/// gives the same bits as N single worlds (docs/determinism.md).
///
/// The storage is a compiler vector, because with arrays g++ 12 leaves most of the step scalar.
/// There are no shuffles, horizontal sums or fused multiply-adds. Every width is used in exactly
/// one instruction set, so that no template instance is compiled twice with different flags.
/// Intrinsics occur only in wide_*.h of this folder, for instructions that the compiler does not
/// find.
#pragma once

#include <float.h>

#include "math/scalar.h"

// Excess precision between operations, as with x87, would change results.
static_assert(FLT_EVAL_METHOD == 0, "taut needs arithmetic that rounds to double each time");

namespace taut::simd {

template <class T, int N>
struct VectorOf {
  typedef T Type __attribute__((vector_size(sizeof(T) * N)));
};

/// `Isa` only distinguishes types compiled for several instruction sets; see Lane.
template <int N, class Isa = void>
struct Wide {
  static constexpr int kLanes = N;
  using Vector = typename VectorOf<double, N>::Type;
  Vector v;

  static Wide Splat(double x) noexcept { return {x - Vector{}}; }
  double operator[](int i) const noexcept { return v[i]; }
  void Set(int i, double x) noexcept { v[i] = x; }
};

template <int N, class Isa = void>
struct Mask {
  using Vector = typename VectorOf<long long, N>::Type;
  Vector v;

  bool operator[](int i) const noexcept { return v[i] != 0; }
  void Set(int i, bool x) noexcept { v[i] = x ? -1 : 0; }
  static Mask Splat(bool x) noexcept { return {Vector{} - (x ? 1 : 0)}; }
};

template <int N, class I>
TAUT_INLINE Wide<N, I> operator+(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v + b.v};
}
template <int N, class I>
TAUT_INLINE Wide<N, I> operator-(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v - b.v};
}
template <int N, class I>
TAUT_INLINE Wide<N, I> operator*(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v * b.v};
}
template <int N, class I>
TAUT_INLINE Wide<N, I> operator/(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v / b.v};
}
template <int N, class I>
TAUT_INLINE Wide<N, I> operator-(Wide<N, I> a) noexcept {
  return {-a.v};
}
template <int N, class I>
TAUT_INLINE Mask<N, I> operator<(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v < b.v};
}
template <int N, class I>
TAUT_INLINE Mask<N, I> operator>(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v > b.v};
}
template <int N, class I>
TAUT_INLINE Mask<N, I> operator==(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v == b.v};
}
template <int N, class I>
TAUT_INLINE Mask<N, I> operator&(Mask<N, I> a, Mask<N, I> b) noexcept {
  return {a.v & b.v};
}
template <int N, class I>
TAUT_INLINE Mask<N, I> operator|(Mask<N, I> a, Mask<N, I> b) noexcept {
  return {a.v | b.v};
}
template <int N, class I>
TAUT_INLINE Mask<N, I> operator!(Mask<N, I> a) noexcept {
  return {~a.v};
}
template <int N, class I>
TAUT_INLINE Wide<N, I> Select(Mask<N, I> m, Wide<N, I> yes, Wide<N, I> no) noexcept {
  return {m.v ? yes.v : no.v};
}

// For all widths and machines; wide_*.h overloads them with single instructions.
template <int N, class I>
TAUT_INLINE Wide<N, I> Sqrt(Wide<N, I> a) noexcept {
  for (int i = 0; i < N; ++i) a.v[i] = __builtin_sqrt(a.v[i]);
  return a;
}
template <int N, class I>
TAUT_INLINE bool Any(Mask<N, I> m) noexcept {
  long long any = 0;
  for (int i = 0; i < N; ++i) any |= m.v[i];
  return any != 0;
}
/// Returns the maximum of two numbers; `b` if either is NaN or both are zero: a > b ? a : b, like
/// the x86-64 instruction. AArch64's FMAX differs in both cases, so it must not be used.
template <int N, class I>
TAUT_INLINE Wide<N, I> Max(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v > b.v ? a.v : b.v};
}
/// Returns the minimum of two numbers; `b` if either is NaN or both are zero.
template <int N, class I>
TAUT_INLINE Wide<N, I> Min(Wide<N, I> a, Wide<N, I> b) noexcept {
  return {a.v < b.v ? a.v : b.v};
}

/// One lane: a plain double, so that a single world has no vector overhead.
template <class I>
struct Mask<1, I> {
  bool v;
  bool operator[](int) const noexcept { return v; }
  void Set(int, bool x) noexcept { v = x; }
  static Mask Splat(bool x) noexcept { return {x}; }
};
template <class I>
struct Wide<1, I> {
  static constexpr int kLanes = 1;
  double v;
  static Wide Splat(double x) noexcept { return {x}; }
  double operator[](int) const noexcept { return v; }
  void Set(int, double x) noexcept { v = x; }
};
template <class I>
TAUT_INLINE Mask<1, I> operator&(Mask<1, I> a, Mask<1, I> b) noexcept {
  return {a.v && b.v};
}
template <class I>
TAUT_INLINE Mask<1, I> operator|(Mask<1, I> a, Mask<1, I> b) noexcept {
  return {a.v || b.v};
}
template <class I>
TAUT_INLINE Mask<1, I> operator!(Mask<1, I> a) noexcept {
  return {!a.v};
}
template <class I>
TAUT_INLINE Wide<1, I> Select(Mask<1, I> m, Wide<1, I> yes, Wide<1, I> no) noexcept {
  return {m.v ? yes.v : no.v};
}
template <class I>
TAUT_INLINE Wide<1, I> Max(Wide<1, I> a, Wide<1, I> b) noexcept {
  return {a.v > b.v ? a.v : b.v};
}
template <class I>
TAUT_INLINE Wide<1, I> Min(Wide<1, I> a, Wide<1, I> b) noexcept {
  return {a.v < b.v ? a.v : b.v};
}
template <class I>
TAUT_INLINE Wide<1, I> Sqrt(Wide<1, I> a) noexcept {
  return {__builtin_sqrt(a.v)};
}
template <class I>
TAUT_INLINE bool Any(Mask<1, I> m) noexcept {
  return m.v;
}

/// One lane of W, for code in which lanes have too little in common to run together. The type is
/// tagged with W, so that each instruction set has a separate type. If W has one lane, it is W
/// itself.
template <class W>
struct LaneOf {
  using Type = Wide<1, W>;
};
template <class I>
struct LaneOf<Wide<1, I>> {
  using Type = Wide<1, I>;
};
template <class W>
using Lane = typename LaneOf<W>::Type;

template <int N, class I>
TAUT_INLINE Wide<N, I> Abs(Wide<N, I> a) noexcept {
  return Max(a, -a);
}

template <int N, class I>
TAUT_INLINE Wide<N, I>& operator+=(Wide<N, I>& a, Wide<N, I> b) noexcept {
  return a = a + b;
}
template <int N, class I>
TAUT_INLINE Wide<N, I>& operator-=(Wide<N, I>& a, Wide<N, I> b) noexcept {
  return a = a - b;
}

template <int N, class I>
TAUT_INLINE Wide<N, I>& operator*=(Wide<N, I>& a, Wide<N, I> b) noexcept {
  return a = a * b;
}

}  // namespace taut::simd

#if defined(__SSE2__)
#include "simd/wide_x86.h"
#elif defined(__aarch64__)
#include "simd/wide_neon.h"
#elif defined(__wasm_simd128__)
#include "simd/wide_wasm.h"
#endif
