/// Links of constraints to bodies: Jacobians and inverse masses, the factors of the Delassus
/// operator W = J M^-1 J^T.
///
/// A constraint with R rows has velocities u, the sum of J (v, w) over its links, and one impulse l
/// per row. A link contains the part of J for one body, and the inverse mass. The same code serves
/// all lanes of a group and a single lane (simd::Lane).
#pragma once

#include "simd/vec3.h"

namespace taut::sim {

using simd::V3;

/// Rebounds below this speed are within the residual of a solve [m/s].
inline constexpr double kLeastRebound = 1e-9;

template <class Num>
using MaskOf = decltype(Num() < Num());

template <class Num, int R>
struct Link {
  int body;
  Num inv_mass;    ///< Inverse mass of the body [1/kg].
  V3<Num> lin[R];  ///< Per row: direction.
  V3<Num> ang[R];  ///< Per row: lever arm about the center of mass [m].
  /// Per row: inverse inertia * lever arm, the angular velocity per impulse [rad/s per N s].
  V3<Num> turn[R];
};

/// Velocity of the center of mass and angular velocity of a body.
template <class Num>
struct Twist {
  V3<Num> v, w;
};

/// Adds the velocities of a link: u += J (v, w).
template <class Num, int R>
TAUT_INLINE void AddVelocity(const Link<Num, R>& link, const V3<Num>& v, const V3<Num>& w,
                             Num* u) noexcept {
  for (int r = 0; r < R; ++r) u[r] += Dot(link.lin[r], v) + Dot(link.ang[r], w);
}

/// Applies the impulses of a link: (v, w) += M^-1 J^T l.
template <class Num, int R>
TAUT_INLINE void Push(const Link<Num, R>& link, const Num* l, V3<Num>& v, V3<Num>& w) noexcept {
  for (int r = 0; r < R; ++r) {
    v += (link.inv_mass * l[r]) * link.lin[r];
    w += l[r] * link.turn[r];
  }
}

/// Adds a block of the Delassus operator for two links to one body: c += J_a M^-1 J_b^T.
template <class Num, int A, int B>
TAUT_INLINE void AddCoupling(const Link<Num, A>& a, const Link<Num, B>& b, Num* c) noexcept {
  for (int i = 0; i < A; ++i) {
    for (int j = 0; j < B; ++j) {
      c[B * i + j] += a.inv_mass * Dot(a.lin[i], b.lin[j]) + Dot(a.ang[i], b.turn[j]);
    }
  }
}

/// Law linearized at some u and l. Newton's change dl of the impulses and the change du of the
/// velocities satisfy (docs/theory/contact.md, eq. 18)
///   A dl + S du = r
template <class Num, int R>
struct LinearLaw {
  Num A[R][R], S[R][R], r[R];
};

/// Returns the number of rows of a constraint: `rows` if kRows is only an upper bound, otherwise
/// kRows.
template <class Law>
TAUT_INLINE constexpr int RowsOf(const Law& law) noexcept {
  if constexpr (requires { law.rows; }) {
    return law.rows;
  } else {
    return Law::kRows;
  }
}

/// Functions that the solver needs for each kind of constraint. `u`: velocities, `l`: impulses, one
/// per row.
///
///   Project      l' = P(center - u / (e w)): the law with the compliance e (a share of its
///                inverse masses w), centered at `center`. Its fixed points solve the law.
///   Derivative   -dl'/du of Project on that branch.
///   ProjectFrozen  Project with its non-convex part frozen at `l0` (radius of Coulomb's cone):
///                gradient of a convex function that equals Project at u0.
///   Stiffen      enlarges a derivative where Newton's steps would be too long.
///   BranchOf     branch of l = P(l - u / w) at u and l; on this branch:
///   Linearize    Newton's equations, with the compliance e; or Step, their solution,
///   Residual     distance of u and l from the law [m/s].
///   SolveAlone   impulses that satisfy the law if nothing else changes.
///   Clamp        nearby admissible impulses (no pull, inside the cone).
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
