// Bitwise reproducibility of worlds with many contacts and stiff cables in SIMD groups. Neighbors
// in a group touch at other places, take other branches of the solver and need other numbers of
// solver steps, yet each world is bit-identical to a single world.
#include <gtest/gtest.h>

#include "tests/physics/world.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/heap.h"
#include "tests/scenes/many_rows.h"
#include "tests/scenes/six_strut.h"
#include "tests/scenes/spine_on_rubble.h"
#include "tests/scenes/stacks.h"

namespace taut::test {
namespace {

constexpr int kCompanyWorlds = 8;
constexpr double kStepS = 1e-3;

/// Adds a different velocity to every body, up to 0.1 m/s in each direction.
void Jolt(WorldBatch& batch, int world, int number) {
  std::uint64_t state = static_cast<std::uint64_t>(number) + 1;
  const auto chance = [&state] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return 0.2 * (static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5);
  };
  for (std::size_t b = 0; b < batch.model().def().bodies.size(); ++b) {
    if (batch.model().def().bodies[b].fixed) continue;
    const int body = static_cast<int>(b);
    BodyState at = batch.Body(world, body);
    at.velocity_m_per_s = {chance(), chance(), chance()};
    batch.SetBodyState(world, body, at);
  }
}

void ExpectTheSameInAnyCompany(const ModelDef& def, int steps) {
  WorldBatchOptions wide;
  wide.worlds = kCompanyWorlds;
  WorldBatch together = MakeBatch(def, wide);
  wide.simd = Simd::kAvx2;  // falls back to an available instruction set
  wide.threads = 2;
  WorldBatch reversed = MakeBatch(def, wide);
  for (int i = 0; i < kCompanyWorlds; ++i) {
    Jolt(together, i, i);
    Jolt(reversed, i, kCompanyWorlds - 1 - i);
  }
  together.Step(kStepS, steps);
  reversed.Step(kStepS, steps);
  for (int i = 0; i < kCompanyWorlds; ++i) {
    WorldBatch alone = MakeBatch(def, {});
    Jolt(alone, 0, i);
    alone.Step(kStepS, steps);
    EXPECT_EQ(together.Hash(i), alone.Hash(0)) << i;
    EXPECT_EQ(reversed.Hash(kCompanyWorlds - 1 - i), alone.Hash(0)) << i;
  }
}

TEST(Company, AHeapOfRods) {
  scenes::RodHeap heap;
  heap.rods = 8;
  ExpectTheSameInAnyCompany(heap.Def(), 400);
}
TEST(Company, AStackOfBoxes) {
  scenes::BoxStack stack;
  stack.boxes = 4;
  ExpectTheSameInAnyCompany(stack.Def(), 300);
}
TEST(Company, ASlabOnRods) { ExpectTheSameInAnyCompany(scenes::SlabOnRods().Def(), 200); }
TEST(Company, ADiscOnManyFeet) {
  scenes::FootedDisc disc;
  disc.feet = 16;
  ExpectTheSameInAnyCompany(disc.Def(), 300);
}
TEST(Company, ABallInANetOfStiffCables) {
  ExpectTheSameInAnyCompany(scenes::BallInNet().Def(), 200);
}
TEST(Company, ASpineOnRubble) { ExpectTheSameInAnyCompany(scenes::SpineOnRubble().Def(), 300); }
TEST(Company, RodsOnDifferentPartsOfAFieldOfManyBoxes) {
  // Each world has the rods at another place of the field, and one world next to it.
  scenes::Chance chance(4);
  scenes::RodHeap heap;
  heap.rods = 5;
  ModelDef def = heap.Def();
  def.planes.clear();
  def.terrain_boxes.clear();
  for (int i = 0; i < 200; ++i) {
    const Vec3 at{chance.Within(-3, 3), chance.Within(-3, 3), chance.Within(-0.1, 0)};
    def.terrain_boxes.push_back({"stone",
                                 at,
                                 scenes::Turn(chance.Direction(), 0.5),
                                 {chance.Within(0.05, 0.3), 0.2, 0.05},
                                 {0.5, 0.5, 0}});
  }
  const auto start = [](WorldBatch& batch, int world, int number) {
    for (int b = 0; b < static_cast<int>(batch.model().def().bodies.size()); ++b) {
      BodyState at = batch.Body(world, b);
      at.position_m.x += number - 3.0;
      at.position_m.y += 0.7 * number - 2;
      batch.SetBodyState(world, b, at);
    }
    Jolt(batch, world, number);
  };
  WorldBatchOptions wide;
  wide.worlds = kCompanyWorlds;
  WorldBatch together = MakeBatch(def, wide);
  for (int i = 0; i < kCompanyWorlds; ++i) start(together, i, i);
  together.Step(kStepS, 800);
  for (int i = 0; i < kCompanyWorlds; ++i) {
    WorldBatch alone = MakeBatch(def, {});
    start(alone, 0, i);
    alone.Step(kStepS, 800);
    EXPECT_EQ(together.Hash(i), alone.Hash(0)) << i;
  }
}
TEST(Company, SixStrutsWithStrongDampersOnTheGround) {
  scenes::SixStrut robot;
  robot.damping_n_s_per_m = 200;
  robot.center_m = {0, 0, 0.6};
  ModelDef def = robot.Def();
  def.planes.emplace_back().name = "ground";
  ExpectTheSameInAnyCompany(def, 400);
}

}  // namespace
}  // namespace taut::test
