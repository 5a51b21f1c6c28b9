/// Contacts of a world of bodies connected by stiff cables, after elimination of the cables: a
/// small system with its own Newton iterations.
#pragma once

#include "sim/constraint/links.h"
#include "sim/solve/world_dual.inl"

namespace taut::sim {

/// Newton's method for the contacts with yielding cables: u = u* + W' dl, u* = u + q. Result: dl in
/// r. Returns the lanes that did not converge.
template <class W, class Contacts>
MaskOf<W> WorldDual<W, Contacts>::SolveContacts(M lanes, W goal) noexcept {
  const W zero = W::Splat(0.0);
  const int first = cables_, size = rows_ - cables_;
  for (int i = first; i < rows_; ++i) {
    mem_.r[i] = zero;
    mem_.q[i] += mem_.u[i];
  }
  M busy = lanes;
  for (int iteration = 0; iteration < kMaxContactIterations; ++iteration) {
    W residual = zero;
    ForEachContact([&](auto& law, int row) {
      W* const l = mem_.now + (row - first);
      for (int r = 0; r < 3; ++r) l[r] = mem_.l[row + r] + mem_.r[row + r];
      residual = Max(law.Residual(law.BranchOf(mem_.q + row, l), mem_.q + row, l), residual);
    });
    busy = busy & !(residual < goal);
    if (!Any(busy)) return busy;
    LinearizeContacts(size);
    EliminateContacts(size);
    for (int i = 0; i < size; ++i) {
      mem_.d[i] = Select(busy, mem_.d[i], zero);
      mem_.r[first + i] += mem_.d[i];
    }
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) mem_.q[first + i] += Left(first + i, first + j) * mem_.d[j];
    }
  }
  return busy;
}

/// Assembles Newton's equations c x = d of the contacts. The solution x replaces d.
template <class W, class Contacts>
void WorldDual<W, Contacts>::LinearizeContacts(int size) noexcept {
  const int first = cables_;
  ForEachContact([&](auto& law, int row) {
    const W* const l = mem_.now + (row - first);
    LinearLaw<W, 3> linear;
    law.Linearize(law.BranchOf(mem_.q + row, l), mem_.q + row, l, W::Splat(kCompliance), linear);
    for (int r = 0; r < 3; ++r) {
      W* const c = mem_.c + (row - first + r) * size;
      for (int j = 0; j < size; ++j) {
        c[j] = linear.S[r][0] * Left(row, first + j);
        for (int k = 1; k < 3; ++k) c[j] += linear.S[r][k] * Left(row + k, first + j);
      }
      for (int k = 0; k < 3; ++k) c[row - first + k] += linear.A[r][k];
      mem_.d[row - first + r] = linear.r[r];
    }
  });
}

/// Solves Newton's equations without pivoting: d <- c^-1 d. Lanes where this fails do not converge.
template <class W, class Contacts>
void WorldDual<W, Contacts>::EliminateContacts(int size) noexcept {
  W* const x = mem_.d;
  for (int k = 0; k < size; ++k) {
    W* const pivot_row = mem_.c + k * size;
    const W inverse = W::Splat(1.0) / pivot_row[k];
    for (int i = k + 1; i < size; ++i) {
      W* const row = mem_.c + i * size;
      const W factor = row[k] * inverse;
      AddMultiple(row + k + 1, pivot_row + k + 1, -factor, size - k - 1);
      x[i] -= factor * x[k];
    }
    pivot_row[k] = inverse;
  }
  for (int k = size - 1; k >= 0; --k) {
    const W* const row = mem_.c + k * size;
    for (int j = k + 1; j < size; ++j) x[k] -= row[j] * x[j];
    x[k] = x[k] * row[k];
  }
}

}  // namespace taut::sim
