/// A step allocates nothing. This program replaces the allocation functions with ones that count.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "tests/determinism/variety.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TAUT_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TAUT_SANITIZED
#endif
#endif

namespace {
std::atomic<long> allocations{0};  ///< By all threads, of all kinds.
}

#ifndef TAUT_SANITIZED
// glibc's own entry points; the C++ operators below and everything else come through these.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* p, std::size_t size) {
  ++allocations;
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace taut::test {
namespace {

class Allocation : public testing::Test {
 protected:
  void SetUp() override {
#ifdef TAUT_SANITIZED
    GTEST_SKIP() << "this build's sanitizers have allocation functions of their own";
#endif
  }
};

TEST_F(Allocation, IsCounted) {
  const long before = allocations;
  const std::vector<double> some(100, 1.0);
  EXPECT_EQ(allocations - before, 1);
  EXPECT_EQ(some[99], 1.0);
}

TEST_F(Allocation, AStepMakesNoneWhateverHappens) {
  for (const ModelDef& def : VariedModels()) {
    for (const int threads : {1, 2}) {
      BatchOptions options;
      options.worlds = 11;
      options.threads = threads;
      Batch batch = MakeBatch(def, options);
      for (int i = 0; i < 11; ++i) Scatter(batch, i, i);
      const long before = allocations;
      for (int stretch = 0; stretch < kStretches; ++stretch) {
        for (int i = 0; i < 11; ++i) Disturb(batch, i, i, stretch);
        batch.Step(kVarietyStepS, kStepsAStretch);
        batch.Step(2 * kVarietyStepS);
        double sum = 0;
        for (int i = 0; i < 11; ++i) {
          sum += batch.Body(i, 0).position_m.z + batch.TotalEnergy(i).kinetic_j +
                 batch.NodePosition(i, 0).x + batch.Status(i).residual_m_per_s;
          if (!def.cables.empty()) sum += batch.Cable(i, 0).tension_n;
          batch.Hash(i);
        }
        ASSERT_EQ(sum, sum);
      }
      EXPECT_EQ(allocations, before) << def.name << ", " << threads << " threads";
    }
  }
}

TEST_F(Allocation, RestoringMakesNone) {
  Batch batch = MakeBatch(scenes::Jumble().Def());
  batch.Step(1e-3, 300);
  const std::vector<std::uint8_t> snapshot = batch.Save(0);
  Batch other = MakeBatch(scenes::Jumble().Def());
  const long before = allocations;
  EXPECT_TRUE(other.Restore(0, snapshot));
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace taut::test
