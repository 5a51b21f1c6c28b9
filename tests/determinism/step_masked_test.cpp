// Masked steps: a pause of some worlds changes no bit, neither in these worlds nor in the stepping
// neighbors.
#include <gtest/gtest.h>

#include <algorithm>

#include "taut/world_batch.h"
#include "tests/determinism/variety.h"
#include "tests/scenes/heap.h"
#include "tests/scenes/jumble.h"

namespace taut::test {
namespace {

/// Steps random subsets of worlds and checks that each world equals a single world after the same
/// number of steps.
void ExpectWorldsOfTheirOwn(const ModelDef& def, int steps) {
  Diagnostics out;
  const auto model = Model::Compile(def, out);
  ASSERT_TRUE(model) << out.Format();
  constexpr int kWorlds = 11;  // a full group and part of another
  WorldBatch together(model, {.worlds = kWorlds, .threads = 2, .simd = BestSimd()});
  const auto start = [&](WorldBatch& batch, int world, int as) {
    BodyState body = batch.Body(world, 0);
    body.velocity_m_per_s.x += 0.05 * as;
    batch.SetBodyState(world, 0, body);
  };
  for (int world = 0; world < kWorlds; ++world) start(together, world, world);
  std::vector<int> done(kWorlds);
  std::vector<std::size_t> contacts(kWorlds);
  std::uint64_t random = 1;
  std::vector<std::uint8_t> goes(kWorlds);
  for (int i = 0; i < steps; ++i) {
    for (int world = 0; world < kWorlds; ++world) {
      random = random * 6364136223846793005u + 1442695040888963407u;
      const bool go = (random >> 40) % 4 != 0;
      goes[static_cast<std::size_t>(world)] = go;
      done[static_cast<std::size_t>(world)] += go;
    }
    const int still = static_cast<int>(std::find(goes.begin(), goes.end(), 0) - goes.begin());
    const std::uint64_t before = still < kWorlds ? together.Hash(still) : 0;
    together.StepMasked(1e-3, goes);
    if (still < kWorlds) {
      ASSERT_EQ(together.Hash(still), before) << "step " << i;
    }
  }
  std::size_t touching = 0;
  for (int world = 0; world < kWorlds; ++world) {
    WorldBatch alone(model, {});
    start(alone, 0, world);
    alone.Step(1e-3, done[static_cast<std::size_t>(world)]);
    EXPECT_EQ(together.Hash(world), alone.Hash(0)) << "world " << world;
    EXPECT_EQ(together.Contacts(world).size(), alone.Contacts(0).size());
    EXPECT_EQ(together.Status(world).bits, alone.Status(0).bits);
    touching += alone.Contacts(0).size();
  }
  EXPECT_GT(touching, 0u);
}

TEST(StepMasked, WorldsOfAHeapComeAndGo) {
  ExpectWorldsOfTheirOwn(scenes::RodHeap{.rods = 6, .first_m = 0.1}.Def(), 600);
}
TEST(StepMasked, WorldsOfAJumbleComeAndGo) { ExpectWorldsOfTheirOwn(scenes::Jumble().Def(), 900); }

TEST(StepMasked, WorldsWithMotorsComeAndGo) { ExpectWorldsOfTheirOwn(MotorizedSpine(), 400); }

TEST(StepMasked, NeitherNobodyNorEverybodyIsSpecial) {
  Diagnostics out;
  const auto model = Model::Compile(scenes::Jumble().Def(), out);
  WorldBatchOptions three;
  three.worlds = 3;
  WorldBatch some(model, three), all(model, three);
  const std::vector<std::uint8_t> nobody(3, 0), everybody(3, 1);
  for (int i = 0; i < 100; ++i) {
    some.StepMasked(1e-3, everybody);
    some.StepMasked(1e-3, nobody);
  }
  all.Step(1e-3, 100);
  EXPECT_EQ(some.Hash(1), all.Hash(1));
}

TEST(StepMasked, AWorldThatWouldFailDoesNotFailWhileItStands) {
  Diagnostics out;
  const auto model = Model::Compile(scenes::Jumble().Def(), out);
  WorldBatchOptions three;
  three.worlds = 3;
  WorldBatch batch(model, three);
  BodyState body = batch.Body(1, 0);
  body.velocity_m_per_s.x = 1e308;
  body.position_m.x = 1.7e308;
  batch.SetBodyState(1, 0, body);
  for (int i = 0; i < 3; ++i) batch.StepMasked(1e-3, std::vector<std::uint8_t>{1, 0, 1});
  EXPECT_EQ(batch.Status(1).bits, 0u);
  EXPECT_EQ(batch.Status(0).bits, 0u);
  for (int i = 0; i < 3; ++i) batch.StepMasked(1e-3, std::vector<std::uint8_t>{1, 1, 1});
  EXPECT_NE(batch.Status(1).bits & kStatusNonFinite, 0u);
}

}  // namespace
}  // namespace taut::test
