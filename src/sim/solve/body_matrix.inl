/// Sparse linear system of Newton's method in the velocities of bodies (docs/theory/contact.md, eq.
/// 21, 25). The matrix has a 6x6 block for each pair of interacting bodies and is factored in the
/// order of the bodies, without pivoting. M + J^T G J is positive definite except for the coupling
/// of friction to the normal impulse. Line search or residual reject a step that a bad pivot
/// spoils.
///
/// Blocks of smaller unknowns are padded with zeros. Only the velocities of an unknown are
/// eliminated; couplings are always 6x6, so that loops have fixed lengths. Prescribed unknowns have
/// no column.
#pragma once

#include "base/assert.h"
#include "math/scalar.h"
#include "sim/constraint/links.h"
#include "sim/data/elimination.h"
#include "sim/data/island.h"
#include "simd/vec3.h"

namespace taut::sim {

template <class Num>
class BodyMatrix {
  static constexpr int kBlock = kDofs * kDofs;

 public:
  BodyMatrix(const BlockPattern& pattern, Num* blocks) noexcept : p_(pattern), a_(blocks) {}

  /// Sets the diagonal to M and all other entries to 0. `symmetric`: stores only the lower
  /// triangle. `bodies` must stay valid until the last solve.
  void Start(const Unknown<Num>* bodies, bool symmetric) noexcept {
    Clear(bodies, symmetric);
    for (int b = 0; b < p_.count; ++b) {
      Num* const d = At(b, b);
      const auto& body = bodies[b];
      bodies_only_ = bodies_only_ && body.size == kDofs;
      for (int i = 0; i < 3; ++i) d[7 * i] = body.mass;
      d[21] = body.inertia.xx, d[28] = body.inertia.yy, d[35] = body.inertia.zz;
      d[27] = d[22] = body.inertia.xy;
      d[33] = d[23] = body.inertia.xz;
      d[34] = d[29] = body.inertia.yz;
    }
  }

  /// Sets all entries to 0, for bodies without links.
  void Clear(const Unknown<Num>* bodies, bool symmetric) noexcept {
    symmetric_ = symmetric, bodies_only_ = true;
    bodies_ = bodies;
    const Num zero = Num::Splat(0.0);
    const int used = symmetric ? p_.lower_count : p_.block_count;
    for (int i = 0; i < kBlock * used; ++i) a_[i] = zero;
  }
  /// Adds a block from its four 3x3 parts for velocities and angular velocities.
  TAUT_INLINE void AddBlock(int i, int j, const simd::M3<Num>& vv, const simd::M3<Num>& vw,
                            const simd::M3<Num>& wv, const simd::M3<Num>& ww) noexcept {
    Combine(At(i, j), vv, vw, wv, ww, [](Num& to, const Num& x) { to += x; });
  }

  /// Adds a block for angular velocities only.
  TAUT_INLINE void AddSpins(int i, int j, const simd::M3<Num>& ww) noexcept {
    Num* const to = At(i, j) + 21;
    const auto add = [](Num* at, const V3<Num>& b) { at[0] += b.x, at[1] += b.y, at[2] += b.z; };
    add(to, ww.r0), add(to + 6, ww.r1), add(to + 12, ww.r2);
  }
  /// Subtracts a block from its four parts.
  TAUT_INLINE void SubtractBlock(int i, int j, const simd::M3<Num>& vv, const simd::M3<Num>& vw,
                                 const simd::M3<Num>& wv, const simd::M3<Num>& ww) noexcept {
    Combine(At(i, j), vv, vw, wv, ww, [](Num& to, const Num& x) { to -= x; });
  }

  /// Adds J^T G J of a constraint, without prescribed unknowns. G: R x R, row by row. Not inlined:
  /// inlined, g++ needs up to a fifth more instructions for the same loops.
  template <class Law>
  [[gnu::noinline]] void Add(const Law& law, const Num* G) noexcept {
    constexpr int R = Law::kRows;
    if constexpr (requires { law.links[0].row; }) return AddByRows(law, G);
    for (int k = 0; k < law.link_count; ++k) {
      if (law.links[k].body >= p_.count) continue;
      Num j[R][kDofs], gj[R][kDofs];
      Unpack(law.links[k], j);
      for (int r = 0; r < R; ++r) {
        for (int c = 0; c < kDofs; ++c) {
          Num sum = G[R * r] * j[0][c];
          for (int q = 1; q < R; ++q) sum += G[R * r + q] * j[q][c];
          gj[r][c] = sum;
        }
      }
      for (int i = 0; i < law.link_count; ++i) {
        const int row = law.links[i].body, column = law.links[k].body;
        if (row >= p_.count || (symmetric_ && row < column)) continue;
        Num* const block = At(row, column);
        Num ji[R][kDofs];
        Unpack(law.links[i], ji);
        for (int r = 0; r < R; ++r) {
          for (int x = 0; x < kDofs; ++x) {
            const Num f = ji[r][x];
            Num* const line = block + kDofs * x;
            for (int y = 0; y < kDofs; ++y) line[y] += f * gj[r][y];
          }
        }
      }
    }
  }

  /// Adds J^T G J of `count` constraints with one row each on the same bodies. g: one number per
  /// constraint. Each block is loaded and stored only once.
  template <class Law>
  [[gnu::noinline]] void AddTogether(const Law* laws, int count, const Num* g) noexcept {
    static_assert(Law::kRows == 1);
    for (int k = 0; k < laws->link_count; ++k) {
      const int column = laws->links[k].body;
      if (column >= p_.count) continue;
      for (int i = 0; i < laws->link_count; ++i) {
        const int row = laws->links[i].body;
        if (row >= p_.count || (symmetric_ && row < column)) continue;
        Num* const block = At(row, column);
        for (int x = 0; x < kDofs; ++x) {
          Num line[kDofs];
          for (int y = 0; y < kDofs; ++y) line[y] = block[kDofs * x + y];
          for (int r = 0; r < count; ++r) {
            Num ji[1][kDofs], jk[1][kDofs];
            Unpack(laws[r].links[i], ji);
            Unpack(laws[r].links[k], jk);
            const Num f = g[r] * ji[0][x];
            for (int y = 0; y < kDofs; ++y) line[y] += f * jk[0][y];
          }
          for (int y = 0; y < kDofs; ++y) block[kDofs * x + y] = line[y];
        }
      }
    }
  }

  /// Factors A = L D L^T or L U. Returns false if a pivot is not positive (L D L^T) or zero (L U).
  bool Factor() noexcept {
    if (bodies_only_) return symmetric_ ? FactorSymmetric<true>() : FactorGeneral<true>();
    return symmetric_ ? FactorSymmetric<false>() : FactorGeneral<false>();
  }

  /// Solves in place: x <- A^-1 x, 6 numbers per unknown. Entries beyond the size of an unknown do
  /// not change.
  void Solve(Num* x) const noexcept { bodies_only_ ? SolveAs<true>(x) : SolveAs<false>(x); }

  /// Solves the transposed system in place: x <- A^-T x.
  void SolveTransposed(Num* x) const noexcept {
    if (symmetric_) return Solve(x);
    Rising<ForwardTransposedU, false>(x);
    Falling<BackwardTransposedL<false>, false>(x);
  }

 private:
  /// Calls op(entry, number) for all entries of a block, with numbers from its four 3x3 parts.
  template <class Op>
  TAUT_INLINE static void Combine(Num* to, const simd::M3<Num>& vv, const simd::M3<Num>& vw,
                                  const simd::M3<Num>& wv, const simd::M3<Num>& ww,
                                  const Op& op) noexcept {
    const auto row = [&](Num* at, const V3<Num>& a, const V3<Num>& b) {
      op(at[0], a.x), op(at[1], a.y), op(at[2], a.z), op(at[3], b.x), op(at[4], b.y),
          op(at[5], b.z);
    };
    row(to, vv.r0, vw.r0), row(to + 6, vv.r1, vw.r1), row(to + 12, vv.r2, vw.r2);
    row(to + 18, wv.r0, ww.r0), row(to + 24, wv.r1, ww.r1), row(to + 30, wv.r2, ww.r2);
  }
  /// Adds J^T G J of a constraint with one row per link.
  template <class Law>
  void AddByRows(const Law& law, const Num* G) noexcept {
    for (int k = 0; k < law.link_count; ++k) {
      const int column = law.links[k].body;
      if (column >= p_.count) continue;
      Num jk[1][kDofs];
      Unpack(law.links[k], jk);
      for (int i = 0; i < law.link_count; ++i) {
        const int row = law.links[i].body;
        const Num g = G[law.rows * law.links[i].row + law.links[k].row];
        if (row >= p_.count || (symmetric_ && row < column) || !Any(!(g == Num::Splat(0.0)))) {
          continue;
        }
        Num* const block = At(row, column);
        Num ji[1][kDofs];
        Unpack(law.links[i], ji);
        for (int x = 0; x < kDofs; ++x) {
          const Num f = ji[0][x] * g;
          for (int y = 0; y < kDofs; ++y) block[kDofs * x + y] += f * jk[0][y];
        }
      }
    }
  }

  template <bool kBodiesOnly>
  TAUT_INLINE void SolveAs(Num* x) const noexcept {
    Rising<ForwardL, kBodiesOnly>(x);
    if (symmetric_) {
      Falling<BackwardTransposedL<true>, kBodiesOnly>(x);
    } else {
      Falling<BackwardU, kBodiesOnly>(x);
    }
  }

  Num* At(int i, int j) const noexcept {
    TAUT_ASSERT(0 <= i && i < p_.count && 0 <= j && j < p_.count);
    const int slot =
        p_.count <= BlockPattern::kMostInTable ? p_.slot[i * p_.count + j] : p_.Find(i, j);
    TAUT_ASSERT(0 <= slot && slot < (symmetric_ ? p_.lower_count : p_.block_count));
    return a_ + kBlock * slot;
  }

  template <int R>
  static void Unpack(const Link<Num, R>& link, Num (*j)[kDofs]) noexcept {
    for (int r = 0; r < R; ++r) {
      j[r][0] = link.lin[r].x, j[r][1] = link.lin[r].y, j[r][2] = link.lin[r].z;
      j[r][3] = link.ang[r].x, j[r][4] = link.ang[r].y, j[r][5] = link.ang[r].z;
    }
  }

  /// Computes a -= l u over the N eliminated velocities.
  template <int N>
  static void Subtract(Num* a, const Num* l, const Num* u) noexcept {
    for (int x = 0; x < kDofs; ++x) {
      Num line[kDofs];
      for (int y = 0; y < kDofs; ++y) line[y] = a[kDofs * x + y];
      for (int m = 0; m < N; ++m) {
        const Num f = l[kDofs * x + m];
        for (int y = 0; y < kDofs; ++y) line[y] -= f * u[kDofs * m + y];
      }
      for (int y = 0; y < kDofs; ++y) a[kDofs * x + y] = line[y];
    }
  }
  /// Computes a -= l u^T over the N eliminated velocities.
  template <int N>
  static void SubtractTransposed(Num* a, const Num* l, const Num* u) noexcept {
    Num transposed[kBlock];
    Transpose<N>(u, transposed);
    Subtract<N>(a, l, transposed);
  }
  /// Transposes the first N columns.
  template <int N>
  static void Transpose(const Num* a, Num* out) noexcept {
    for (int r = 0; r < kDofs; ++r) {
      for (int c = 0; c < N; ++c) out[kDofs * c + r] = a[kDofs * r + c];
    }
  }

  template <bool kBodiesOnly>
  bool FactorSymmetric() noexcept {
    bool good = true;
    for (int k = 0; k < p_.count; ++k) {
      const int size = kBodiesOnly ? kDofs : bodies_[k].size;
      const bool column = size == kDofs ? EliminateSymmetric<kDofs>(k)
                          : size == 3   ? EliminateSymmetric<3>(k)
                                        : EliminateSymmetric<1>(k);
      good = good && column;
    }
    return good;
  }

  template <int N>
  TAUT_INLINE bool EliminateSymmetric(int k) noexcept {
    const Num one = Num::Splat(1.0), zero = Num::Splat(0.0);
    bool good = true;
    Num* const d = At(k, k);
    for (int p = 0; p < N; ++p) {
      good = good && Any(d[7 * p] > zero);
      const Num inverse = one / d[7 * p];
      for (int i = p + 1; i < N; ++i) {
        const Num f = d[6 * i + p] * inverse;
        for (int j = p + 1; j <= i; ++j) d[6 * i + j] -= f * d[6 * j + p];
      }
      for (int i = p + 1; i < N; ++i) d[6 * i + p] *= inverse;
      d[7 * p] = inverse;
    }
    const int first = p_.first_below[k], last = p_.first_below[k + 1];
    // B L^-T = (L D)_ik; the updates need its transpose, and B becomes L_ik.
    for (int q = first; q < last; ++q) {
      Num* const b = At(p_.below[q], k);
      for (int r = 0; r < kDofs; ++r) {
        Num* const line = b + kDofs * r;
        for (int m = 0; m < N; ++m) {
          const Num f = line[m];
          for (int c = m + 1; c < N; ++c) line[c] -= f * d[6 * c + m];
        }
      }
    }
    for (int q = first; q < last; ++q) {
      const int j = p_.below[q];
      Num* const bj = At(j, k);
      Num transposed[kBlock];
      Transpose<N>(bj, transposed);
      for (int r = 0; r < kDofs; ++r) {
        for (int c = 0; c < N; ++c) bj[kDofs * r + c] *= d[7 * c];
      }
      // Column j of the update, rows from j. Later rows still contain (L D).
      Subtract<N>(At(j, j), bj, transposed);
      for (int s = q + 1; s < last; ++s) {
        const int i = p_.below[s];
        SubtractTransposed<N>(At(i, j), At(i, k), bj);
      }
    }
    return good;
  }

  template <bool kBodiesOnly>
  bool FactorGeneral() noexcept {
    bool good = true;
    for (int k = 0; k < p_.count; ++k) {
      const int size = kBodiesOnly ? kDofs : bodies_[k].size;
      const bool column = size == kDofs ? EliminateGeneral<kDofs>(k)
                          : size == 3   ? EliminateGeneral<3>(k)
                                        : EliminateGeneral<1>(k);
      good = good && column;
    }
    return good;
  }

  template <int N>
  TAUT_INLINE bool EliminateGeneral(int k) noexcept {
    const Num one = Num::Splat(1.0);
    bool good = true;
    Num* const d = At(k, k);
    for (int p = 0; p < N; ++p) {
      good = good && Any(Abs(d[7 * p]) > Num::Splat(1e-300));
      const Num inverse = one / d[7 * p];
      d[7 * p] = inverse;
      for (int i = p + 1; i < N; ++i) {
        const Num f = d[6 * i + p] * inverse;
        d[6 * i + p] = f;
        for (int j = p + 1; j < N; ++j) d[6 * i + j] -= f * d[6 * p + j];
      }
    }
    const int first = p_.first_below[k], last = p_.first_below[k + 1];
    for (int q = first; q < last; ++q) {
      Num* const l = At(p_.below[q], k);  // <- l U^-1
      for (int r = 0; r < kDofs; ++r) {
        Num* const line = l + kDofs * r;
        for (int m = 0; m < N; ++m) {
          line[m] *= d[7 * m];
          const Num f = line[m];
          for (int c = m + 1; c < N; ++c) line[c] -= f * d[6 * m + c];
        }
      }
      Num* const u = At(k, p_.below[q]);  // <- L^-1 u
      for (int r = 1; r < N; ++r) {
        for (int m = 0; m < r; ++m) {
          const Num f = d[6 * r + m];
          for (int c = 0; c < kDofs; ++c) u[kDofs * r + c] -= f * u[kDofs * m + c];
        }
      }
    }
    for (int q = first; q < last; ++q) {
      for (int s = first; s < last; ++s) {
        Subtract<N>(At(p_.below[q], p_.below[s]), At(p_.below[q], k), At(k, p_.below[s]));
      }
    }
    return good;
  }

  // Triangular solves, column by column (triangular_solves.inl).
  struct ForwardL;
  template <bool kScaled>
  struct BackwardTransposedL;
  struct BackwardU;
  struct ForwardTransposedU;
  template <class Triangle, bool kBodiesOnly>
  TAUT_INLINE void Column(int k, Num* x) const noexcept {
    const int size = kBodiesOnly ? kDofs : bodies_[k].size;
    if (size == kDofs) {
      Triangle::template Column<kDofs>(*this, k, x);
    } else if (size == 3) {
      Triangle::template Column<3>(*this, k, x);
    } else {
      Triangle::template Column<1>(*this, k, x);
    }
  }
  template <class Triangle, bool kBodiesOnly>
  TAUT_INLINE void Rising(Num* x) const noexcept {
    for (int k = 0; k < p_.count; ++k) Column<Triangle, kBodiesOnly>(k, x);
  }
  template <class Triangle, bool kBodiesOnly>
  TAUT_INLINE void Falling(Num* x) const noexcept {
    for (int k = p_.count - 1; k >= 0; --k) Column<Triangle, kBodiesOnly>(k, x);
  }

  const BlockPattern& p_;
  const Unknown<Num>* bodies_ = nullptr;
  Num* a_;
  bool symmetric_ = true, bodies_only_ = true;
};

}  // namespace taut::sim

#include "sim/solve/triangular_solves.inl"
