/// Triangular solves with the factors of a BodyMatrix, one column per body. L has a unit diagonal.
#pragma once

#include "math/scalar.h"
#include "sim/data/island.h"
#include "sim/solve/body_matrix.inl"

namespace taut::sim {

/// Solves L x' = x in place, for both factorizations: x <- L^-1 x.
template <class Num>
struct BodyMatrix<Num>::ForwardL {
  template <int N>
  TAUT_INLINE static void Column(const BodyMatrix& a, int k, Num* x) noexcept {
    const Num* const d = a.At(k, k);
    Num* const b = x + kDofs * k;
    for (int i = 1; i < N; ++i) {
      for (int m = 0; m < i; ++m) b[i] -= d[6 * i + m] * b[m];
    }
    for (int q = a.p_.first_below[k]; q < a.p_.first_below[k + 1]; ++q) {
      const Num* const l = a.At(a.p_.below[q], k);
      Num* const y = x + kDofs * a.p_.below[q];
      for (int r = 0; r < kDofs; ++r) {
        Num sum = y[r];
        for (int m = 0; m < N; ++m) sum -= l[kDofs * r + m] * b[m];
        y[r] = sum;
      }
    }
  }
};

/// Solves in place: x <- L^-T x, or with `kScaled` x <- L^-T D^-1 x.
template <class Num>
template <bool kScaled>
struct BodyMatrix<Num>::BackwardTransposedL {
  template <int N>
  TAUT_INLINE static void Column(const BodyMatrix& a, int k, Num* x) noexcept {
    const Num* const d = a.At(k, k);
    Num* const b = x + kDofs * k;
    for (int i = 0; kScaled && i < N; ++i) b[i] *= d[7 * i];
    for (int q = a.p_.first_below[k]; q < a.p_.first_below[k + 1]; ++q) {
      const Num* const l = a.At(a.p_.below[q], k);
      const Num* const y = x + kDofs * a.p_.below[q];
      for (int m = 0; m < N; ++m) {
        Num sum = b[m];
        for (int r = 0; r < kDofs; ++r) sum -= l[kDofs * r + m] * y[r];
        b[m] = sum;
      }
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int m = i + 1; m < N; ++m) b[i] -= d[6 * m + i] * b[m];
    }
  }
};

/// Solves U x' = x in place: x <- U^-1 x.
template <class Num>
struct BodyMatrix<Num>::BackwardU {
  template <int N>
  TAUT_INLINE static void Column(const BodyMatrix& a, int k, Num* x) noexcept {
    const Num* const d = a.At(k, k);
    Num* const b = x + kDofs * k;
    for (int q = a.p_.first_below[k]; q < a.p_.first_below[k + 1]; ++q) {
      const Num* const u = a.At(k, a.p_.below[q]);
      const Num* const y = x + kDofs * a.p_.below[q];
      for (int r = 0; r < N; ++r) {
        Num sum = b[r];
        for (int m = 0; m < kDofs; ++m) sum -= u[kDofs * r + m] * y[m];
        b[r] = sum;
      }
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int m = i + 1; m < N; ++m) b[i] -= d[6 * i + m] * b[m];
      b[i] *= d[7 * i];
    }
  }
};

/// Solves U^T x' = x in place: x <- U^-T x.
template <class Num>
struct BodyMatrix<Num>::ForwardTransposedU {
  template <int N>
  TAUT_INLINE static void Column(const BodyMatrix& a, int k, Num* x) noexcept {
    const Num* const d = a.At(k, k);
    Num* const b = x + kDofs * k;
    for (int i = 0; i < N; ++i) {
      for (int m = 0; m < i; ++m) b[i] -= d[6 * m + i] * b[m];
      b[i] *= d[7 * i];
    }
    for (int q = a.p_.first_below[k]; q < a.p_.first_below[k + 1]; ++q) {
      const Num* const u = a.At(k, a.p_.below[q]);
      Num* const y = x + kDofs * a.p_.below[q];
      for (int m = 0; m < kDofs; ++m) {
        for (int r = 0; r < N; ++r) y[m] -= u[kDofs * r + m] * b[r];
      }
    }
  }
};

}  // namespace taut::sim
