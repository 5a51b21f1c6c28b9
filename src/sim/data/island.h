/// A solver's problem: bodies that act on each other through constraints, and the memory that its
/// stages share (docs/theory/contact.md, section 5 and eq. 11).
///
///   v = v_free + M^-1 J^T l,   u = J v,   every constraint's law between its u and its l
///
/// An unknown is what moves by itself: a body, a point mass or a rotor. Those that are solved for
/// are numbered in the order of elimination; behind them come those that are prescribed, whose
/// velocity is given. All constraints of a kind lie in one pool; the rows of all of them are
/// numbered through, pool after pool.
#pragma once

#include "sim/constraint/cable_chain.h"
#include "sim/constraint/links.h"
#include "sim/data/elimination.h"
#include "sim/data/room.h"

namespace taut::sim {

using simd::S3;

/// The most that biases may contradict each other by, to be made to agree [m/s].
inline constexpr double kDisagreementMPerS = 1e-6;

inline constexpr int kDofs = 6;  ///< Velocities of a body: v, w. The most that an unknown has.

/// When a solve is done [m/s]: `tolerance` is what it must reach; it goes on to `goal` as long as
/// that pays, because what every step leaves over adds up.
struct Target {
  static constexpr double kGoal = 0.01, kPays = 0.5;
  double tolerance;
  double goal() const noexcept { return kGoal * tolerance; }
};

/// Work counters and limits of an island's solve.
struct SolverWork {
  int linear_solves = 0, limit = 0;
  double relaxation = 0;  ///< Largest relaxation of inconsistent biases [m/s].
};

/// Whether a residual has hardly moved from one step to the next.
inline bool Stays(double now, double before, double bound) noexcept {
  return now - before < bound && before - now < bound;
}

/// A body of an island, or something smaller. All have room for six velocities (v, w); of those
/// beyond its size, and of links to them, an unknown has zeros.
///
///   size 6: a body
///        3: a point mass: v, mass; no inertia
///        1: a rotor: v.x is its spin, mass its moment of inertia; lin.x of a link its lever
/// Links to one that is prescribed have no inverse mass and no turn: no impulse moves it.
template <class Num>
struct Unknown {
  int body;          ///< Its number in the world.
  int size = kDofs;  ///< 6, 3 or 1 velocities.
  Num mass, inv_mass;
  S3<Num> inertia, inv_inertia;  ///< In W.
  Twist<Num> free;               ///< Its velocities without the island's constraints,
  Twist<Num> before;             ///< and at the start of the step.
};

/// All constraints of one kind, and the branch of its law that each is on.
template <class K>
struct Pool {
  Row<K> items{nullptr, 0};
  Row<typename K::Branch> branches{nullptr, 0};
  int count = 0;
};

template <class... K>
struct Pools : Pool<K>... {
  static_assert((ConstraintLaw<K> && ...));

  /// Calls f(law, branch, first row, first cell of its matrix, rows x rows) for each constraint.
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

/// The law that `const Law&` or `Law&` names.
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

/// What impacts need: velocities before the step, and the solution without rebounds; a row each.
template <class Num>
struct ImpactRows {
  Row<Num> before, u, l;
};

/// The numbers that the stages of an island's solve work on.
template <class Num>
struct IslandMemory {
  Row<Num> v, rhs, direction, trial_v;             ///< 6 an unknown.
  Row<Num> l, u, best, center, projected, du, u2;  ///< 1 a row.
  Row<Num> g, f;                                   ///< rows^2, rows a constraint.
  Row<Num> blocks;                                 ///< 36 a block.
  ImpactRows<Num> impacts;
};

template <class Num, class P>
struct Island {
  Row<Unknown<Num>> bodies;
  int body_count;        ///< With those that are prescribed: from pattern.count on.
  BlockPattern pattern;  ///< Of those that are not.
  P pools;
  IslandMemory<Num> m;
  int rows;
  bool has_matrix;  ///< There is room for linear systems.

  /// v <- v_free + M^-1 J^T l
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
  /// u <- J v
  void Measure(const Num* v, Num* u) const noexcept {
    for (int i = 0; i < rows; ++i) u[i] = Num::Splat(0.0);
    pools.ForEach([&](auto& law, auto&, int row, int) {
      for (int i = 0; i < law.link_count; ++i) {
        const Twist<Num> t = Load(v + 6 * law.links[i].body);
        AddVelocity(law.links[i], t.v, t.w, u + row);
      }
    });
  }
  /// f += J^T l, but for what is prescribed.
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
  /// The largest of all constraints [m/s]; leaves their branches.
  Num Residual(const Num* u, const Num* l) const noexcept {
    Num worst = Num::Splat(0.0);
    pools.ForEach([&](auto& law, auto& branch, int row, int) {
      branch = law.BranchOf(u + row, l + row);
      worst = Max(law.Residual(branch, u + row, l + row), worst);
    });
    return worst;
  }
  /// Goes on from `l`, made admissible. Returns its residual [m/s].
  double Return(const Num* from) noexcept {
    for (int i = 0; i < rows; ++i) m.l[i] = from[i];
    Clamp(m.l);
    return Judge();
  }
  /// Velocities that belong to m.l, and their residual [m/s].
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
  /// M x
  TAUT_INLINE static void TimesMass(const Unknown<Num>& body, const Num* x, Num* out) noexcept {
    const V3<Num> w = body.inertia * V3<Num>{x[3], x[4], x[5]};
    out[0] = body.mass * x[0], out[1] = body.mass * x[1], out[2] = body.mass * x[2];
    out[3] = w.x, out[4] = w.y, out[5] = w.z;
  }
};

}  // namespace taut::sim
