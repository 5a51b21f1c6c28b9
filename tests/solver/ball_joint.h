/// Ball joint as a third kind of constraint, for tests: two points, of two bodies or of a body and
/// the world, that coincide. A new kind needs only a file like this, and its name in Pools.
///
///   u + bias = 0,   u: relative velocity of the two points;   l: any
#pragma once

#include "tests/solver/island_of.h"

namespace taut::test {

template <class N>
struct BallJoint {
  using Number = N;
  static constexpr int kRows = 3;
  struct Branch {};  ///< There is only one branch.

  N W[3][3], inverse[3][3], w;  ///< Inverse effective mass [1/kg]; its inverse; a bound of it.
  N bias[3];                    ///< Target: u = -bias [m/s].
  N l[3];                       ///< Impulses along the axes of W [N s].
  int link_count;
  sim::Link<N, 3> links[2];

  void FinishMasses() noexcept {
    for (auto& row : W) row[0] = row[1] = row[2] = N::Splat(0.0);
    for (int i = 0; i < link_count; ++i) sim::AddCoupling(links[i], links[i], W[0]);
    w = W[0][0] + W[1][1] + W[2][2];
    sim::InvertSmall(W, inverse);
  }
  Branch Project(const N* u, const N* center, N e, N* out) const noexcept {
    for (int r = 0; r < 3; ++r) out[r] = center[r] - (u[r] + bias[r]) / (e * w);
    return {};
  }
  void ProjectFrozen(const N* u, const N* center, N e, const N*, N* out) const noexcept {
    Project(u, center, e, out);  // already convex
  }
  void Derivative(const Branch&, N e, N* g) const noexcept {
    for (int i = 0; i < 9; ++i) g[i] = N::Splat(0.0);
    g[0] = g[4] = g[8] = N::Splat(1.0) / (e * w);
  }
  void Stiffen(const Branch&, N, N*) const noexcept {}
  static bool Same(const Branch&, const Branch&) noexcept { return true; }
  Branch BranchOf(const N*, const N*) const noexcept { return {}; }
  N Residual(const Branch&, const N* u, const N*) const noexcept {
    return Max(Abs(u[0] + bias[0]), Max(Abs(u[1] + bias[1]), Abs(u[2] + bias[2])));
  }
  void Linearize(const Branch&, const N* u, const N*, N e,
                 sim::LinearLaw<N, 3>& out) const noexcept {
    out = {};
    for (int r = 0; r < 3; ++r) {
      out.A[r][r] = e * w, out.S[r][r] = N::Splat(1.0), out.r[r] = -(u[r] + bias[r]);
    }
  }
  void SolveAlone(const N* u, N* l_now) const noexcept {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) l_now[r] -= inverse[r][c] * (u[c] + bias[c]);
    }
  }
  void Clamp(N*) const noexcept {}
};
using Joint = BallJoint<Num>;

inline Rows<3> NewtonFunction(const Joint& j, Rows<3> u, const Rows<3>& l, const Rows<3>& center,
                              double e) {
  for (std::size_t r = 0; r < 3; ++r) u[r] += j.bias[r][0] + e * j.w[0] * (l[r] - center[r]);
  return u;
}
inline double Violation(const Joint& j, const Rows<3>& u, const Rows<3>& l) {
  return Largest(NewtonFunction(j, u, l, l, 0));
}

/// Joins the point `arm_a` from the center of a to `arm_b` from the center of b, or to the world (b
/// < 0).
template <class Island>
Joint& AddJoint(Island& island, int a, const Vec3& arm_a, int b, const Vec3& arm_b,
                const Vec3& bias) {
  Joint& j = island.template Add<Joint>();
  j.link_count = b < 0 ? 1 : 2;
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int r = 0; r < 3; ++r) {
    island.SetRow(j.links[0], r, a, axes[r], Cross(arm_a, axes[r]));
    if (b >= 0) island.SetRow(j.links[1], r, b, -1.0 * axes[r], Cross(axes[r], arm_b));
    j.bias[r] = Num::Splat(Dot(axes[r], bias)), j.l[r] = Num::Splat(0.0);
  }
  j.FinishMasses();
  return j;
}

}  // namespace taut::test
