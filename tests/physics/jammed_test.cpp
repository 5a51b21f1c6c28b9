// Bodies that jam each other by friction, with a stiff cable between them.
#include <gtest/gtest.h>

#include "tests/determinism/variety.h"

namespace taut::test {
namespace {

TEST(Jammed, ABallThatWedgesInASledTakesBoundedWorkAndComesFree) {
  // With this start, a ball on a stiff cable is shot between two runners of the sled and jams
  // there. Then any squeeze force satisfies the contact laws.
  WorldBatch world = MakeBatch(scenes::Jumble().Def());
  Scatter(world, 0, 8);
  double energy_j = EnergyOf(world);
  for (int i = 0; i < 200; ++i) {
    world.Step(1e-3);
    const WorldStatus status = world.Status(0);
    // Implicit integration, its fallback, and position projection.
    EXPECT_LE(status.linear_solves, 3 * WorldBatchOptions().max_linear_solves) << i;
    EXPECT_EQ(status.bits & ~kStatusNotConverged, 0u) << i;
    EXPECT_LE(EnergyOf(world), energy_j + 1e-2) << i;
    energy_j = EnergyOf(world);
    if (i >= 100) {
      EXPECT_EQ(status.bits, kStatusOk) << i;
    }
    world.ClearStatus(0);
  }
}

}  // namespace
}  // namespace taut::test
