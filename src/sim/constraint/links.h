/// How a constraint acts on bodies: its links.
///
/// A constraint of R rows has velocities u = sum over its links of J (v, w) and impulses l, one a
/// row. A link is the part of J that belongs to one body, with that body's inverse mass worked in.
/// The same text serves all lanes of a group and one lane by itself (simd::Lane).
#pragma once

#include "simd/vec3.h"

namespace taut::sim {

using simd::V3;

/// Slower rebounds are lost in what a solve leaves over [m/s].
inline constexpr double kLeastRebound = 1e-9;

template <class Num>
using MaskOf = decltype(Num() < Num());

template <class Num, int R>
struct Link {
  int body;
  Num inv_mass;     ///< [1/kg]
  V3<Num> lin[R];   ///< Of each row: its direction,
  V3<Num> ang[R];   ///< its lever about the centre of mass [m],
  V3<Num> turn[R];  ///< and inverse inertia times that: spin per impulse [rad/s per N s].
};

/// Velocity of a body: of its centre of mass, and its spin.
template <class Num>
struct Twist {
  V3<Num> v, w;
};

/// u += J (v, w).
template <class Num, int R>
TAUT_INLINE void AddVelocity(const Link<Num, R>& link, const V3<Num>& v, const V3<Num>& w,
                             Num* u) noexcept {
  for (int r = 0; r < R; ++r) u[r] += Dot(link.lin[r], v) + Dot(link.ang[r], w);
}

/// (v, w) += M^-1 J^T l.
template <class Num, int R>
TAUT_INLINE void Push(const Link<Num, R>& link, const Num* l, V3<Num>& v, V3<Num>& w) noexcept {
  for (int r = 0; r < R; ++r) {
    v += (link.inv_mass * l[r]) * link.lin[r];
    w += l[r] * link.turn[r];
  }
}

/// c += J_a M^-1 J_b^T, of two links to one body; row by row.
template <class Num, int A, int B>
TAUT_INLINE void AddCoupling(const Link<Num, A>& a, const Link<Num, B>& b, Num* c) noexcept {
  for (int i = 0; i < A; ++i) {
    for (int j = 0; j < B; ++j) {
      c[B * i + j] += a.inv_mass * Dot(a.lin[i], b.lin[j]) + Dot(a.ang[i], b.turn[j]);
    }
  }
}

/// A law near some u and l: the change dl of its impulses that Newton's method asks for satisfies
/// (docs/theory/contact.md, eq. 18)
///   A dl + S du = r,   du: change of its velocities.
template <class Num, int R>
struct LinearLaw {
  Num A[R][R], S[R][R], r[R];
};

/// How many rows a constraint has: kRows, or, where that is the most that one may have, `rows`.
template <class Law>
TAUT_INLINE constexpr int RowsOf(const Law& law) noexcept {
  if constexpr (requires { law.rows; }) {
    return law.rows;
  } else {
    return Law::kRows;
  }
}

/// What a kind of constraint must offer for the solver. `u`: velocities, `l`: impulses, one a row.
///
///   Project      l' = P(center - u / (e w)): the law with the compliance e (a share of its own
///                inverse masses w) about `center`. Its fixed points are the law's solutions.
///   Derivative   -dl'/du of Project on that branch; with `frozen`, of ProjectFrozen.
///   ProjectFrozen  the same with what makes the law not convex kept at `l0` (the radius of
///                Coulomb's cone): the gradient of a convex function that equals Project at u0.
///   Stiffen      makes a derivative larger where Newton's steps go too far.
///   BranchOf     the branch of l = P(l - u / w) that u and l are on; on it:
///   Linearize    Newton's equations, with the compliance e; or Step, their solution,
///   Residual     how far u and l are from the law [m/s].
///   SolveAlone   impulses that satisfy the law if nothing else changes.
///   Clamp        impulses nearby that the law admits (no pull, inside the cone).
template <class K>
concept ConstraintLaw = requires(const K k, const typename K::Number* u, typename K::Number* l,
                                 typename K::Number e, typename K::Branch branch,
                                 LinearLaw<typename K::Number, K::kRows>& linear) {
  branch = k.Project(u, u, e, l);
  k.Derivative(branch, e, l);
  k.Stiffen(branch, e, l);
  k.ProjectFrozen(u, u, e, u, l);
  K::Same(branch, branch);
  branch = k.BranchOf(u, u);
  requires requires { k.Linearize(branch, u, u, e, linear); } || requires {
    k.Step(branch, u, u, e, l, l);
  };
  e = k.Residual(branch, u, u);
  k.SolveAlone(u, l);
  k.Clamp(l);
  k.links[0].body + k.link_count;
};

}  // namespace taut::sim
