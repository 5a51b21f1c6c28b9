/// Cables that touch several free rods (docs/theory/cables.md, section 6).

#include <gtest/gtest.h>

#include "tests/instruction_sets.h"
#include "tests/physics/touch_scenes.h"

namespace taut::test {
namespace {

/// One link a rod and lane: each of the worlds touches other rods.
TEST(TouchRods, StiffCablesOverManyRodsStayInTheirMemory) {
  for (const double friction : {0.0, 0.3}) {
    for (const int rods : {2, 5, 20}) {
      ModelDef def = AcrossFreeRods(rods, 1e4);
      def.cables[0].touch_friction = friction;
      for (const InstructionSet& set : kInstructionSets) {
        BatchOptions options;
        options.worlds = 8;
        options.simd = set.simd;
        Batch batch = MakeBatch(def, options);
        for (int world = 0; world < options.worlds; ++world) {
          for (int rod = 0; rod < rods; ++rod) {
            BodyState state = batch.Body(world, rod);
            state.position_m.z += 0.05 * world * (rod % 2 == 0 ? 1 : -1);
            batch.SetBodyState(world, rod, state);
          }
        }
        batch.Step(1e-3, 100);  // builds with assertions look at every index
        int bends = 0;
        for (int world = 0; world < options.worlds; ++world) {
          bends += batch.CableBends(world, 0);
          EXPECT_EQ(batch.Status(world).bits & kStatusNonFinite, 0u);
        }
        EXPECT_GT(bends, options.worlds) << rods << " " << set.name;
      }
    }
  }
}

}  // namespace
}  // namespace taut::test
