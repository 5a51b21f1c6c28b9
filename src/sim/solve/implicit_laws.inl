/// Contact and joint impulses with implicit cables: the laws of an island on the Delassus operator
/// W = J A^-1 J^T, where A is the matrix of the cables. W is dense and not symmetric
/// (docs/theory/contact.md, eq. 20). Open contacts have no row.
#pragma once

#include "sim/constraint/contact_point.h"
#include "sim/constraint/joint_row.h"
#include "sim/constraint/links.h"
#include "sim/data/elimination.h"
#include "sim/data/implicit_memory.h"
#include "sim/data/island.h"
#include "sim/data/scratch_memory.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/gauss_seidel.inl"
#include "sim/solve/plain_newton.inl"
#include "simd/wide.h"

namespace taut::sim {

// Sets the inverse effective masses of a law from its diagonal block of the Delassus matrix. `w`:
// first element of the block; `stride`: distance between its rows. Natural maps and solutions of
// single laws use these masses. Laws without a block keep the values from the bodies.
template <class Num, int N>
void SetMasses(ContactPoint<Num, N>& c, const Num* w, int stride) noexcept {
  const Num half = Num::Splat(0.5), one = Num::Splat(1.0), least = Num::Splat(1e-300);
  c.wnn = Max(w[0], least), c.w11 = w[stride + 1], c.w22 = w[2 * stride + 2];
  c.w1n = half * (w[1] + w[stride]), c.w2n = half * (w[2] + w[2 * stride]);
  c.w12 = half * (w[stride + 2] + w[2 * stride + 1]);
  c.wt = Max(c.one_direction ? c.w11 : Max(c.w11, c.w22) + Abs(c.w12), least);
  c.inv_wnn = one / c.wnn;
  c.inv_wt = one / c.wt;
}
template <class Num>
void SetMasses(JointRow<Num>& row, const Num* w, int) noexcept {
  row.A = Max(w[0], Num::Splat(1e-300));
}
template <class Law, class Num>
void SetMasses(Law&, const Num*, int) noexcept {}

/// Whether a law is a contact. Open contacts have no row.
template <class Law>
inline constexpr bool kOpens = requires(Law& law) {
  law.mu;
};

template <class W>
class ImplicitLaws {
  using Num = simd::Lane<W>;

 public:
  using Problem = Island<Num, StepPools<Num>>;

  ImplicitLaws(ImplicitMemory<W>& mem, Problem& island, Target target, SolverWork& work) noexcept
      : mem_(mem), island_(island), target_(target), work_(work) {}

  double residual = 0;
  /// Whether bodies are jammed: rounding errors of contact impulses exceed the tolerance.
  bool is_jammed = false;

  /// Starts a stage. Only contacts with impulses have a row.
  void Begin() noexcept {
    is_jammed = false;
    residual = 0;
    for (int i = 0; i < island_.rows; ++i) mem_.active[i] = 0;
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      if constexpr (kOpens<LawOf<decltype(law)>>) {
        mem_.active[row] = Any(island_.m.l[row] > Num::Splat(0.0));
      } else {
        mem_.active[row] = 1;
      }
    });
  }

  /// Solves for the impulses island.m.l. `ends`: velocities without impulses, 6 per body; an
  /// impulse p changes them by ahead A^-1 p. Adds A^-1 J^T l to `step`. Returns false if memory is
  /// too small.
  bool Solve(const BodyMatrix<Num>& matrix, const Num* ends, Num* step) noexcept {
    const Num zero = Num::Splat(0.0);
    auto& m = island_.m;
    island_.Measure(ends, m.u2);
    count_ = 0;
    residual = 0;  // unless a contact closes
    for (int i = 0; i < island_.rows; ++i) mem_.compact[i] = -1;
    for (bool more = true; more;) {
      more = false;
      const int before = count_;
      bool room = true;
      island_.pools.ForEach([&](auto& law, auto&, int row, int) {
        if (mem_.compact[row] >= 0) return;
        if constexpr (kOpens<LawOf<decltype(law)>>) {
          if (!mem_.active[row] && !Any(m.u2[row] + law.bias[0] < zero)) {
            for (int r = 0; r < RowsOf(law); ++r) m.l[row + r] = zero;
            return;
          }
        }
        mem_.active[row] = 1;
        room = room && count_ + RowsOf(law) <= mem_.row_capacity;
        for (int r = 0; room && r < RowsOf(law); ++r) {
          mem_.compact[row + r] = count_++;
        }
      });
      if (!room) return false;
      if (count_ == before) break;
      Respond(matrix, before);
      Iterate();
      // Contacts that close under these impulses also get rows.
      island_.Measure(ends, m.u2);
      for (int b = 0; b < kDofs * island_.body_count; ++b) mem_.ends[b] = zero;
      for (int c = 0; c < count_; ++c) {
        for (int i = 0; i < size(); ++i) {
          mem_.ends[i] += mem_.l[c] * (mem_.body[i / kDofs].ahead * mem_.x[size() * c + i]);
        }
      }
      island_.Measure(mem_.ends, m.du);
      for (int i = 0; i < island_.rows; ++i) m.u2[i] += m.du[i];
      more = true;
    }
    for (int i = 0; i < island_.rows; ++i) m.u[i] = m.u2[i];
    for (int c = 0; c < count_; ++c) {
      for (int i = 0; i < size(); ++i) step[i] += mem_.l[c] * mem_.x[size() * c + i];
    }
    return true;
  }

 private:
  int size() const noexcept { return kDofs * island_.pattern.count; }

  /// Computes the columns of A^-1 J^T from `first`, W, and the effective masses of the laws.
  void Respond(const BodyMatrix<Num>& matrix, int first) noexcept {
    const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
    auto& m = island_.m;
    const int n = size(), stride = mem_.row_capacity;
    for (int i = 0; i < island_.rows; ++i) mem_.unit[i] = zero;
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      for (int r = 0; r < RowsOf(law) && mem_.compact[row] >= first; ++r) {
        Num* const x = mem_.x + n * (mem_.compact[row] + r);
        for (int i = 0; i < n; ++i) x[i] = zero;
        mem_.unit[row + r] = one;
        island_.AddForce(law, mem_.unit + row, x);
        mem_.unit[row + r] = zero;
        matrix.Solve(x);
      }
    });
    for (int i = n; i < kDofs * island_.body_count; ++i) mem_.ends[i] = zero;
    for (int c = 0; c < count_; ++c) {
      for (int i = 0; i < n; ++i) {
        mem_.ends[i] = mem_.body[i / kDofs].ahead * mem_.x[n * c + i];
      }
      island_.pools.ForEach([&](auto& law, auto&, int row, int) {
        const int at = mem_.compact[row];
        if (at < 0) return;
        Num u[LawOf<decltype(law)>::kRows];
        for (int r = 0; r < RowsOf(law); ++r) u[r] = zero;
        for (int i = 0; i < law.link_count; ++i) {
          const Twist<Num> t = island_.Load(mem_.ends + kDofs * law.links[i].body);
          AddVelocity(law.links[i], t.v, t.w, u);
        }
        for (int r = 0; r < RowsOf(law); ++r) mem_.w[stride * (at + r) + c] = u[r];
      });
    }
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      const int at = mem_.compact[row];
      if (at < 0) return;
      SetMasses(law, mem_.w + stride * at + at, stride);
      for (int r = 0; r < RowsOf(law); ++r) {
        mem_.y[at + r] = m.u2[row + r];
        if (at >= first) mem_.l[at + r] = m.l[row + r];
      }
    });
    // Now y contains the velocities without impulses.
    if (first == 0) return;
    for (int a = 0; a < count_; ++a) {
      Num sum = zero;
      for (int c = 0; c < first; ++c) sum += mem_.w[stride * a + c] * mem_.l[c];
      mem_.y[a] -= sum;
    }
  }

  void Velocities() noexcept {
    const int stride = mem_.row_capacity;
    for (int a = 0; a < count_; ++a) {
      Num sum = mem_.y[a];
      for (int c = 0; c < count_; ++c) sum += mem_.w[stride * a + c] * mem_.l[c];
      mem_.u[a] = sum;
    }
  }
  double Residual() noexcept {
    Num worst = Num::Splat(0.0);
    island_.pools.ForEach([&](auto& law, auto& branch, int row, int) {
      const int at = mem_.compact[row];
      if (at < 0) return;
      branch = law.BranchOf(mem_.u + at, mem_.l + at);
      worst = Max(law.Residual(branch, mem_.u + at, mem_.l + at), worst);
    });
    return worst[0];
  }

  void Iterate() noexcept {
    constexpr double kCompliances[] = {1e-9, 1e-9, 1e-5, 1e-9, 1e-3, 1e-9};
    constexpr int kRounds = 6, kSteps = 16, kSweeps = 60;
    Velocities();
    residual = Residual();
    double best = residual;
    Keep(mem_.best, mem_.l);
    for (int round = 0; round < kRounds; ++round) {
      for (int i = 0; i < kSteps && !(residual <= target_.goal()); ++i) {
        ++work_.linear_solves;
        NewtonStep(Num::Splat(kCompliances[round]));
        Velocities();
        const double before = residual;
        residual = Residual();
        if (residual < best) best = residual, Keep(mem_.best, mem_.l);
        if (residual <= target_.tolerance && residual > Target::kPays * before) break;
        if (!(residual - residual == 0)) break;
      }
      if (best <= target_.tolerance || round + 1 == kRounds) break;
      if (work_.linear_solves >= work_.limit) break;
      Keep(mem_.l, mem_.best);
      for (int i = 0; i < kSweeps; ++i) Sweep();
      Velocities();
      residual = Residual();
      if (residual < best) best = residual, Keep(mem_.best, mem_.l);
    }
    Keep(mem_.l, mem_.best);
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      const int at = mem_.compact[row];
      if (at < 0) return;
      law.Clamp(mem_.l + at);
      if constexpr (kOpens<LawOf<decltype(law)>>) {
        constexpr double kRounding = 2.2204460492503131e-16;
        const Num most = Num::Splat(target_.tolerance / kRounding);
        is_jammed = is_jammed || Any(mem_.l[at] * law.wnn > most);
      }
      for (int r = 0; r < RowsOf(law); ++r) island_.m.l[row + r] = mem_.l[at + r];
    });
    residual = best;
  }
  void Keep(Num* to, const Num* from) const noexcept {
    for (int i = 0; i < count_; ++i) to[i] = from[i];
  }

  /// Gauss-Seidel sweep over the active constraints.
  void Sweep() noexcept {
    const int stride = mem_.row_capacity;
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      const int at = mem_.compact[row];
      if (at < 0) return;
      Num u[LawOf<decltype(law)>::kRows];
      for (int r = 0; r < RowsOf(law); ++r) {
        u[r] = mem_.y[at + r];
        for (int c = 0; c < count_; ++c) u[r] += mem_.w[stride * (at + r) + c] * mem_.l[c];
      }
      law.SolveAlone(u, mem_.l + at);
    });
  }

  /// Solves (1 + G W) dl = f and adds dl to the impulses.
  void NewtonStep(Num e) noexcept {
    const Num one = Num::Splat(1.0);
    const int stride = mem_.row_capacity;
    island_.pools.ForEach([&](auto& law, auto& branch, int row, int cell) {
      const int at = mem_.compact[row];
      if (at < 0) return;
      Num* const g = island_.m.g + cell;
      StepOf(law, branch, mem_.u + at, mem_.l + at, e, g, mem_.f + at);
      const int R = RowsOf(law);
      for (int r = 0; r < R; ++r) {
        Num* const line = mem_.k + stride * (at + r);
        for (int c = 0; c < count_; ++c) {
          Num sum = g[R * r] * mem_.w[stride * at + c];
          for (int q = 1; q < R; ++q) sum += g[R * r + q] * mem_.w[stride * (at + q) + c];
          line[c] = sum;
        }
        line[at + r] += one;
      }
    });
    Eliminate();
    for (int i = 0; i < count_; ++i) mem_.l[i] += mem_.f[i];
  }

  /// f <- K^-1 f, with partial pivoting.
  void Eliminate() noexcept {
    const int stride = mem_.row_capacity;
    for (int k = 0; k < count_; ++k) {
      int pivot = k;
      for (int i = k + 1; i < count_; ++i) {
        if (Any(Abs(mem_.k[stride * i + k]) > Abs(mem_.k[stride * pivot + k]))) pivot = i;
      }
      Num *const top = mem_.k + stride * k, *const other = mem_.k + stride * pivot;
      for (int j = k; pivot != k && j < count_; ++j) {
        const Num x = top[j];
        top[j] = other[j], other[j] = x;
      }
      if (pivot != k) {
        const Num x = mem_.f[k];
        mem_.f[k] = mem_.f[pivot], mem_.f[pivot] = x;
      }
      const Num inverse = Num::Splat(1.0) / top[k];
      for (int i = k + 1; i < count_; ++i) {
        Num* const line = mem_.k + stride * i;
        if (!Any(!(line[k] == Num::Splat(0.0)))) continue;
        const Num factor = line[k] * inverse;
        for (int j = k + 1; j < count_; ++j) line[j] -= factor * top[j];
        mem_.f[i] -= factor * mem_.f[k];
      }
    }
    for (int k = count_ - 1; k >= 0; --k) {
      const Num* const line = mem_.k + stride * k;
      for (int j = k + 1; j < count_; ++j) mem_.f[k] -= line[j] * mem_.f[j];
      mem_.f[k] = mem_.f[k] / line[k];
    }
  }

  ImplicitMemory<W>& mem_;
  Problem& island_;
  Target target_;
  SolverWork& work_;
  int count_ = 0;
};

}  // namespace taut::sim
