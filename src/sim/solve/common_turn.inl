/// Common rigid rotation of several bodies about their center of mass, to correct the total angular
/// momentum.
#pragma once

#include "sim/contacts/consistent_biases.inl"
#include "simd/vec3.h"

namespace taut::sim {

template <class Num>
struct Solid {
  V3<Num> x;        ///< Center of mass of the body in W [m].
  Num mass;         ///< Mass [kg].
  S3<Num> inertia;  ///< Inertia in W [kg m^2].
};

template <class Num>
struct CommonTurn {
  V3<Num> centre;  ///< Common center of mass in W [m].
  V3<Num> w;       ///< Angular velocity of the rotation [rad/s].

  /// Computes the rotation with the angular momentum `momentum`. `solid(k)`: body k of `count`.
  template <class F>
  CommonTurn(int count, const F& solid, const V3<Num>& momentum) noexcept {
    const Num zero = Num::Splat(0.0);
    Num mass = zero;
    centre = {zero, zero, zero};
    for (int k = 0; k < count; ++k) {
      const Solid<Num> body = solid(k);
      centre += body.mass * body.x;
      mass += body.mass;
    }
    centre = (Num::Splat(1.0) / mass) * centre;
    Num a[3][3] = {{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
    for (int k = 0; k < count; ++k) {
      const Solid<Num> body = solid(k);
      const V3<Num> r = body.x - centre;
      const S3<Num>& i = body.inertia;
      a[0][0] += i.xx + body.mass * (r.y * r.y + r.z * r.z);
      a[1][1] += i.yy + body.mass * (r.x * r.x + r.z * r.z);
      a[2][2] += i.zz + body.mass * (r.x * r.x + r.y * r.y);
      a[1][0] += i.xy - body.mass * r.x * r.y;
      a[2][0] += i.xz - body.mass * r.x * r.z;
      a[2][1] += i.yz - body.mass * r.y * r.z;
    }
    Num x[3] = {momentum.x, momentum.y, momentum.z};
    SolveSymmetric(a, x);
    w = {x[0], x[1], x[2]};
  }
  V3<Num> VelocityAt(const V3<Num>& x) const noexcept { return Cross(w, x - centre); }
};

}  // namespace taut::sim
