/// Dry friction of a ball joint, a constraint on rotation about all axes (docs/theory/joints.md,
/// eq. 10). Three orthogonal rows:
///
///   |l| <= limit,   and u = 0 or l = -limit u / |u|
///
///   u: relative angular velocity of the bodies after the step, in the rows' units; l: impulses
///
/// The limit applies to the length of l. The limit is the same about every axis, independent of the
/// directions of the rows.
#pragma once

#include "sim/constraint/links.h"

namespace taut::sim {

template <class Num>
struct TurnFriction {
  using Number = Num;
  static constexpr int kRows = 3;

  Num limit;     ///< Limit of the impulse [N s], > 0.
  Num w, inv_w;  ///< Upper bound of the inverse effective mass [1/kg], [kg].
  Num A[3][3];   ///< Inverse effective mass [1/kg].
  int link_count;
  Link<Num, 3> links[2];

  struct Branch {
    MaskOf<Num> slides;
    Num s[3];    ///< Direction of the impulse while sliding.
    Num shrink;  ///< While sliding: limit / length of the vector outside the limit; otherwise 1.
  };
  static bool Same(const Branch& a, const Branch& b) noexcept {
    if (Any(a.slides) != Any(b.slides)) return false;
    const Num along = a.s[0] * b.s[0] + a.s[1] * b.s[1] + a.s[2] * b.s[2];
    return !Any(a.slides) || Any(along > Num::Splat(0.9999));
  }

  void FinishMasses() noexcept {
    for (Num(&row)[3] : A) row[0] = row[1] = row[2] = Num::Splat(0.0);
    for (int i = 0; i < link_count; ++i) AddCoupling(links[i], links[i], A[0]);
    w = A[0][0] + A[1][1] + A[2][2];
    inv_w = Num::Splat(1.0) / w;
  }

  Branch Project(const Num* u, const Num* center, Num e, Num* out) const noexcept {
    return Reach(u, center, inv_w / e, out);
  }
  void ProjectFrozen(const Num* u, const Num* center, Num e, const Num*, Num* out) const noexcept {
    Project(u, center, e, out);  // the projection is already convex
  }
  void Derivative(const Branch& b, Num e, Num* g) const noexcept {
    Across(b, b.shrink * (inv_w / e), g);
  }
  void Stiffen(const Branch&, Num, Num*) const noexcept {}

  Branch BranchOf(const Num* u, const Num* l_now) const noexcept {
    Num out[3];
    return Reach(u, l_now, inv_w, out);
  }
  Num Residual(const Branch& b, const Num* u, const Num* l_now) const noexcept {
    Num worst = Num::Splat(0.0);
    for (int r = 0; r < 3; ++r) {
      worst = Max(Abs(Select(b.slides, w * (limit * b.s[r] - l_now[r]), u[r])), worst);
    }
    return worst;
  }
  /// While sliding, the impulse along s is at the limit. Across s:
  ///   (1 - (1 - e) shrink) dl + shrink / w du = -l
  void Linearize(const Branch& b, const Num* u, const Num* l_now, Num e,
                 LinearLaw<Num, 3>& out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    const Num inverse = one / (one - (one - e) * b.shrink);
    const Num along = b.s[0] * l_now[0] + b.s[1] * l_now[1] + b.s[2] * l_now[2];
    Across(b, Select(b.slides, inverse * b.shrink * inv_w, one), out.S[0]);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out.A[i][j] = zero;
      out.A[i][i] = Select(b.slides, one, e * w);
      const Num across = along * b.s[i] - l_now[i];
      out.r[i] = Select(b.slides, (limit - along) * b.s[i] + inverse * across, zero - u[i]);
    }
  }

  /// Solves this constraint alone: l(k) = -(A + k)^-1 q, with k = 0 if it can stick. Otherwise k is
  /// such that |l| equals the limit. Newton's method on 1 / |l(k)| approaches this k from below in
  /// a few steps.
  void SolveAlone(const Num* u, Num* l_now) const noexcept {
    static_assert(Num::kLanes == 1);
    constexpr int kMaxIterations = 40;
    Num back[3], slope[3];  // -q
    for (int i = 0; i < 3; ++i) {
      back[i] = A[i][0] * l_now[0] + A[i][1] * l_now[1] + A[i][2] * l_now[2] - u[i];
    }
    Num k = Num::Splat(0.0);
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      Solve(k, back, l_now);
      const Num length2 = Square(l_now), length = Sqrt(length2);
      if (!Any(length > Num::Splat(1.0 + 1e-14) * limit)) break;
      Solve(k, l_now, slope);
      const Num bend = l_now[0] * slope[0] + l_now[1] * slope[1] + l_now[2] * slope[2];
      k += length2 / bend * ((length - limit) / limit);
    }
    Clamp(l_now);
  }
  void Clamp(Num* l_now) const noexcept {
    const Num length2 = Square(l_now);
    const auto beyond = length2 > limit * limit;
    if (!Any(beyond)) return;
    const Num shrink = limit / Sqrt(Max(length2, Num::Splat(1e-300)));
    for (int r = 0; r < 3; ++r) l_now[r] = Select(beyond, shrink * l_now[r], l_now[r]);
  }

 private:
  static Num Square(const Num* x) noexcept { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; }
  /// Projects center - step u onto the ball whose radius is the limit. Result: `out`.
  Branch Reach(const Num* u, const Num* center, Num step, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    for (int r = 0; r < 3; ++r) out[r] = center[r] - step * u[r];
    const Num length2 = Square(out);
    Branch b;
    b.slides = length2 > limit * limit;
    const Num inverse = one / Sqrt(Max(length2, Num::Splat(1e-300)));
    b.shrink = Select(b.slides, limit * inverse, one);
    for (int r = 0; r < 3; ++r) {
      b.s[r] = Select(b.slides, inverse * out[r], zero);
      out[r] = b.shrink * out[r];
    }
    return b;
  }
  /// Computes the 3x3 matrix out <- scale (1 - s s^T).
  static void Across(const Branch& b, Num scale, Num* out) noexcept {
    const Num zero = Num::Splat(0.0);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out[3 * i + j] = zero - scale * (b.s[i] * b.s[j]);
      out[4 * i] += scale;
    }
  }
  /// Solves (A + k) x = b by Cholesky factorization. For a thin rod, inverse masses about its axis
  /// and normal to it differ by a factor of a million.
  void Solve(Num k, const Num* b, Num* x) const noexcept {
    const Num d0 = A[0][0] + k, l1 = A[1][0] / d0, l2 = A[2][0] / d0;
    const Num d1 = A[1][1] + k - l1 * A[1][0], m = A[2][1] - l2 * A[1][0], l3 = m / d1;
    const Num d2 = A[2][2] + k - l2 * A[2][0] - l3 * m;
    const Num y1 = b[1] - l1 * b[0], y2 = b[2] - l2 * b[0] - l3 * y1;
    x[2] = y2 / d2;
    x[1] = y1 / d1 - l3 * x[2];
    x[0] = b[0] / d0 - l1 * x[1] - l2 * x[2];
  }
};

}  // namespace taut::sim
