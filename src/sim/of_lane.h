/// One lane of wide numbers as numbers of one lane (simd::Lane), and back.
#pragma once

#include "simd/vec3.h"

namespace taut::sim {

using simd::Q4;
using simd::S3;
using simd::V3;

template <class L, class W>
TAUT_INLINE L OfLane(W x, int lane) noexcept {
  return L::Splat(x[lane]);
}
template <class L, class W>
TAUT_INLINE V3<L> OfLane(const V3<W>& a, int lane) noexcept {
  return {L::Splat(a.x[lane]), L::Splat(a.y[lane]), L::Splat(a.z[lane])};
}
template <class L, class W>
TAUT_INLINE S3<L> OfLane(const S3<W>& a, int lane) noexcept {
  return {L::Splat(a.xx[lane]), L::Splat(a.yy[lane]), L::Splat(a.zz[lane]),
          L::Splat(a.xy[lane]), L::Splat(a.xz[lane]), L::Splat(a.yz[lane])};
}
template <class L, class W>
TAUT_INLINE void SetLane(V3<W>& to, const V3<L>& from, int lane) noexcept {
  to.x.Set(lane, from.x[0]);
  to.y.Set(lane, from.y[0]);
  to.z.Set(lane, from.z[0]);
}
template <class L, class W>
TAUT_INLINE void SetLane(Q4<W>& to, const Q4<L>& from, int lane) noexcept {
  to.w.Set(lane, from.w[0]);
  to.x.Set(lane, from.x[0]);
  to.y.Set(lane, from.y[0]);
  to.z.Set(lane, from.z[0]);
}

}  // namespace taut::sim
