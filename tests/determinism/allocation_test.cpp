/// Test that a step allocates no memory.

#include <gtest/gtest.h>

#include "tests/determinism/count_allocations.h"
#include "tests/determinism/variety.h"

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
      WorldBatchOptions options;
      options.worlds = 11;
      options.threads = threads;
      WorldBatch batch = MakeBatch(def, options);
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
  WorldBatch batch = MakeBatch(scenes::Jumble().Def());
  batch.Step(1e-3, 300);
  const std::vector<std::uint8_t> snapshot = batch.Save(0);
  WorldBatch other = MakeBatch(scenes::Jumble().Def());
  const long before = allocations;
  EXPECT_TRUE(other.Restore(0, snapshot));
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace taut::test
