/// First stage of an island's solve: plain Newton's method on all laws, without globalization. It
/// usually takes two steps (docs/theory/contact.md, eq. 18, 21-22).
#pragma once

#include "math/scalar.h"
#include "sim/constraint/links.h"
#include "sim/data/island.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/deadlock.inl"

namespace taut::sim {

/// Inverts a small matrix without pivoting, because matrices of laws have large diagonals.
template <class Num, int R>
TAUT_INLINE void InvertSmall(const Num (&a)[R][R], Num (&out)[R][R]) noexcept {
  const Num one = Num::Splat(1.0);
  if constexpr (R == 1) {
    out[0][0] = one / a[0][0];
  } else {
    static_assert(R == 3);
    Num c[3][3];
    for (int i = 0; i < 3; ++i) {
      const int p = (i + 1) % 3, q = (i + 2) % 3;
      for (int j = 0; j < 3; ++j) {
        const int r = (j + 1) % 3, s = (j + 2) % 3;
        c[i][j] = a[p][r] * a[q][s] - a[p][s] * a[q][r];
      }
    }
    const Num inverse = one / (a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2]);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out[i][j] = inverse * c[j][i];
    }
  }
}

/// Compliance of all laws in plain Newton's method, relative to their inverse masses.
inline constexpr double kNewtonCompliance = 1e-7;

/// Computes G = A^-1 S and f = A^-1 r of a law: dl = f - G du. Returns the lanes in which G is
/// symmetric.
template <class Num, int R>
TAUT_INLINE MaskOf<Num> SolveLaw(const LinearLaw<Num, R>& linear, Num* g, Num* f) noexcept {
  Num inverse[R][R];
  InvertSmall(linear.A, inverse);
  for (int i = 0; i < R; ++i) {
    Num wish = inverse[i][0] * linear.r[0];
    for (int k = 1; k < R; ++k) wish += inverse[i][k] * linear.r[k];
    f[i] = wish;
    for (int j = 0; j < R; ++j) {
      Num sum = inverse[i][0] * linear.S[0][j];
      for (int k = 1; k < R; ++k) sum += inverse[i][k] * linear.S[k][j];
      g[R * i + j] = sum;
    }
  }
  auto symmetric = MaskOf<Num>::Splat(true);
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < i; ++j) symmetric = symmetric & (g[R * i + j] == g[R * j + i]);
  }
  return symmetric;
}

/// Computes g and f of a law near u and l, with the compliance e. Returns the lanes in which g is
/// symmetric.
template <class Law, class Num>
TAUT_INLINE MaskOf<Num> StepOf(const Law& law, const typename Law::Branch& branch, const Num* u,
                               const Num* l, Num e, Num* g, Num* f) noexcept {
  if constexpr (requires { law.Step(branch, u, l, e, g, f); }) {
    return MaskOf<Num>::Splat(law.Step(branch, u, l, e, g, f));
  } else {
    LinearLaw<Num, Law::kRows> linear;
    law.Linearize(branch, u, l, e, linear);
    return SolveLaw(linear, g, f);
  }
}

/// Takes one step of Newton's method from m.l, m.u and the current branches of the laws. Results:
/// m.l with its velocities in m.v and m.u. Returns false if there is no step.
template <class Num, class P>
bool NewtonStep(Island<Num, P>& island, SolverWork& work) noexcept {
  auto& m = island.m;
  const Num zero = Num::Splat(0.0), e = Num::Splat(kNewtonCompliance);
  BodyMatrix<Num> matrix(island.pattern, m.blocks);
  // dl = f - g du,  f = A^-1 r,  g = A^-1 S
  for (int i = 0; i < kDofs * island.body_count; ++i) m.rhs[i] = zero;
  bool symmetric = true;
  island.pools.ForEach([&](auto& law, auto& branch, int row, int cell) {
    const bool even = Any(StepOf(law, branch, m.u + row, m.l + row, e, m.g + cell, m.f + row));
    symmetric = symmetric && even;
    island.AddForce(law, m.f + row, m.rhs);
  });
  matrix.Start(island.bodies, symmetric);
  island.pools.ForEach([&](auto& law, auto&, int, int cell) { matrix.Add(law, m.g + cell); });
  ++work.linear_solves;
  if (!matrix.Factor()) return false;
  matrix.Solve(m.rhs);
  island.Measure(m.rhs, m.du);
  island.pools.ForEach([&](auto& law, auto&, int row, int cell) {
    const int R = RowsOf(law);
    for (int i = 0; i < R; ++i) {
      Num dl = m.f[row + i];
      for (int j = 0; j < R; ++j) dl -= m.g[cell + R * i + j] * m.du[row + j];
      m.l[row + i] += dl;
    }
  });
  island.VelocitiesOf(m.l, m.v);
  island.Measure(m.v, m.u);
  return true;
}

/// Solves from m.l. Result: the best impulses found, made admissible, in m.l. On entry and return,
/// m.v and m.u are the velocities of m.l. Returns the residual [m/s].
template <class Num, class P>
double PlainNewton(Island<Num, P>& island, Target target, SolverWork& work) noexcept {
  constexpr int kMaxIterations = 12, kMaxDeadlocks = 8;
  constexpr double kLostFactor = 1e3, kStays = 0.1;
  auto& m = island.m;
  double residual = island.Residual(m.u, m.l)[0], best = residual;
  for (int i = 0; i < island.rows; ++i) m.best[i] = m.l[i];
  int iterations = kMaxIterations, stayed = 0, deadlocks = 0;
  for (int iteration = 0; iteration < iterations && (iteration == 0 || residual > target.goal()) &&
                          work.linear_solves < work.limit;
       ++iteration) {
    for (int i = 0; stayed > 0 && i < island.rows; ++i) {
      m.u2[i] = m.u[i], m.projected[i] = m.l[i];
    }
    if (!NewtonStep(island, work)) break;
    const double before = residual;
    residual = island.Residual(m.u, m.l)[0];
    if (residual <= target.tolerance && residual > Target::kPays * before) break;
    if (!(residual - residual == 0)) break;
    stayed = Stays(residual, before, kStays * before) ? stayed + 1 : 0;
    if (stayed > 1 && residual < kDisagreementMPerS && deadlocks < kMaxDeadlocks) {
      if (DeadlockBreaker<Num, P>(island).Break()) {
        ++deadlocks, stayed = 0, iterations = iteration + kMaxIterations;
        residual = island.Judge();
        continue;
      }
    }
    if (residual < best) {
      best = residual;
      for (int i = 0; i < island.rows; ++i) m.best[i] = m.l[i];
    } else if (residual > kLostFactor * best && iteration > 1) {
      break;
    }
  }
  // Impulses slightly outside of the cone are moved into it.
  return island.Return(residual <= best ? m.l : m.best);
}

}  // namespace taut::sim
