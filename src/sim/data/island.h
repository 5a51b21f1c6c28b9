/// Island: bodies coupled by constraints, solved as one problem, with memory shared by the stages
/// of the solver (docs/theory/contact.md, section 5 and eq. 11).
///
///   v = v_free + M^-1 J^T l,   u = J v,   every constraint's law between its u and its l
///
/// An unknown is a body, a point mass or a rotor. Unknowns to solve for are numbered in elimination
/// order; unknowns with prescribed velocities are last. All constraints of a kind are in one pool;
/// their rows are numbered consecutively, pool after pool.
#pragma once

#include "sim/constraint/cable_chain.h"
#include "sim/constraint/links.h"
#include "sim/data/elimination.h"
#include "sim/data/room.h"

namespace taut::sim {

using simd::S3;

/// Largest change of a bias that relaxes inconsistent contacts [m/s].
inline constexpr double kDisagreementMPerS = 1e-6;

/// Largest number of velocities of an unknown; a body has v and w.
inline constexpr int kDofs = 6;

/// Convergence targets [m/s]. A solve must reach `tolerance`. While each step at least halves the
/// residual, the solve continues to `goal`, because remaining errors accumulate over steps.
struct Target {
  static constexpr double kGoal = 0.01, kPays = 0.5;
  double tolerance;
  double goal() const noexcept { return kGoal * tolerance; }
};

/// Work counters and limits for the solve of an island.
struct SolverWork {
  int linear_solves = 0, limit = 0;
  double relaxation = 0;  ///< Largest relaxation of inconsistent biases [m/s].
};

/// Returns whether a residual has changed by less than `bound` between two steps.
inline bool Stays(double now, double before, double bound) noexcept {
  return now - before < bound && before - now < bound;
}

/// Body of an island, or a smaller unknown. All are stored with six velocities (v, w). Entries
/// beyond the size of the unknown are zero, also in its links.
///
///   size 6: a body
///        3: a point mass: v, mass; no inertia
/// 1: a rotor: v.x is its angular velocity, mass its moment of inertia, lin.x of a link its lever
/// arm
/// Links to a prescribed unknown have zero inverse mass and `turn`, because impulses do not move
/// this unknown.
template <class Num>
struct Unknown {
  int body;          ///< Index in the world.
  int size = kDofs;  ///< Number of velocities: 6, 3 or 1.
  Num mass, inv_mass;
  S3<Num> inertia, inv_inertia;  ///< Inertia and its inverse, in W.
  Twist<Num> free;               ///< Velocities without the constraints of the island.
  Twist<Num> before;             ///< Velocities at the start of the step.
};

/// All constraints of one kind, with the current branches of their laws.
template <class K>
struct Pool {
  Row<K> items{nullptr, 0};
  Row<typename K::Branch> branches{nullptr, 0};
  int count = 0;
};

template <class... K>
struct Pools : Pool<K>... {
  static_assert((ConstraintLaw<K> && ...));

  /// Calls f(law, branch, first row, first entry of its rows x rows matrix) for each constraint.
  template <class F>
  TAUT_INLINE void ForEach(F&& f) const noexcept {
    int row = 0, cell = 0;
    (Visit(static_cast<const Pool<K>&>(*this), f, row, cell), ...);
  }
  int rows() const noexcept {
    int sum = 0;
    ForEach([&](auto& law, auto&, int row, int) { sum = row + RowsOf(law); });
    return sum;
  }
  int cells() const noexcept {
    int sum = 0;
    ForEach([&](auto& law, auto&, int, int cell) { sum = cell + RowsOf(law) * RowsOf(law); });
    return sum;
  }

 private:
  template <class K1, class F>
  TAUT_INLINE static void Visit(const Pool<K1>& pool, F& f, int& row, int& cell) noexcept {
    for (int i = 0; i < pool.count; ++i) {
      f(pool.items[i], pool.branches[i], row, cell);
      const int rows = RowsOf(pool.items[i]);
      row += rows;
      cell += rows * rows;
    }
  }
};

/// Strips the reference from `const Law&` or `Law&`.
template <class T>
struct Named {
  using Type = T;
};
template <class T>
struct Named<T&> {
  using Type = T;
};
template <class T>
using LawOf = typename Named<T>::Type;

/// Impact data per row: velocities before the step, and the solution without rebounds.
template <class Num>
struct ImpactRows {
  Row<Num> before, u, l;
};

/// Vectors and matrices for the stages of an island's solve.
template <class Num>
struct IslandMemory {
  Row<Num> v, rhs, direction, trial_v;             ///< Vectors with 6 numbers per unknown.
  Row<Num> l, u, best, center, projected, du, u2;  ///< Vectors with one number per row.
  Row<Num> g, f;                                   ///< Per constraint: rows^2 (g), rows (f).
  Row<Num> blocks;                                 ///< Matrix blocks, 36 numbers each.
  ImpactRows<Num> impacts;
};

template <class Num, class P>
struct Island {
  Row<Unknown<Num>> bodies;
  int body_count;        ///< Includes prescribed unknowns, numbered from pattern.count.
  BlockPattern pattern;  ///< Pattern of the unknowns that are not prescribed.
  P pools;
  IslandMemory<Num> m;
  int rows;
  bool has_matrix;  ///< Whether there is memory for the linear systems.

  /// Computes velocities: v <- v_free + M^-1 J^T l.
  void VelocitiesOf(const Num* l, Num* v) const noexcept {
    for (int b = 0; b < body_count; ++b) Store(bodies[b].free, v + 6 * b);
    pools.ForEach([&](auto& law, auto&, int row, int) {
      for (int i = 0; i < law.link_count; ++i) {
        Num* const at = v + 6 * law.links[i].body;
        Twist<Num> t = Load(at);
        Push(law.links[i], l + row, t.v, t.w);
        Store(t, at);
      }
    });
  }
  /// Computes constraint velocities: u <- J v.
  void Measure(const Num* v, Num* u) const noexcept {
    for (int i = 0; i < rows; ++i) u[i] = Num::Splat(0.0);
    pools.ForEach([&](auto& law, auto&, int row, int) {
      for (int i = 0; i < law.link_count; ++i) {
        const Twist<Num> t = Load(v + 6 * law.links[i].body);
        AddVelocity(law.links[i], t.v, t.w, u + row);
      }
    });
  }
  /// Adds the impulses of a law: f += J^T l, except for prescribed unknowns.
  template <class Law>
  TAUT_INLINE void AddForce(const Law& law, const Num* l, Num* f) const noexcept {
    for (int i = 0; i < law.link_count; ++i) {
      if (law.links[i].body < pattern.count) AddForce(law.links[i], l, f);
    }
  }
  template <int R>
  TAUT_INLINE static void AddForce(const Link<Num, R>& link, const Num* l, Num* f) noexcept {
    Num* const at = f + 6 * link.body;
    for (int r = 0; r < R; ++r) {
      const V3<Num>&d = link.lin[r], &a = link.ang[r];
      at[0] += l[r] * d.x, at[1] += l[r] * d.y, at[2] += l[r] * d.z;
      at[3] += l[r] * a.x, at[4] += l[r] * a.y, at[5] += l[r] * a.z;
    }
  }
  TAUT_INLINE static void AddForce(const RowLink<Num>& link, const Num* l, Num* f) noexcept {
    AddForce(static_cast<const Link<Num, 1>&>(link), l + link.row, f);
  }
  /// Updates the branches of all constraints and returns the largest residual [m/s].
  Num Residual(const Num* u, const Num* l) const noexcept {
    Num worst = Num::Splat(0.0);
    pools.ForEach([&](auto& law, auto& branch, int row, int) {
      branch = law.BranchOf(u + row, l + row);
      worst = Max(law.Residual(branch, u + row, l + row), worst);
    });
    return worst;
  }
  /// Continues from the impulses `from`, clamped to admissible values. Returns their residual
  /// [m/s].
  double Return(const Num* from) noexcept {
    for (int i = 0; i < rows; ++i) m.l[i] = from[i];
    Clamp(m.l);
    return Judge();
  }
  /// Computes the velocities under the impulses m.l. Returns the residual [m/s].
  double Judge() noexcept {
    VelocitiesOf(m.l, m.v);
    Measure(m.v, m.u);
    return Residual(m.u, m.l)[0];
  }
  void Clamp(Num* l) const noexcept {
    pools.ForEach([&](auto& law, auto&, int row, int) { law.Clamp(l + row); });
  }

  TAUT_INLINE static Twist<Num> Load(const Num* x) noexcept {
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  }
  TAUT_INLINE static void Store(const Twist<Num>& t, Num* x) noexcept {
    x[0] = t.v.x, x[1] = t.v.y, x[2] = t.v.z, x[3] = t.w.x, x[4] = t.w.y, x[5] = t.w.z;
  }
  /// Multiplies by the mass matrix: out <- M x.
  TAUT_INLINE static void TimesMass(const Unknown<Num>& body, const Num* x, Num* out) noexcept {
    const V3<Num> w = body.inertia * V3<Num>{x[3], x[4], x[5]};
    out[0] = body.mass * x[0], out[1] = body.mass * x[1], out[2] = body.mass * x[2];
    out[3] = w.x, out[4] = w.y, out[5] = w.z;
  }
};

}  // namespace taut::sim
