/// Friction of a cable that crosses a turning rod or wheel askew (docs/theory/cables.md, eq. 15a
/// and 22a): energy and losses balance.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/described_path.h"
#include "tests/physics/touch_scenes.h"

namespace taut::test {
namespace {

constexpr double kSpinRadPerS = 20, kSkewM = 1, kRadiusM = 0.25, kBallKg = 10;

/// Returns the friction loss over `time_s`, and checks that energy and loss are constant to
/// `share` of it.
double CheckBalance(const ModelDef& def, double time_s, double share) {
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  double worst = 0;
  for (int i = 0; i < StepsIn(time_s, 1e-4); ++i) {
    world.Step(1e-4);
    worst = std::max(worst, std::fabs(EnergyOf(world) + world.CableFrictionLoss(0, 0) - start));
  }
  const double loss = world.CableFrictionLoss(0, 0);
  EXPECT_LT(worst, share * loss);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  return loss;
}

TEST(SkewCable, OnATurningRodEnergyAndLossBalance) {
  for (const double sense : {-1.0, 1.0}) {
    ModelDef def;
    def.gravity_m_per_s2 = {};
    const Vec3 from{0, -kSkewM, -2}, to{0.5, kSkewM, 2}, velocity{-2, 0, 0};
    def.bodies = {Ball(kBallKg, from, velocity), Ball(kBallKg, to, velocity)};
    AddRod(def, {-0.05, 0, 0}, 1.5, kRadiusM, 2);
    def.bodies[2].angular_velocity_rad_per_s = {0, sense * kSpinRadPerS, 0};
    def.cables = {Cable({0, from}, {1, to}, 2e3, 0.97 * Distance(from, to), 0.001)};
    def.cables[0].touches = CableTouches::kRods;
    def.cables[0].touch_friction = 1.5;
    EXPECT_GT(CheckBalance(def, 1, 2e-3), 1);
  }
}

TEST(SkewCable, OnATurningWheelEnergyAndLossBalance) {
  for (const double sense : {-1.0, 1.0}) {
    ModelDef def;
    def.gravity_m_per_s2 = {};
    const Vec3 from{-kRadiusM, -kSkewM, -2}, to{kRadiusM, kSkewM, -2};
    def.bodies = {Ball(kBallKg, from), Ball(kBallKg, to), Ball(200, {})};
    def.bodies[2].inertia_kg_m2 = {1, 0.5, 1, 0, 0, 0};
    def.bodies[2].angular_velocity_rad_per_s = {0, sense * kSpinRadPerS, 0};
    CableDef cable = Cable({0, from}, {1, to}, 2e3, 1, 0.001);
    cable.touches = CableTouches::kNone;
    cable.attachments.insert(cable.attachments.begin() + 1,
                             {2, {}, 0.5, WheelDef{{0, 1, 0}, kRadiusM, true, 0}});
    cable.rest_length_m = 0.97 * math::DescribedPath(cable).length_m();
    def.cables = {cable};
    EXPECT_GT(CheckBalance(def, 0.2, 2e-3), 1);
  }
}

}  // namespace
}  // namespace taut::test
