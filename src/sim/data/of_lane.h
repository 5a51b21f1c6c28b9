/// Conversion between one lane of a SIMD number and a one-lane number (simd::Lane).
#pragma once

#include "simd/vec3.h"

namespace taut::sim {

using simd::Q4;
using simd::S3;
using simd::V3;

template <class L, class W>
struct OneLane {
  static L Of(W x, int lane) noexcept { return L::Splat(x[lane]); }
  static void Set(W& to, L from, int lane) noexcept { to.Set(lane, from[0]); }
};
/// One-lane numbers stay unchanged, including derivatives (simd/dual.h).
template <class L>
struct OneLane<L, L> {
  static L Of(L x, int) noexcept { return x; }
  static void Set(L& to, L from, int) noexcept { to = from; }
};

template <class L, class W>
TAUT_INLINE L OfLane(W x, int lane) noexcept {
  return OneLane<L, W>::Of(x, lane);
}
template <class L, class W>
TAUT_INLINE V3<L> OfLane(const V3<W>& a, int lane) noexcept {
  return {OfLane<L>(a.x, lane), OfLane<L>(a.y, lane), OfLane<L>(a.z, lane)};
}
template <class L, class W>
TAUT_INLINE S3<L> OfLane(const S3<W>& a, int lane) noexcept {
  return {OfLane<L>(a.xx, lane), OfLane<L>(a.yy, lane), OfLane<L>(a.zz, lane),
          OfLane<L>(a.xy, lane), OfLane<L>(a.xz, lane), OfLane<L>(a.yz, lane)};
}
template <class L, class W>
TAUT_INLINE Q4<L> OfLane(const Q4<W>& a, int lane) noexcept {
  return {OfLane<L>(a.w, lane), OfLane<L>(a.x, lane), OfLane<L>(a.y, lane), OfLane<L>(a.z, lane)};
}
template <class L, class W>
TAUT_INLINE void SetLane(W& to, L from, int lane) noexcept {
  OneLane<L, W>::Set(to, from, lane);
}
template <class L, class W>
TAUT_INLINE void SetLane(V3<W>& to, const V3<L>& from, int lane) noexcept {
  SetLane(to.x, from.x, lane);
  SetLane(to.y, from.y, lane);
  SetLane(to.z, from.z, lane);
}
template <class L, class W>
TAUT_INLINE void SetLane(Q4<W>& to, const Q4<L>& from, int lane) noexcept {
  SetLane(to.w, from.w, lane);
  SetLane(to.x, from.x, lane);
  SetLane(to.y, from.y, lane);
  SetLane(to.z, from.z, lane);
}

}  // namespace taut::sim
