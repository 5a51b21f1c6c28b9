/// Impacts, position projection and continuous collision detection in one SIMD lane do not change
/// the other lanes: each world has the bits of a single world (docs/determinism.md).

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/box.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

constexpr int kWorlds = 8;
constexpr int kBusy = 3;  ///< Index of the world that is disturbed.
constexpr double kStepS = 1e-3;

/// Changes the start of body 0 in one world.
void Throw(WorldBatch& batch, int world, const BodyState& start) {
  BodyState at = batch.Body(world, 0);
  at.position_m = at.position_m + start.position_m;
  at.velocity_m_per_s = start.velocity_m_per_s;
  at.angular_velocity_rad_per_s = start.angular_velocity_rad_per_s;
  batch.SetBodyState(world, 0, at);
}

/// Checks seven resting worlds and a disturbed one against single worlds, for every instruction
/// set.
void OneDisturbsNoOther(const ModelDef& def, const BodyState& start, int steps) {
  WorldBatch alone = MakeBatch(def), resting = MakeBatch(def);
  Throw(alone, 0, start);
  alone.Step(kStepS, steps);
  resting.Step(kStepS, steps);
  ASSERT_NE(alone.Hash(0), resting.Hash(0));
  for (const Simd simd : {Simd::kSse2, Simd::kAvx2, Simd::kAvx512}) {
    WorldBatchOptions wide;
    wide.worlds = kWorlds;
    wide.simd = simd;  // falls back to an available instruction set
    WorldBatch batch = MakeBatch(def, wide);
    Throw(batch, kBusy, start);
    batch.Step(kStepS, steps);
    for (int world = 0; world < kWorlds; ++world) {
      EXPECT_EQ(batch.Hash(world), (world == kBusy ? alone : resting).Hash(0))
          << def.name << " " << world << " " << static_cast<int>(simd);
    }
  }
}

/// Returns a box with restitution and friction that lies on the ground.
ModelDef BoxOnGround() {
  ModelDef def;
  def.name = "box";
  const Material material{0.5, 0.4, 0.8};
  scenes::AddGround(def, material);
  scenes::AddBox(def, "box", 1, {0.05, 0.04, 0.03}, {0, 0, 0.03}, {}, material);
  return def;
}

const BodyState kDropped{{0, 0, 0.05}, {}, {0.3, 0.1, -1}, {2, 1, -3}};
const BodyState kSunk{{0, 0, -2e-3}, {}, {0.3, 0.1, 0}, {2, 1, -3}};

TEST(ImpactLanes, ABoxOnTheGround) { OneDisturbsNoOther(BoxOnGround(), kDropped, 300); }

TEST(ImpactLanes, EightBoxesThatFallOnTheirEdgesAtOnce) {
  // Friction and full restitution: some impacts would gain energy and are scaled back, each by a
  // different share.
  ModelDef def = BoxOnGround();
  def.boxes[0].material = def.planes[0].material = {0.7, 0.7, 1};
  std::vector<BodyState> starts;
  scenes::Chance chance(5);
  for (int world = 0; world < kWorlds; ++world) {
    const double high = chance.Within(0.05, 0.06);
    const Vec3 v = chance.Jolt(1), w = chance.Jolt(10);
    starts.push_back({{0, 0, high}, {}, v, w});
  }
  WorldBatchOptions wide;
  wide.worlds = kWorlds;
  for (const Simd simd : {Simd::kSse2, Simd::kAvx2, Simd::kAvx512}) {
    wide.simd = simd;
    WorldBatch batch = MakeBatch(def, wide);
    for (int world = 0; world < kWorlds; ++world) {
      Throw(batch, world, starts[static_cast<std::size_t>(world)]);
    }
    batch.Step(kStepS, 1000);
    for (int world = 0; world < kWorlds; ++world) {
      WorldBatch alone = MakeBatch(def);
      Throw(alone, 0, starts[static_cast<std::size_t>(world)]);
      alone.Step(kStepS, 1000);
      EXPECT_EQ(batch.Hash(world), alone.Hash(0)) << world << " " << static_cast<int>(simd);
    }
  }
}

TEST(ImpactLanes, ABoxOnAStiffCable) {
  ModelDef def = BoxOnGround();
  def.name = "box_on_cable";
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{kWorld, {0, 0, 0.5}}, {0, {0, 0, 0.06}}};
  cable.stiffness_n_per_m = 1e7;
  cable.rest_length_m = 0.439999;
  def.cables.push_back(cable);
  OneDisturbsNoOther(def, {{0.05, 0, 0.02}, {}, {0.3, 0.1, -1}, {2, 1, -3}}, 300);
}

TEST(ImpactLanes, ThreeBallsOnEachOther) {
  ModelDef def;
  def.name = "balls";
  const Material material{0.5, 0.4, 0.8};
  scenes::AddGround(def, material);
  for (int i = 0; i < 3; ++i) {
    scenes::AddBall(def, "ball", 1, 0.05, {0, 0, 0.25 - 0.1 * i}, material);
  }
  OneDisturbsNoOther(def, kDropped, 300);
}

TEST(ImpactLanes, WhatComesOutOfTheGroundAndOutOfOthers) {
  OneDisturbsNoOther(BoxOnGround(), kSunk, 100);
  ModelDef def = BoxOnGround();
  def.name = "rod_on_box";
  const Material material{0.5, 0.4, 0.8};
  scenes::AddRod(def, "rod", 0.1, 0.01, {-0.1, 0, 0.07}, {0.1, 0, 0.07}, material);
  OneDisturbsNoOther(def, kSunk, 100);
  OneDisturbsNoOther(def, {{0, 0, 2e-3}, {}, {}, {}}, 100);
}

TEST(ImpactLanes, ARodThatPassesAWallAndHitsTheNext) {
  ModelDef def;
  def.name = "walls";
  const Material material{0.5, 0.4, 0.8};
  scenes::AddGround(def, material);
  scenes::AddRod(def, "rod", 0.1, 0.01, {-0.4, -0.2, 0.01}, {-0.4, 0.2, 0.01}, material);
  def.terrain_boxes.push_back({"low", {0, 0, 0.05}, {}, {0.02, 1, 0.05}, material});
  def.terrain_boxes.push_back({"high", {0.4, 0, 0.2}, {}, {0.02, 1, 0.2}, material});
  OneDisturbsNoOther(def, {{0, 0, 0.105}, {}, {10, 0, 0.1}, {}}, 200);
}

}  // namespace
}  // namespace taut::test
