// Singular value decompositions whose n-th allocation fails. This program replaces malloc, which
// Eigen calls directly.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "analysis/svd.h"

namespace {
int allocations_until_failure = 0;  ///< 0: none fails.
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);  // NOLINT(clang-diagnostic-reserved-identifier): glibc's name
void* malloc(std::size_t size) {
  if (allocations_until_failure > 0 && --allocations_until_failure == 0) return nullptr;
  return __libc_malloc(size);
}
}

namespace taut::analysis {
namespace {

/// Decomposes with the n-th allocation failing. Returns false if it reported missing memory.
bool Decomposes(const Eigen::MatrixXd& matrix, int n) {
  allocations_until_failure = n;
  try {
    const Svd svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    allocations_until_failure = 0;
    return svd.singularValues().size() > 0;
  } catch (const std::bad_alloc&) {
    allocations_until_failure = 0;
    return false;
  }
}

TEST(SvdMemory, EveryAllocationThatFailsIsAnException) {
  for (const auto& [rows, columns] : {std::pair(12, 5), {5, 12}, {7, 7}}) {
    const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(rows, columns);
    int failures = 0;
    while (!Decomposes(matrix, failures + 1)) ++failures;
    // The parts of the result and of the preconditioner are separate allocations.
    EXPECT_GE(failures, rows == columns ? 4 : 10) << rows << " x " << columns;
    EXPECT_LT(failures, 100);
  }
}

}  // namespace
}  // namespace taut::analysis
