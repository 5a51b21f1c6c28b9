/// Forces and stiffness matrix of stiff cables with changing directions, in one stage of the
/// implicit integration (docs/theory/cables.md, section 3).
///
/// First stage: the force is a discrete gradient in the lengths, and bodies rotate by the Cayley
/// map of their mean angular velocity. Therefore energy and momenta are conserved up to rounding at
/// any stiffness. Second stage: the force is evaluated at the end.
#pragma once

#include "math/scalar.h"
#include "sim/data/implicit_memory.h"
#include "sim/data/island.h"
#include "sim/solve/body_matrix.inl"
#include "simd/vec3.h"
#include "simd/wide.h"

namespace taut::sim {

using simd::M3;
using simd::RotationOf;
using simd::V3;

/// Returns [a] M, where [a] z = a x z.
template <class Num>
TAUT_INLINE M3<Num> CrossTimes(const V3<Num>& a, const M3<Num>& m) noexcept {
  return {a.y * m.r2 - a.z * m.r1, a.z * m.r0 - a.x * m.r2, a.x * m.r1 - a.y * m.r0};
}
/// Returns M [a].
template <class Num>
TAUT_INLINE M3<Num> TimesCross(const M3<Num>& m, const V3<Num>& a) noexcept {
  return {Cross(m.r0, a), Cross(m.r1, a), Cross(m.r2, a)};
}
template <class Num>
TAUT_INLINE M3<Num> Product(const M3<Num>& a, const M3<Num>& b) noexcept {
  const auto row = [&](const V3<Num>& r) { return r.x * b.r0 + r.y * b.r1 + r.z * b.r2; };
  return {row(a.r0), row(a.r1), row(a.r2)};
}
template <class Num>
TAUT_INLINE M3<Num> Scaled(Num f, const M3<Num>& m) noexcept {
  return {f * m.r0, f * m.r1, f * m.r2};
}
/// Returns f (1 - a b^T).
template <class Num>
TAUT_INLINE M3<Num> Across(Num f, const V3<Num>& a, const V3<Num>& b) noexcept {
  const Num x = f * a.x, y = f * a.y, z = f * a.z;
  return {{f - x * b.x, -x * b.y, -x * b.z},
          {-y * b.x, f - y * b.y, -y * b.z},
          {-z * b.x, -z * b.y, f - z * b.z}};
}
template <class Num>
TAUT_INLINE void AddOuter(M3<Num>& m, Num f, const V3<Num>& a, const V3<Num>& b) noexcept {
  m.r0 += (f * a.x) * b, m.r1 += (f * a.y) * b, m.r2 += (f * a.z) * b;
}
/// Returns the Cayley rotation (1 - [h])^-1 (1 + [h]) y; scale: 1 / (1 + h^2).
template <class Num>
TAUT_INLINE V3<Num> CayleyTurn(const V3<Num>& h, Num scale, const V3<Num>& y) noexcept {
  const V3<Num> t = Cross(h, y);
  return y + (scale + scale) * (t + Cross(h, t));
}
/// Returns (1 - [h])^-1.
template <class Num>
TAUT_INLINE M3<Num> CayleyInverse(const V3<Num>& h, Num scale) noexcept {
  const Num one = Num::Splat(1.0);
  return Scaled(scale, M3<Num>{{one + h.x * h.x, h.x * h.y - h.z, h.x * h.z + h.y},
                               {h.y * h.x + h.z, one + h.y * h.y, h.y * h.z - h.x},
                               {h.z * h.x - h.y, h.z * h.y + h.x, one + h.z * h.z}});
}

/// Stage of a step.
template <class Num>
struct ImplicitStage {
  Num h;        ///< Length of the stage [s].
  bool at_end;  ///< Forces at the end of the stage (implicit Euler).
};

/// Computes position and lever arm of a point of `body` at the end of the stage, and the mean lever
/// arm.
template <class Num>
TAUT_INLINE void MovePoint(const ImplicitStage<Num>& stage, const ImplicitBody<Num>& body,
                           ImplicitPoint<Num>& p) noexcept {
  p.arm1 = CayleyTurn(body.half, body.scale, p.arm0);
  p.p1 = body.x1 + p.arm1;
  p.arm = stage.at_end ? p.arm1 : Num::Splat(0.5) * (p.arm0 + p.arm1);
}

/// Returns the derivative of a vector fixed to `body` with respect to its angular velocity.
template <class Num>
TAUT_INLINE M3<Num> TurnOf(const ImplicitStage<Num>& stage, const ImplicitBody<Num>& body,
                           const V3<Num>& from, const V3<Num>& to) noexcept {
  return TimesCross(body.undo, (Num::Splat(-0.5) * stage.h) * (from + to));
}

/// Adds h C D B of the opposite pulls at both ends of a straight part. D: derivative with respect
/// to the end `a`; the derivative with respect to `b` is -D.
template <class Num>
TAUT_INLINE void AddPart(const ImplicitStage<Num>& stage, const ImplicitPoint<Num>& a,
                         const ImplicitPoint<Num>& b, const M3<Num>& D,
                         BodyMatrix<Num>& matrix) noexcept {
  const M3<Num> vv = Scaled(stage.h, D);
  const auto add = [&](const ImplicitPoint<Num>& on, const M3<Num>& wv, int by, const M3<Num>& vw,
                       bool opposite) {
    if (!opposite) return matrix.AddBlock(on.body, by, vv, vw, wv, CrossTimes(on.arm, vw));
    matrix.SubtractBlock(on.body, by, vv, vw, wv, CrossTimes(on.arm, vw));
  };
  const M3<Num> none{};
  const M3<Num> on_a = a.body >= 0 ? CrossTimes(a.arm, vv) : none,
                on_b = b.body >= 0 ? CrossTimes(b.arm, vv) : none;
  const M3<Num> by_a = a.body >= 0 ? Product(D, a.turn) : none,
                by_b = b.body >= 0 ? Product(D, b.turn) : none;
  if (a.body >= 0) add(a, on_a, a.body, by_a, false);
  if (b.body >= 0) add(b, on_b, b.body, by_b, false);
  if (a.body < 0 || b.body < 0) return;
  add(a, on_a, b.body, by_b, true);
  add(b, on_b, a.body, by_a, true);
}

/// Adds h C D B of a pull at `a`. D: its derivative with respect to the point `b`.
template <class Num>
TAUT_INLINE void AddPair(const ImplicitStage<Num>& stage, const ImplicitPoint<Num>& a,
                         const ImplicitPoint<Num>& b, const M3<Num>& D,
                         BodyMatrix<Num>& matrix) noexcept {
  const M3<Num> vw = Product(D, b.turn), vv = Scaled(stage.h, D);
  matrix.AddBlock(a.body, b.body, vv, vw, CrossTimes(a.arm, vv), CrossTimes(a.arm, vw));
}

/// Cables and bodies of an island for Newton's method. Unknowns: mean velocities of the stage
/// (implicit Euler: final velocities), 6 numbers per body.
template <class W>
class ImplicitCables {
 public:
  using Num = simd::Lane<W>;

  ImplicitCables(ImplicitMemory<W>& mem, const Unknown<Num>* unknowns, int count) noexcept
      : mem_(mem), unknowns_(unknowns), count_(count) {}

  int cable_count = 0, point_count = 0;
  Num most_tension = Num::Splat(0.0);  ///< Largest tension in the last evaluation [N].

  /// Computes arms, lengths and inertias at the start of a stage.
  void Begin() noexcept {
    for (int k = 0; k < count_; ++k) {
      ImplicitBody<Num>& b = mem_.body[k];
      if (!b.turns) continue;
      const M3<Num> R = RotationOf(b.q);
      b.inertia = Congruence(R, b.moments);
      b.w = Congruence(R, b.inv_moments) * b.L;
      b.y = b.L1 = b.L;
    }
    int body = -1;
    M3<Num> R{};
    for (int i = 0; i < point_count; ++i) {
      ImplicitPoint<Num>& p = mem_.points[i];
      if (p.body < 0) continue;
      if (p.body != body) R = RotationOf(mem_.body[p.body].q);
      body = p.body;
      p.arm0 = R * p.p_P;
      p.p0 = mem_.body[body].x + p.arm0;
    }
    for (int c = 0; c < cable_count; ++c) {
      ImplicitCable<Num>& cable = mem_.list[c];
      ImplicitPoint<Num>* const p = mem_.points + cable.first;
      cable.l0 = Num::Splat(0.0);
      for (int i = 0; i + 1 < cable.count; ++i) {
        p[i].d0 = p[i + 1].p0 - p[i].p0;
        p[i].l0 = Sqrt(Dot(p[i].d0, p[i].d0));
        cable.l0 += p[i].l0;
      }
    }
  }

  /// Computes res: final momenta minus momenta under all forces except contacts.
  void Evaluate(const ImplicitStage<Num>& stage, const Num* U, Num* res) noexcept {
    const Num one = Num::Splat(1.0), half = Num::Splat(0.5);
    for (int k = 0; k < count_; ++k) {
      ImplicitBody<Num>& b = mem_.body[k];
      const V3<Num> v{U[6 * k], U[6 * k + 1], U[6 * k + 2]};
      const V3<Num> w{U[6 * k + 3], U[6 * k + 4], U[6 * k + 5]};
      V3<Num> gained = b.mass * (b.ahead * v + b.behind * b.v - b.v);
      V3<Num> turned;
      if (b.turns) {
        b.half = (half * stage.h) * w;
        b.scale = one / (one + Dot(b.half, b.half));
        b.x1 = b.x + stage.h * v;
        b.y = b.inertia * (b.ahead * w + b.behind * b.w);
        b.L1 = CayleyTurn(b.half, b.scale, b.y);
        turned = b.L1 - b.L;
      } else {
        turned = b.inertia * (w - b.w);
      }
      gained -= b.share * b.force;
      turned -= b.share * b.torque;
      Add3(res + 6 * k, gained, turned, true);
    }
    for (int i = 0; i < point_count; ++i) {
      ImplicitPoint<Num>& p = mem_.points[i];
      if (p.body < 0) {
        p.p1 = p.p0;
        continue;
      }
      MovePoint(stage, mem_.body[p.body], p);
    }
    most_tension = Num::Splat(0.0);
    for (int c = 0; c < cable_count; ++c) Pull(stage, mem_.list[c], res);
  }

  /// Adds the derivative of the last Evaluate. `missing`: minus the residual, including contacts.
  /// Torque balances are multiplied by (1 - [half]), which transforms them to the frame halfway
  /// through the rotation. In that frame, a force on the axis of a slender body causes only
  /// transverse rotation, at any angle. Otherwise the first Newton steps would spin the body about
  /// its axis, where its moment of inertia is nearly 0.
  void AddTo(const ImplicitStage<Num>& stage, const Num* missing,
             BodyMatrix<Num>& matrix) noexcept {
    const Num zero = Num::Splat(0.0), half = Num::Splat(0.5);
    const M3<Num> none{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
    for (int k = 0; k < count_; ++k) {
      ImplicitBody<Num>& b = mem_.body[k];
      const Num m = b.ahead * b.mass;
      const S3<Num>& I = b.inertia;
      M3<Num> spin{{I.xx, I.xy, I.xz}, {I.xy, I.yy, I.yz}, {I.xz, I.yz, I.zz}};
      if (b.turns) {
        // Rotated columns of I, and their derivatives with respect to the rotation.
        const auto column = [&](const V3<Num>& i) { return CayleyTurn(b.half, b.scale, i); };
        const V3<Num> c0 = column(spin.r0), c1 = column(spin.r1), c2 = column(spin.r2);
        spin = {{c0.x, c1.x, c2.x}, {c0.y, c1.y, c2.y}, {c0.z, c1.z, c2.z}};
        spin = Scaled(b.ahead, spin);
        b.undo = CayleyInverse(b.half, b.scale);
        const Num* const f = missing + kDofs * k + 3;
        const V3<Num> turned = b.y + b.L1 + V3<Num>{f[0], f[1], f[2]};
        const M3<Num> more = TimesCross(b.undo, (half * stage.h) * turned);
        spin.r0 -= more.r0, spin.r1 -= more.r1, spin.r2 -= more.r2;
      }
      matrix.AddBlock(k, k, {{m, zero, zero}, {zero, m, zero}, {zero, zero, m}}, none, none, spin);
    }
    for (int i = 0; i < point_count; ++i) {
      ImplicitPoint<Num>& p = mem_.points[i];
      if (p.body >= 0) p.turn = TurnOf(stage, mem_.body[p.body], p.arm0, p.arm1);
    }
    for (int c = 0; c < cable_count; ++c) AddCable(stage, mem_.list[c], matrix);
  }

  /// Transforms `missing` of the last Evaluate to its halfway frame, for use with a matrix that
  /// AddTo computed at another state.
  void SeenThere(Num* missing) const noexcept {
    for (int k = 0; k < count_; ++k) {
      const ImplicitBody<Num>& b = mem_.body[k];
      if (!b.turns) continue;
      Num* const f = missing + kDofs * k + 3;
      const V3<Num> r{f[0], f[1], f[2]}, seen = b.undo * (r - Cross(b.half, r));
      f[0] = seen.x, f[1] = seen.y, f[2] = seen.z;
    }
  }

 private:
  static void Add3(Num* to, const V3<Num>& a, const V3<Num>& b, bool set) noexcept {
    const Num part[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
    for (int i = 0; i < 6; ++i) to[i] = set ? part[i] : to[i] + part[i];
  }

  /// Computes tension and its slope from the final length (eq. 8; in the second stage, the final
  /// tension).
  static void SetTension(const ImplicitStage<Num>& stage, Num l1, ImplicitCable<Num>& c) noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0), half = Num::Splat(0.5);
    const Num longer = l1 - c.l0;
    const Num s0 = c.l0 - c.rest, s1 = (l1 - c.rest) - stage.h * c.rate;
    const Num p0 = Max(s0, zero), p1 = Max(s1, zero), damper = c.b / stage.h;
    const bool was = Any(s0 > zero), is = Any(s1 > zero);
    Num phi = one, bend = zero;  // taut fraction of the length change, and its slope
    if (was != is) {
      const Num way = one / (s1 - s0);
      phi = (p1 - p0) * way;
      bend = ((is ? one : zero) - phi) * way;
    } else if (!is) {
      c.tension = c.elastic = c.slope = zero;
      return;
    }
    if (stage.at_end) {
      c.tension = c.k * p1;
      c.slope = is ? c.k : zero;
    } else if (was && is) {
      c.tension = half * c.k * (s0 + s1);
      c.slope = half * c.k;
    } else {
      c.tension = half * c.k * (p1 + p0) * phi;
      c.slope = (c.k * p1 - c.tension) / (s1 - s0);
    }
    c.elastic = c.tension;
    c.tension += damper * longer * phi;
    c.slope += damper * (phi + longer * bend);
    if (Any(c.tension < zero)) c.tension = c.slope = zero;
    if (Any(c.tension > c.most)) c.tension = c.most, c.slope = zero;
  }

  void Pull(const ImplicitStage<Num>& stage, ImplicitCable<Num>& cable, Num* res) noexcept {
    const Num one = Num::Splat(1.0);
    ImplicitPoint<Num>* const p = mem_.points + cable.first;
    Num l1 = Num::Splat(0.0);
    for (int i = 0; i + 1 < cable.count; ++i) {
      const V3<Num> d1 = p[i + 1].p1 - p[i].p1;
      p[i].l1 = Sqrt(Dot(d1, d1));
      p[i].n = (one / p[i].l1) * d1;
      p[i].u = stage.at_end ? p[i].n : (one / (p[i].l0 + p[i].l1)) * (p[i].d0 + d1);
      l1 += p[i].l1;
    }
    SetTension(stage, l1, cable);
    most_tension = Max(cable.tension, most_tension);
    const Num pull = stage.h * cable.tension;
    for (int i = 0; i < cable.count; ++i) {
      if (p[i].body < 0) continue;
      const V3<Num> f = -pull * Along(p, cable.count, i, &ImplicitPoint<Num>::u);
      Add3(res + 6 * p[i].body, f, Cross(p[i].arm, f), false);
    }
  }

  /// Returns the pull direction of a cable at a point.
  static V3<Num> Along(const ImplicitPoint<Num>* p, int count, int i,
                       V3<Num> ImplicitPoint<Num>::*which) noexcept {
    if (i == 0) return p[0].*which;
    if (i == count - 1) return -(p[i - 1].*which);
    return p[i].*which - p[i - 1].*which;
  }

  void AddCable(const ImplicitStage<Num>& stage, const ImplicitCable<Num>& cable,
                BodyMatrix<Num>& matrix) noexcept {
    const Num zero = Num::Splat(0.0), half = Num::Splat(0.5);
    const M3<Num> none{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
    const ImplicitPoint<Num>* const p = mem_.points + cable.first;
    const int count = cable.count;
    if (!Any(cable.tension > zero) && !Any(cable.slope > zero)) return;
    const Num pull = stage.h * cable.tension, slope = stage.h * cable.slope;
    for (int i = 0; i + 1 < count; ++i) {
      const Num length = stage.at_end ? p[i].l1 : p[i].l0 + p[i].l1;
      M3<Num> D = Across(pull / length, p[i].u, p[i].n);
      if (count == 2) AddOuter(D, slope, p[i].u, p[i].n);
      AddPart(stage, p[i], p[i + 1], D, matrix);
    }
    for (int i = 0; i < count; ++i) {
      if (p[i].body < 0) continue;
      const V3<Num> g = Along(p, count, i, &ImplicitPoint<Num>::u);
      // Adds the derivative of the rotating lever arm.
      const Num f = stage.at_end ? pull : half * pull;
      matrix.AddSpins(p[i].body, p[i].body, CrossTimes(f * g, p[i].turn));
      for (int j = 0; count > 2 && j < count; ++j) {
        if (p[j].body < 0) continue;
        M3<Num> D = none;
        AddOuter(D, slope, g, Along(p, count, j, &ImplicitPoint<Num>::n));
        AddPair(stage, p[i], p[j], D, matrix);
      }
    }
  }

  ImplicitMemory<W>& mem_;
  const Unknown<Num>* unknowns_;
  int count_;
};

}  // namespace taut::sim
