/// Contact point constraint: complementarity and Coulomb's cone (docs/theory/contact.md, sections 1
/// and 4).
///
///   (C1)  ln >= 0,  un + bn >= 0,  ln (un + bn) = 0                    no penetration
///   (C2)  |lt| <= mu ln,  and ut + bt = 0 or lt = -mu ln (ut + bt) / |ut + bt|     Coulomb's cone
///
/// u: velocity of the contact point after the step, b: biases, l: impulses (normal, tangents).
#pragma once

#include "sim/constraint/links.h"

namespace taut::sim {

/// Contact with up to `kMaxLinks` moving bodies; one body if the other side is static.
template <class Num, int kMaxLinks>
struct ContactPoint {
  using Number = Num;
  static constexpr int kRows = 3;

  Num live;             ///< 1 in lanes that have this contact, otherwise 0.
  Num wnn, wt;          ///< Inverse effective masses: normal; upper bound for the tangents [1/kg].
  Num inv_wnn, inv_wt;  ///< Inverses of wnn and wt [kg].
  Num w1n, w2n, w11, w12, w22;  ///< Other elements of the inverse effective mass [1/kg].
  Num bias[3];                  ///< Targets: un >= -bias[0], ut = -bias[1..2] [m/s].
  Num mu, restitution;
  Num before;  ///< Normal velocity at the start of the step [m/s].
  /// Rebound speed if the contact takes part in an impact in this step [m/s], otherwise 0.
  Num rebound;
  Num closing;         ///< Value of bias[0] without an impact [m/s].
  Num again;           ///< Restitution if the contact opens at the start of the step, otherwise 0.
  Num l[3];            ///< Impulses [N s].
  bool one_direction;  ///< Friction acts only along the first tangent.
  int link_count;
  Link<Num, 3> links[kMaxLinks];

  /// Case of the law: open, sticking, or sliding in a direction.
  struct Branch {
    MaskOf<Num> closed, slides;
    Num s1, s2;  ///< Direction of friction while sliding.
    Num shrink;  ///< Radius of the cone / length of the tangential vector outside of it.
  };
  static bool Same(const Branch& a, const Branch& b) noexcept {
    if (Any(a.closed) != Any(b.closed) || Any(a.slides) != Any(b.slides)) return false;
    return !Any(a.slides) || Any(a.s1 * b.s1 + a.s2 * b.s2 > Num::Splat(0.9999));
  }

  /// Copies the law of another contact without its links. Each value is `pick(other's value, own
  /// value)`.
  template <int kOther, class F>
  TAUT_INLINE void TakeLaw(const ContactPoint<Num, kOther>& from, const F& pick) noexcept {
    const auto take = [&pick](const Num& x, Num& mine) { mine = pick(x, mine); };
    take(from.live, live);
    take(from.wnn, wnn), take(from.wt, wt);
    take(from.inv_wnn, inv_wnn), take(from.inv_wt, inv_wt);
    take(from.w1n, w1n), take(from.w2n, w2n);
    take(from.w11, w11), take(from.w12, w12), take(from.w22, w22);
    take(from.mu, mu), take(from.restitution, restitution), take(from.before, before);
    for (int r = 0; r < kRows; ++r) take(from.bias[r], bias[r]), take(from.l[r], l[r]);
    one_direction = from.one_direction;
  }

  /// Computes inverse effective masses from the links, whose directions are orthonormal.
  TAUT_INLINE void FinishMasses() noexcept {
    wnn = w1n = w2n = w11 = w12 = w22 = Num::Splat(0.0);
    for (int i = 0; i < link_count; ++i) {
      const Link<Num, 3>& k = links[i];
      wnn += k.inv_mass + Dot(k.ang[0], k.turn[0]);
      w11 += k.inv_mass + Dot(k.ang[1], k.turn[1]);
      w22 += k.inv_mass + Dot(k.ang[2], k.turn[2]);
      w1n += Dot(k.ang[1], k.turn[0]);
      w2n += Dot(k.ang[2], k.turn[0]);
      w12 += Dot(k.ang[1], k.turn[2]);
    }
    wt = one_direction ? w11 : Max(w11, w22) + Abs(w12);
    inv_wnn = Num::Splat(1.0) / wnn;
    inv_wt = Num::Splat(1.0) / wt;
  }

  Branch Project(const Num* u, const Num* center, Num e, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0);
    const Num inv_e = Num::Splat(1.0) / e;
    const Num yn = center[0] - inv_e * inv_wnn * (u[0] + bias[0]);
    out[0] = Max(yn, zero);
    return Friction(u, center, inv_e, mu * out[0], yn > zero, out);
  }

  void ProjectFrozen(const Num* u, const Num* center, Num e, const Num* l0,
                     Num* out) const noexcept {
    const Num zero = Num::Splat(0.0);
    const Num inv_e = Num::Splat(1.0) / e;
    const Num yn = center[0] - inv_e * inv_wnn * (u[0] + bias[0]);
    out[0] = Max(yn, zero);
    Friction(u, center, inv_e, mu * l0[0], yn > zero, out);
  }

  /// Computes the 3x3 matrix, row by row. The matrix is not symmetric for a sliding contact, since
  /// its friction depends on the normal impulse.
  void Derivative(const Branch& b, Num e, Num* g) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    const Num inv_e = one / e;
    const Num n = inv_e * inv_wnn, t = inv_e * inv_wt;
    g[0] = Select(b.closed, n, zero);
    g[1] = g[2] = zero;
    g[3] = Select(b.closed & b.slides, mu * b.s1 * n, zero);
    g[6] = Select(b.closed & b.slides, mu * b.s2 * n, zero);
    const Num q = b.shrink * t;
    g[4] = Select(b.slides, q * (one - b.s1 * b.s1), t);
    g[5] = g[7] = Select(b.slides, zero - q * b.s1 * b.s2, zero);
    g[8] = Select(b.slides, q * (one - b.s2 * b.s2), t);
    if (one_direction) g[4] = Select(b.slides, zero, t), g[5] = g[7] = g[8] = zero;
    for (int i = 3; i < 9; ++i) g[i] = Select(b.closed, g[i], zero);
  }

  /// Adds `share` of the stiffness along the slip direction that a law with frozen friction
  /// direction lacks (eq. 27). A larger matrix gives smaller steps where directions turn much
  /// within a step.
  void Stiffen(const Branch& b, Num share, Num* g) const noexcept {
    const auto slides = b.closed & b.slides;
    if (!Any(slides)) return;
    const Num q = Select(slides, share * (g[4] + g[8]), Num::Splat(0.0));
    g[4] += q * b.s1 * b.s1, g[5] += q * b.s1 * b.s2;
    g[7] += q * b.s1 * b.s2, g[8] += q * b.s2 * b.s2;
  }

  /// Returns the branch for u and l, by the natural map with steps 1 / w (eq. 15).
  TAUT_INLINE Branch BranchOf(const Num* u, const Num* l_now) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    Branch b;
    b.closed = (live > zero) & (l_now[0] - inv_wnn * (u[0] + bias[0]) > zero);
    b.s1 = b.s2 = b.shrink = zero;
    const Num y1 = l_now[1] - inv_wt * (u[1] + bias[1]);
    const Num y2 = one_direction ? zero : l_now[2] - inv_wt * (u[2] + bias[2]);
    const Num edge = mu * Max(l_now[0], zero);
    const Num length2 = y1 * y1 + y2 * y2;
    b.slides = b.closed & (length2 > edge * edge);
    if (Any(b.slides)) {
      const Num inverse = one / Sqrt(Max(length2, Num::Splat(1e-300)));
      b.s1 = inverse * y1, b.s2 = inverse * y2, b.shrink = edge * inverse;
    }
    return b;
  }

  /// Returns the change by one step of the natural map, as a velocity (eq. 16).
  TAUT_INLINE Num Residual(const Branch& b, const Num* u, const Num* l_now) const noexcept {
    const Num zero = Num::Splat(0.0);
    const Num edge = mu * Max(l_now[0], zero);
    const Num off_n = Select(b.closed, u[0] + bias[0], wnn * l_now[0]);
    Num off1 = wt * (l_now[1] - Select(b.slides, edge * b.s1, zero));
    Num off2 = wt * (l_now[2] - Select(b.slides, edge * b.s2, zero));
    const auto sticks = b.closed & !b.slides;
    off1 = Select(sticks, u[1] + bias[1], off1);
    off2 = Select(sticks, one_direction ? wt * l_now[2] : u[2] + bias[2], off2);
    return Select(live > zero, Max(Abs(off_n), Max(Abs(off1), Abs(off2))), zero);
  }

  TAUT_INLINE void Linearize(const Branch& b, const Num* u, const Num* l_now, Num e,
                             LinearLaw<Num, 3>& out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    const auto sticks = b.closed & !b.slides;
    out.A[0][0] = Select(b.closed, e * wnn, one);
    out.S[0][0] = Select(b.closed, one, zero);
    out.r[0] = Select(b.closed, zero - (u[0] + bias[0]), zero - l_now[0]);
    out.A[0][1] = out.A[0][2] = out.S[0][1] = out.S[0][2] = out.S[1][0] = out.S[2][0] = zero;
    // Sliding: (1 - (1 - e) M) dlt + M / wt dut - mu s dln = edge s - lt,  M = q (1 - s s^T)
    const Num m11 = b.shrink * (one - b.s1 * b.s1), m12 = zero - b.shrink * b.s1 * b.s2,
              m22 = b.shrink * (one - b.s2 * b.s2);
    const Num edge = mu * Max(l_now[0], zero), soft = one - e, stuck = e * wt;
    out.A[1][0] = Select(b.slides, zero - mu * b.s1, zero);
    out.A[2][0] = Select(b.slides, zero - mu * b.s2, zero);
    out.A[1][1] = Select(sticks, stuck, Select(b.slides, one - soft * m11, one));
    out.A[1][2] = out.A[2][1] = Select(b.slides, zero - soft * m12, zero);
    out.A[2][2] = Select(sticks, stuck, Select(b.slides, one - soft * m22, one));
    out.S[1][1] = Select(sticks, one, Select(b.slides, m11 * inv_wt, zero));
    out.S[1][2] = out.S[2][1] = Select(b.slides, m12 * inv_wt, zero);
    out.S[2][2] = Select(sticks, one, Select(b.slides, m22 * inv_wt, zero));
    out.r[1] = Select(b.slides, edge * b.s1, zero) - l_now[1];
    out.r[2] = Select(b.slides, edge * b.s2, zero) - l_now[2];
    out.r[1] = Select(sticks, zero - (u[1] + bias[1]), out.r[1]);
    out.r[2] = Select(sticks, zero - (u[2] + bias[2]), out.r[2]);
    if (!one_direction) return;
    out.A[1][2] = out.A[2][1] = out.S[1][2] = out.S[2][1] = out.S[2][2] = zero;
    out.A[2][0] = zero;
    out.A[2][2] = one;
    out.r[2] = zero - l_now[2];
  }

  /// Solves this contact alone (eq. 23), in one lane. Searches for the stiffness k against slip at
  /// which |lt(k)| = mu ln(k). The difference changes its sign, so a solution exists for any cone
  /// (even for Painleve's rod).
  void SolveAlone(const Num* u, Num* l_now) const noexcept {
    static_assert(Num::kLanes == 1);
    const Num zero = Num::Splat(0.0);
    const Num lt2 = one_direction ? zero : l_now[2];
    const Num qn = u[0] + bias[0] - (wnn * l_now[0] + w1n * l_now[1] + w2n * lt2);
    const Num q1 = u[1] + bias[1] - (w1n * l_now[0] + w11 * l_now[1] + w12 * lt2);
    const Num q2 = u[2] + bias[2] - (w2n * l_now[0] + w12 * l_now[1] + w22 * lt2);
    if (!Any(qn < zero)) {
      l_now[0] = l_now[1] = l_now[2] = zero;
      return;
    }
    Slip slip;
    slip.s11 = w11 - w1n * w1n * inv_wnn;
    slip.s12 = one_direction ? zero : w12 - w1n * w2n * inv_wnn;
    slip.s22 = one_direction ? Num::Splat(1.0) : w22 - w2n * w2n * inv_wnn;
    slip.q1 = q1 - w1n * inv_wnn * qn;
    slip.q2 = one_direction ? zero : q2 - w2n * inv_wnn * qn;
    slip.qn = qn;
    Num low = zero, at_low = Excess(slip, low);
    if (Any(at_low > zero)) {
      Num high = slip.s11 + slip.s22, at_high = Excess(slip, high);
      for (int i = 0; i < 60 && Any(at_high > zero); ++i) {
        high = Num::Splat(8.0) * high;
        at_high = Excess(slip, high);
      }
      // Without a change of sign, the closing speed is below 1e-50 of the slip (positions that have
      // converged to rounding). In this case, the impulses at `high` are the solution, and CloseIn
      // would divide 0 by 0.
      if (!Any(at_high > zero)) CloseIn(slip, low, at_low, high, at_high);
    }
    l_now[0] = Max(slip.ln, zero);
    l_now[1] = slip.l1;
    l_now[2] = slip.l2;
    Clamp(l_now);
  }

  /// Computes `rebound` (eq. 9-10): the speed that reaches the height prescribed by restitution,
  /// from the gap at which the step detects the contact, under constant acceleration. `warm`:
  /// normal velocity from forces and the impulses of the previous step. Returns false without a
  /// rebound.
  TAUT_INLINE bool ExpectRebound(Num warm) noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0), least = Num::Splat(kLeastRebound);
    const Num fastest = zero - restitution * before;
    closing = bias[0];
    rebound = zero;
    again = Select((before > least) & (live > zero), restitution, zero);
    const auto may = (fastest > least) & (live > zero);
    if (!Any(may)) return false;
    const Num half = Num::Splat(0.5), kick = Max(before - warm, zero);
    const Num arrives = half * kick - before, e2 = restitution * restitution;
    const Num fall = (one - e2) * (kick + kick) * Max(bias[0], zero);
    const Num leaves = Sqrt(Max(e2 * arrives * arrives - fall, zero)) - half * kick;
    const Num speed = Min(leaves, fastest);
    rebound = Select(may & (speed > least), speed, zero);
    return true;
  }
  /// Applies the rebound bias in those of `lanes` in which the contact closed and rebounds. Returns
  /// these lanes. `later`: contacts closed by the rebounds of others; they rebound with restitution
  /// times this closing speed.
  MaskOf<Num> Rebound(const Num* u, const Num* l_now, MaskOf<Num> lanes, bool later) noexcept {
    const Num zero = Num::Splat(0.0);
    if (later && Any(again > zero)) {
      const Num own = wnn * l_now[0] + w1n * l_now[1] + w2n * l_now[2];
      const Num speed = again * (own - u[0]);
      const auto hit = lanes & (rebound == zero) & (speed > Num::Splat(kLeastRebound));
      rebound = Select(hit, speed, rebound);
    }
    const auto now = lanes & (l_now[0] > zero) & (rebound > zero) & (rebound + bias[0] > zero);
    bias[0] = Select(now, zero - rebound, bias[0]);
    return now;
  }
  /// Undoes Rebound.
  void ForgetRebound(MaskOf<Num> lanes) noexcept { bias[0] = Select(lanes, closing, bias[0]); }

  /// Computes the errors of the velocities that branch `b` prescribes; 0 for other velocities.
  void Miss(const Branch& b, const Num* u, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0);
    const auto sticks = b.closed & !b.slides;
    out[0] = Select(b.closed, u[0] + bias[0], zero);
    out[1] = Select(sticks, u[1] + bias[1], zero);
    out[2] = one_direction ? zero : Select(sticks, u[2] + bias[2], zero);
  }
  /// Returns the largest t for which l + t dl stays on the branch `b` (eq. 18a); 1e300 without a
  /// limit.
  Num Reach(const Branch& b, const Num* l_now, const Num* dl) const noexcept {
    const Num zero = Num::Splat(0.0), never = Num::Splat(1e300);
    // At the boundary of the cone: |lt + t dlt|^2 = mu^2 (ln + t dln)^2
    const Num dl2 = one_direction ? zero : dl[2], mu2 = mu * mu;
    const Num a = dl[1] * dl[1] + dl2 * dl2 - mu2 * dl[0] * dl[0];
    const Num half = l_now[1] * dl[1] + l_now[2] * dl2 - mu2 * l_now[0] * dl[0];
    const Num inside =
        Max(mu2 * l_now[0] * l_now[0] - l_now[1] * l_now[1] - l_now[2] * l_now[2], zero);
    const Num square = half * half + a * inside;
    // This form avoids cancellation. There is a root only if the ray leaves the cone.
    const Num divisor = half + Sqrt(Max(square, zero));
    const Num leaves = Select((square > zero) & (divisor > zero), inside / divisor, never);
    const Num ends = Select(dl[0] < zero, Max(l_now[0], zero) / (zero - dl[0]), never);
    return Select(b.closed, Min(ends, Select(b.slides, never, leaves)), never);
  }
  /// For inconsistent contacts (eq. 28a): computes the smallest change of u that satisfies the law
  /// with the impulses l on branch `b`; impulses of open contacts are ignored. The change consists
  /// of the error of un = -bias and of a part of the slip: the whole slip if l is inside the cone;
  /// the part not opposite to friction if l is on the cone's boundary.
  void Disagreement(const Branch& b, const Num* u, const Num* l_now, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0);
    const Num l1 = l_now[1], l2 = one_direction ? zero : l_now[2];
    const Num u1 = u[1] + bias[1], u2 = one_direction ? zero : u[2] + bias[2];
    // Because of rounding, a clamped impulse may be slightly inside the boundary.
    const Num edge = Num::Splat(1.0 - 1e-9) * mu * l_now[0], length2 = l1 * l1 + l2 * l2;
    const Num against = Min(u1 * l1 + u2 * l2, zero) / Max(length2, Num::Splat(1e-300));
    const Num share = Select(length2 > edge * edge, against, zero);
    out[0] = Select(b.closed, u[0] + bias[0], zero);
    out[1] = Select(b.closed, u1 - share * l1, zero);
    out[2] = Select(b.closed, u2 - share * l2, zero);
  }
  /// Changes the velocities that satisfy the law by `change`.
  void Relax(const Num* change) noexcept {
    for (int r = 0; r < kRows; ++r) bias[r] -= change[r];
  }

  void Clamp(Num* l_now) const noexcept {
    const Num zero = Num::Splat(0.0);
    l_now[0] = Max(l_now[0], zero);
    if (one_direction) l_now[2] = zero;
    const Num edge = mu * l_now[0], length2 = l_now[1] * l_now[1] + l_now[2] * l_now[2];
    const auto out = length2 > edge * edge;
    if (!Any(out)) return;
    const Num scale = edge / Sqrt(Max(length2, Num::Splat(1e-300)));
    l_now[1] = Select(out, scale * l_now[1], l_now[1]);
    l_now[2] = Select(out, scale * l_now[2], l_now[2]);
  }

 private:
  struct Slip {
    Num s11, s12, s22, q1, q2, qn;  ///< Tangential problem after elimination of the normal impulse.
    Num ln, l1, l2;
  };

  /// Computes |lt| - mu ln for the stiffness k against slip.
  Num Excess(Slip& s, Num k) const noexcept {
    const Num zero = Num::Splat(0.0);
    const Num a = s.s11 + k, c = s.s22 + k;
    const Num inverse = Num::Splat(1.0) / (a * c - s.s12 * s.s12);
    s.l1 = zero - inverse * (c * s.q1 - s.s12 * s.q2);
    s.l2 = zero - inverse * (a * s.q2 - s.s12 * s.q1);
    s.ln = zero - inv_wnn * (s.qn + w1n * s.l1 + w2n * s.l2);
    return Sqrt(s.l1 * s.l1 + s.l2 * s.l2) - mu * s.ln;
  }

  /// Root search by regula falsi (Illinois). Every fourth step uses the geometric mean, because k
  /// may range over many decades.
  void CloseIn(Slip& s, Num low, Num at_low, Num high, Num at_high) const noexcept {
    const Num half = Num::Splat(0.5), tiny = Num::Splat(1e-15);
    int side = 0;
    for (int i = 0; i < 80; ++i) {
      const Num k = i % 4 == 3 ? Sqrt(Max(low, Num::Splat(1e-12) * high) * high)
                               : (low * at_high - high * at_low) / (at_high - at_low);
      const Num f = Excess(s, k);
      if (!Any(Abs(f) > tiny * mu * Abs(s.ln)) || !Any(high - low > tiny * high)) return;
      if (Any(f > Num::Splat(0.0))) {
        low = k, at_low = f;
        if (side == 1) at_high = half * at_high;
        side = 1;
      } else {
        high = k, at_high = f;
        if (side == -1) at_low = half * at_low;
        side = -1;
      }
    }
  }

  TAUT_INLINE Branch Friction(const Num* u, const Num* center, Num inv_e, Num edge,
                              MaskOf<Num> closed, Num* out) const noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0), step = inv_e * inv_wt;
    Branch b;
    b.closed = closed;
    b.s1 = b.s2 = b.shrink = zero;
    out[1] = center[1] - step * (u[1] + bias[1]);
    out[2] = one_direction ? zero : center[2] - step * (u[2] + bias[2]);
    const Num length2 = out[1] * out[1] + out[2] * out[2];
    b.slides = length2 > edge * edge;
    if (Any(b.slides)) {
      const Num inverse = one / Sqrt(Max(length2, Num::Splat(1e-300)));
      b.s1 = inverse * out[1], b.s2 = inverse * out[2], b.shrink = edge * inverse;
      out[1] = Select(b.slides, edge * b.s1, out[1]);
      out[2] = Select(b.slides, edge * b.s2, out[2]);
    }
    return b;
  }
};

}  // namespace taut::sim
