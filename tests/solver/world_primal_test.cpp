// Worlds with joints that are solved in lanes: the motion is that of the lane-by-lane solver.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/data/tables.h"
#include "tests/physics/world.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/rod_chain.h"
#include "tests/scenes/walker.h"

namespace taut::test {
namespace {

constexpr double kPrimalStepS = 1e-3;

std::shared_ptr<sim::Tables> TablesOf(const ModelDef& def) {
  Diagnostics complaints;
  std::shared_ptr<const Model> model = Model::Compile(def, complaints);
  EXPECT_NE(model, nullptr) << complaints.Format();
  return std::const_pointer_cast<sim::Tables>(std::static_pointer_cast<const sim::Tables>(model));
}

/// Gives all bodies the same random velocity, so that joints do not snatch.
void Throw(WorldBatch& batch, int world, int seed) {
  scenes::Chance chance(static_cast<std::uint64_t>(seed) + 1);
  const Vec3 speed{chance.Within(-1, 1), chance.Within(-1, 1), chance.Within(-0.5, 1.5)};
  for (std::size_t b = 0; b < batch.model().def().bodies.size(); ++b) {
    BodyState at = batch.Body(world, static_cast<int>(b));
    at.velocity_m_per_s = speed;
    batch.SetBodyState(world, static_cast<int>(b), at);
  }
}

/// Steps worlds in lanes and lane by lane, and returns the largest distance of a body.
double Differ(const ModelDef& def, int steps) {
  const auto together = TablesOf(def), apart = TablesOf(def);
  EXPECT_GT(together->world_pattern.count, 0);
  apart->world_pattern.count = 0;
  WorldBatchOptions options;
  options.worlds = 8;
  WorldBatch a(together, options), b(apart, options);
  for (int world = 0; world < 8; ++world) Throw(a, world, world), Throw(b, world, world);
  a.Step(kPrimalStepS, steps), b.Step(kPrimalStepS, steps);
  double most = 0;
  for (int world = 0; world < 8; ++world) {
    EXPECT_EQ(a.Status(world).bits, kStatusOk) << world;
    EXPECT_NE(a.Hash(world), b.Hash(world)) << "the solvers round differently";
    for (int body = 0; body < static_cast<int>(def.bodies.size()); ++body) {
      most =
          std::max(most, Distance(a.Body(world, body).position_m, b.Body(world, body).position_m));
    }
  }
  return most;
}

TEST(WorldPrimal, MovesAWalkerAsTheLaneByLaneSolverDoes) {
  for (const double friction : {0.0, 0.3, 1.0}) {
    scenes::Walker walker;
    walker.friction = friction;
    EXPECT_LT(Differ(walker.Def(), 400), 1e-7) << friction;
  }
}

TEST(WorldPrimal, MovesAChainAsTheLaneByLaneSolverDoes) {
  ModelDef def = scenes::RodChain(24, {0.06, 0.08, 0}, 2.0);
  for (JointDef& joint : def.joints) joint.friction = 0.5, joint.damping = 0.01;
  EXPECT_LT(Differ(def, 300), 1e-7);
}

TEST(WorldPrimal, SolvesOnlyModelsWhoseConstraintsItHas) {
  const ModelDef walker = scenes::Walker().Def();
  EXPECT_GT(TablesOf(walker)->world_pattern.count, 0);
  ModelDef without = walker;
  without.joints.clear();
  EXPECT_EQ(TablesOf(without)->world_pattern.count, 0);
  ModelDef bent = walker;
  bent.cables[0].touches = CableTouches::kRods, bent.cables[0].radius_m = 1e-3;
  EXPECT_EQ(TablesOf(bent)->world_pattern.count, 0);
  ModelDef fixed = walker;
  BodyDef block;
  block.name = "block", block.fixed = true;
  fixed.bodies.push_back(block);
  EXPECT_EQ(TablesOf(fixed)->world_pattern.count, 0);
}

}  // namespace
}  // namespace taut::test
