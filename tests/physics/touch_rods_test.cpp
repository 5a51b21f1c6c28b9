/// Cable wrapping on several free rods (docs/theory/cables.md, section 6).

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/instruction_sets.h"
#include "tests/physics/touch_scenes.h"

namespace taut::test {
namespace {

/// Moves the rods to different places in each world, so that the cables touch different ones.
void MoveRods(WorldBatch& batch, int world, int rods, int which) {
  for (int rod = 0; rod < rods; ++rod) {
    BodyState state = batch.Body(world, rod);
    state.position_m.z += 0.05 * which * (rod % 2 == 0 ? 1 : -1);
    state.position_m.x += 0.02 * which;
    batch.SetBodyState(world, rod, state);
  }
}

/// One link per rod and lane; a lane's result does not depend on the contacts of others. Builds
/// with assertions check every index.
TEST(TouchRods, StiffCablesOverManyRodsStayInTheirMemoryAndLane) {
  constexpr int kWorlds = 8, kSteps = 80;
  for (const double friction : {0.0, 0.3}) {
    for (const int rods : {2, 5, 20}) {
      ModelDef def = AcrossFreeRods(rods, 1e4);
      def.cables[0].touch_friction = friction;
      std::uint64_t alone[kWorlds];
      for (int world = 0; world < kWorlds; ++world) {
        WorldBatch batch = MakeBatch(def);
        MoveRods(batch, 0, rods, world);
        batch.Step(1e-3, kSteps);
        alone[world] = batch.Hash(0);
      }
      for (const InstructionSet& set : kInstructionSets) {
        WorldBatchOptions options;
        options.worlds = kWorlds;
        options.simd = set.simd;
        WorldBatch batch = MakeBatch(def, options);
        for (int world = 0; world < kWorlds; ++world) MoveRods(batch, world, rods, world);
        batch.Step(1e-3, kSteps);
        int bends = 0;
        for (int world = 0; world < kWorlds; ++world) {
          bends += batch.CableBends(world, 0);
          EXPECT_EQ(batch.Status(world).bits & kStatusNonFinite, 0u);
          EXPECT_EQ(batch.Hash(world), alone[world]) << rods << " " << set.name << " " << world;
        }
        EXPECT_GT(bends, kWorlds) << rods << " " << set.name;
      }
    }
  }
}

/// A cable lowered over an arch of twelve rods: it has at most eight bends, the status reports the
/// overflow, and its length does not exceed the length over all of them.
TEST(TouchRods, MoreRodsThanACableCanLieAgainstAreReported) {
  constexpr int kRods = 12;
  constexpr double kArch = 0.3;
  const Vec3 from{-0.5, 0, 0.4}, to{0.5, 0, 0.4};
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {Ball(1, from), Ball(1, to)};
  def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, 1e-3)};
  def.cables[0].touches = CableTouches::kRods;
  for (int i = 0; i < kRods; ++i) {
    const double angle = std::numbers::pi * (i + 0.5) / kRods;
    AddRod(def, {-kArch * std::cos(angle), 0, kArch * std::sin(angle)}, 0.3, 0.01);
    for (int j = 0; j < i; ++j) def.apart.push_back({2 + j, 2 + i});
  }
  WorldBatch world = MakeBatch(def);
  int most = 0;
  double full = 0;  // drop [m] at which the ninth rod is reached
  for (int i = 1; i <= 200; ++i) {
    const Vec3 down{0, 0, -0.004 * i};
    Lead(world, 0, from + down);
    Lead(world, 1, to + down);
    world.Step(kStep);
    most = std::max(most, world.CableBends(0, 0));
    if ((world.Status(0).bits & kStatusContactOverflow) != 0 && full == 0) {
      full = 0.004 * i;
      EXPECT_EQ(world.Status(0).cable, 0);
    }
  }
  EXPECT_EQ(most, CableDef::kMostBends);
  EXPECT_GT(full, 0.2);
  EXPECT_EQ(world.Status(0).bits, static_cast<std::uint32_t>(kStatusContactOverflow));
  EXPECT_LT(world.Cable(0, 0).length_m, 2 * 0.8 + std::numbers::pi * (kArch + 0.011));
}

/// Two balls that have passed each other, so that their cable forms a loop around the rods: its
/// parts pass a rod outside the loop on different sides without touching it.
TEST(TouchRods, APathInALoopComesToNoRodThatItHasNotMet) {
  for (const double step_s : {1e-3, 2.5e-4}) {
    for (const int rods : {3, 5}) {
      WorldBatch world = MakeBatch(AcrossFreeRods(rods, 1e4));
      const double energy = EnergyOf(world);
      double most = 0, jump = 0, last = world.Cable(0, 0).length_m;
      for (int i = 0; i < StepsIn(0.2, step_s); ++i) {
        world.Step(step_s);
        const CableState cable = world.Cable(0, 0);
        most = std::max(most, EnergyOf(world) - energy);
        jump = std::max(jump, cable.length_m - last);
        last = cable.length_m;
      }
      EXPECT_LT(most, 1e-3 * energy) << step_s << " " << rods;
      EXPECT_LT(jump, 0.06) << step_s << " " << rods;  // 60 m/s at 1 ms
    }
  }
}

}  // namespace
}  // namespace taut::test
