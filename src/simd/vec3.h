/// 3-vectors, quaternions and 3x3 matrices of SIMD numbers (wide.h).
#pragma once

#include "simd/wide.h"

namespace taut::simd {

template <class W>
struct V3 {
  W x, y, z;
};

template <class W>
TAUT_INLINE V3<W> operator+(const V3<W>& a, const V3<W>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class W>
TAUT_INLINE V3<W> operator-(const V3<W>& a, const V3<W>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class W>
TAUT_INLINE V3<W> operator-(const V3<W>& a) noexcept {
  return {-a.x, -a.y, -a.z};
}
template <class W>
TAUT_INLINE V3<W> operator*(W s, const V3<W>& a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
template <class W>
TAUT_INLINE V3<W>& operator+=(V3<W>& a, const V3<W>& b) noexcept {
  return a = a + b;
}
template <class W>
TAUT_INLINE V3<W>& operator-=(V3<W>& a, const V3<W>& b) noexcept {
  return a = a - b;
}
template <class W>
TAUT_INLINE W Dot(const V3<W>& a, const V3<W>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class W>
TAUT_INLINE V3<W> Cross(const V3<W>& a, const V3<W>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class W>
TAUT_INLINE V3<W> Splat3(const double* p) noexcept {
  return {W::Splat(p[0]), W::Splat(p[1]), W::Splat(p[2])};
}
template <class W, class M>
TAUT_INLINE V3<W> Select3(M m, const V3<W>& yes, const V3<W>& no) noexcept {
  return {Select(m, yes.x, no.x), Select(m, yes.y, no.y), Select(m, yes.z, no.z)};
}
/// Returns |x| + |y| + |z|, an upper bound of the Euclidean norm without a square root.
template <class W>
TAUT_INLINE W Norm1(const V3<W>& a) noexcept {
  return Abs(a.x) + Abs(a.y) + Abs(a.z);
}

template <class W>
struct Q4 {
  W w, x, y, z;
};

/// 3x3 matrix, stored by rows.
template <class W>
struct M3 {
  V3<W> r0, r1, r2;
};

template <class W>
TAUT_INLINE V3<W> operator*(const M3<W>& m, const V3<W>& a) noexcept {
  return {Dot(m.r0, a), Dot(m.r1, a), Dot(m.r2, a)};
}
template <class W>
TAUT_INLINE V3<W> TransposeTimes(const M3<W>& m, const V3<W>& a) noexcept {
  return a.x * m.r0 + a.y * m.r1 + a.z * m.r2;
}

/// Returns the rotation matrix of a unit quaternion.
template <class W>
TAUT_INLINE M3<W> RotationOf(const Q4<W>& q) noexcept {
  const W one = W::Splat(1.0), two = W::Splat(2.0);
  const W x2 = two * q.x, y2 = two * q.y, z2 = two * q.z;
  const W xx = x2 * q.x, yy = y2 * q.y, zz = z2 * q.z;
  const W xy = x2 * q.y, xz = x2 * q.z, yz = y2 * q.z;
  const W wx = x2 * q.w, wy = y2 * q.w, wz = z2 * q.w;
  return {{one - (yy + zz), xy - wz, xz + wy},
          {xy + wz, one - (xx + zz), yz - wx},
          {xz - wy, yz + wx, one - (xx + yy)}};
}

/// Symmetric 3x3 matrix.
template <class W>
struct S3 {
  W xx, yy, zz, xy, xz, yz;
};
template <class W>
TAUT_INLINE V3<W> operator*(const S3<W>& m, const V3<W>& a) noexcept {
  return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
          m.xz * a.x + m.yz * a.y + m.zz * a.z};
}
/// Returns R diag(d) R^T.
template <class W>
TAUT_INLINE S3<W> Congruence(const M3<W>& r, const V3<W>& d) noexcept {
  const V3<W> a{r.r0.x * d.x, r.r0.y * d.y, r.r0.z * d.z};
  const V3<W> b{r.r1.x * d.x, r.r1.y * d.y, r.r1.z * d.z};
  const V3<W> c{r.r2.x * d.x, r.r2.y * d.y, r.r2.z * d.z};
  return {Dot(a, r.r0), Dot(b, r.r1), Dot(c, r.r2), Dot(a, r.r1), Dot(a, r.r2), Dot(b, r.r2)};
}

}  // namespace taut::simd
