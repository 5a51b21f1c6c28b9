/// Robots at rest with fixed rest lengths: no creep, and no vibration from prestress.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/standing.h"

namespace taut::test {
namespace {

TEST(Standing, ARobotWithFixedRestLengthsDoesNotCreep) {
  for (const char* const robot : kRobots) StandsStill(robot, 0, 60);
}

TEST(Standing, ARobotWithFixedRestLengthsDoesNotCreepDownASlopeOfTenDegrees) {
  for (const char* const robot : kRobots) StandsStill(robot, 10, 60);
}

TEST(Standing, APrestressedSixStrutAtRestDoesNotVibrate) {
  // Free, without gravity or dampers, in equilibrium. Rounding a length of 1 m by eps does a work
  // of T eps at a tension T, in each of 24 cables: kinetic energy above that would come from the
  // scheme. The robot is rotated, so that nothing cancels by symmetry.
  for (const double stiffness : {1e3, 1e5, 1e6, 1e7, 1e8}) {  // the last ones are implicit
    scenes::SixStrut scene;
    scene.stiffness_n_per_m = stiffness;
    scene.orientation = scenes::Turn({0.6, 0.48, 0.64}, 1.1);
    ModelDef def = scene.Def();
    ASSERT_EQ(def.cables.size(), 24u);
    def.gravity_m_per_s2 = {0, 0, 0};
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(def);
      double largest = 0;
      for (int n = 0; n < StepsIn(10, h); ++n) {
        world.Step(h);
        largest = std::max(largest, world.TotalEnergy(0).kinetic_j);
      }
      EXPECT_LE(largest, RoundOff(24, scene.tension_n * scene.length_m)) << stiffness << ' ' << h;
      EXPECT_EQ(world.Status(0).bits, kStatusOk) << stiffness << ' ' << h;
    }
  }
}

}  // namespace
}  // namespace taut::test
