// Matrix decompositions, worlds and logs of studies whose n-th allocation fails. This program
// replaces malloc, which Eigen calls directly.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <string>

#include "analysis/force_balance.h"
#include "analysis/svd.h"
#include "learn/study_log.h"
#include "taut/world_batch.h"
#include "unit/analysis/analysis_scenes.h"

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

/// Calls `work` with the n-th allocation failing. Returns false if it reported missing memory.
template <class Work>
bool Succeeds(int n, const Work& work) {
  allocations_until_failure = n;
  try {
    work();
    allocations_until_failure = 0;
    return true;
  } catch (const std::bad_alloc&) {
    allocations_until_failure = 0;
    return false;
  }
}

/// Lets each allocation of `work` fail in turn. Returns their number.
template <class Work>
int Failures(const Work& work) {
  int failures = 0;
  while (failures < 20'000 && !Succeeds(failures + 1, work)) ++failures;
  return failures;
}

TEST(SvdMemory, EveryAllocationThatFailsIsAnException) {
  for (const auto& [rows, columns] : {std::pair(12, 5), {5, 12}, {7, 7}}) {
    const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(rows, columns);
    const int failures =
        Failures([&] { Svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV).singularValues(); });
    // The parts of the result and of the preconditioner are separate allocations.
    EXPECT_GE(failures, rows == columns ? 4 : 10) << rows << " x " << columns;
    EXPECT_LT(failures, 100);
  }
}

// Eigen's divide-and-conquer method frees memory twice if it lacks memory for 16 columns or more.
TEST(ForceBalanceMemory, EveryAllocationThatFailsIsAnException) {
  ForceBalance balance({}, {}, {}, false);
  for (const auto& [rows, columns] : {std::pair(12, 5), {36, 24}, {24, 36}, {40, 40}}) {
    const Eigen::MatrixXd part = Eigen::MatrixXd::Random(rows, 4);
    balance.columns = part * Eigen::MatrixXd::Random(4, columns);
    balance.load = part.col(0);
    Eigen::Index free = 0;
    const int failures = Failures([&] { free = balance.Solve().free.cols(); });
    EXPECT_EQ(free, columns - 4);
    EXPECT_GE(failures, 10) << rows << " x " << columns;
    EXPECT_LT(failures, 100);
  }
}

TEST(BatchMemory, EveryAllocationThatFailsIsAnException) {
  Diagnostics out;
  const ModelDef rope = test::Rope(1, 100, 0.9);
  const std::shared_ptr<const Model> model = Model::Compile(rope, out);
  ASSERT_TRUE(model) << out.Format();
  double tension_n = 0;
  const int failures = Failures([&] {
    WorldBatch batch(model, {});
    tension_n = batch.Cable(0, 0).tension_n;
  });
  EXPECT_NEAR(tension_n, 10, 1e-9);
  EXPECT_GE(failures, 5);  // rows have other allocations than malloc
  EXPECT_LT(failures, 200);
}

// A log that lacks memory is not mistaken for another program's database.
TEST(StudyLogMemory, EveryAllocationThatFailsIsAnExceptionOrSaid) {
  const std::string path = testing::TempDir() + "missing_memory_" + std::to_string(getpid());
  Diagnostics made;
  const std::unique_ptr<learn::Log> opened = learn::Log::Open(path, made);
  ASSERT_TRUE(opened && opened->Begin({}, made)) << made.Format();
  std::string errors;
  int failures = 0;
  for (bool failed = true; failed && failures < 20'000; ++failures) {
    Succeeds(failures + 1, [&] {
      Diagnostics out;
      const std::unique_ptr<learn::Log> log = learn::Log::OpenToRead(path, out);
      if (log == nullptr || !log->Read(out)) errors += out.Format();
      failed = allocations_until_failure == 0;  // SQLite does without some
    });
  }
  std::filesystem::remove(path);
  EXPECT_GE(failures, 500);
  EXPECT_LT(failures, 20'000);
  EXPECT_EQ(errors.find("other tables"), std::string::npos) << errors;
}

}  // namespace
}  // namespace taut::analysis
