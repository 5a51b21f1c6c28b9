/// Observations of bodies as rows of numbers, for all lanes at once.
#pragma once

#include "plant/lane_kernel.h"
#include "plant/lane_rows.inl"
#include "simd/vec3.h"

namespace taut::plant {

template <class W>
TAUT_INLINE simd::V3<W> LoadVec(const double* rows, int i) noexcept {
  return {Load<W>(rows, 3 * i), Load<W>(rows, 3 * i + 1), Load<W>(rows, 3 * i + 2)};
}
template <class W>
TAUT_INLINE void StoreVec(double* rows, int i, const simd::V3<W>& v) noexcept {
  Store(rows, i, v.x), Store(rows, i + 1, v.y), Store(rows, i + 2, v.z);
}

// SIMD versions of functions of math/vec.h, with the same operations in the same order.
template <class W>
TAUT_INLINE simd::V3<W> Turned(const simd::Q4<W>& q, const simd::V3<W>& a) noexcept {
  const simd::V3<W> u{q.x, q.y, q.z};
  const simd::V3<W> t = W::Splat(2.0) * Cross(u, a);
  return a + q.w * t + Cross(u, t);
}
template <class W>
TAUT_INLINE simd::Q4<W> Product(const simd::Q4<W>& a, const simd::Q4<W>& b) noexcept {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
template <class W>
TAUT_INLINE simd::Q4<W> Back(const simd::Q4<W>& q) noexcept {
  return {q.w, -q.x, -q.y, -q.z};
}

/// Writes 13 rows per body: position, orientation, velocity, angular velocity. Results are
/// bit-identical to `WorldBatch::Body`, except for kinematic bodies.
template <class W>
void SeeBodies(const BodyRows& rows, double* out) {
  for (int b = 0; b < rows.count; ++b) {
    const double* const turn = rows.turn + 4 * b * W::kLanes;
    const double* const from = rows.start_turn + 4 * b;
    const simd::Q4<W> q{Load<W>(turn, 0), Load<W>(turn, 1), Load<W>(turn, 2), Load<W>(turn, 3)};
    const simd::Q4<W> q0{W::Splat(from[0]), W::Splat(from[1]), W::Splat(from[2]),
                         W::Splat(from[3])};
    const simd::V3<W> l = Turned(Back(q), LoadVec<W>(rows.spin, b));
    const simd::V3<W> inv = LoadVec<W>(rows.inverse_inertia, b);
    const simd::Q4<W> turned = Product(q, Back(q0));
    StoreVec(out, 13 * b, LoadVec<W>(rows.position_m, b));
    Store(out, 13 * b + 3, turned.w), Store(out, 13 * b + 4, turned.x);
    Store(out, 13 * b + 5, turned.y), Store(out, 13 * b + 6, turned.z);
    StoreVec(out, 13 * b + 7, LoadVec<W>(rows.velocity_m_per_s, b));
    StoreVec(out, 13 * b + 10, Turned(q, simd::V3<W>{inv.x * l.x, inv.y * l.y, inv.z * l.z}));
  }
}

template <class W>
bool Collect(const double* const* rows, int count, double* to) {
  const W zero = W::Splat(0.0);
  W most = zero;
  for (int i = 0; i < count; ++i) {
    const W x = Load<W>(rows[i], 0);
    const W finite = Select(x - x == zero, x, zero);
    most = Max(most, Abs(finite));
    Store(to, i, finite);
  }
  return !Any(most > W::Splat(3.4028234663852886e38));
}

}  // namespace taut::plant
