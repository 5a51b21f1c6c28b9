/// Dense linear solver without blocks, order or symmetry, as a reference for sparse solvers.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

namespace taut::test {

using Dense = std::vector<std::vector<double>>;

/// Returns x with A x = b; Gaussian elimination with pivoting.
inline std::vector<double> DenseSolve(Dense a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t i = k; i < n; ++i) best = std::abs(a[i][k]) > std::abs(a[best][k]) ? i : best;
    std::swap(a[k], a[best]), std::swap(b[k], b[best]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double f = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

inline Dense Transposed(const Dense& a) {
  Dense out = a;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) out[i][j] = a[j][i];
  }
  return out;
}

}  // namespace taut::test
