// Pairs of moving bodies in large models: lists of near bodies give the bits of a test of all
// pairs, and keys of contacts follow from the numbers of shapes.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/contacts/moving_pairs.h"
#include "sim/data/tables.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/heap.h"
#include "tests/scenes/rod_chain.h"
#include "tests/scenes/six_strut.h"

namespace taut::test {
namespace {

constexpr double kNearStep_s = 1e-3;

/// Ways to find pairs of bodies that may touch.
enum class Pairs {
  kAll,    ///< Every pair has a clearance, as in small models.
  kNear,   ///< A list of near bodies.
  kShort,  ///< A list that is too short, so that every step searches.
};

std::shared_ptr<const Model> Compiled(const ModelDef& def, Pairs way) {
  Diagnostics complaints;
  std::shared_ptr<const Model> model = Model::Compile(def, complaints);
  EXPECT_NE(model, nullptr) << complaints.Format();
  auto& tables = const_cast<sim::Tables&>(static_cast<const sim::Tables&>(*model));
  EXPECT_GT(tables.near_capacity, 0);
  if (way == Pairs::kShort) tables.near_capacity = 1;
  if (way != Pairs::kAll) return model;
  tables.near_capacity = 0;
  const sim::View view = tables.View();
  for (const int a : tables.colliders) {
    for (const int b : tables.colliders) {
      if (a < b && !AreApart(view, a, b)) tables.moving_pairs.push_back(Ordered(view, a, b));
    }
  }
  return model;
}

/// Changes velocities of all bodies by up to 0.3 m/s.
void Stir(WorldBatch& batch, int world, int seed) {
  scenes::Chance chance(static_cast<std::uint64_t>(seed) + 1);
  for (std::size_t b = 0; b < batch.model().def().bodies.size(); ++b) {
    const int body = static_cast<int>(b);
    BodyState at = batch.Body(world, body);
    at.velocity_m_per_s =
        at.velocity_m_per_s + Vec3{chance.Within(-0.3, 0.3), chance.Within(-0.3, 0.3), 0};
    batch.SetBodyState(world, body, at);
  }
}

ModelDef ManyRods() {
  scenes::RodHeap heap;
  heap.rods = 50;
  heap.apart_m = 0.025;
  return heap.Def();
}

/// Two layers of robots, of which the upper one falls on the lower one.
ModelDef Robots() {
  ModelDef def;
  def.name = "robots";
  scenes::AddGround(def, {0.5, 0.5, 0.0});
  for (int i = 0; i < 12; ++i) {
    scenes::SixStrut robot;
    robot.damping_n_s_per_m = 10;
    robot.center_m = {1.3 * (i % 2) + 0.2 * (i / 6), 1.3 * (i / 2 % 3), 0.55 + 0.95 * (i / 6)};
    const ModelDef part = robot.Def();
    const int first = static_cast<int>(def.bodies.size());
    const std::string prefix = "robot_" + std::to_string(i) + "_";
    for (BodyDef body : part.bodies) body.name = prefix + body.name, def.bodies.push_back(body);
    for (CapsuleDef rod : part.capsules) {
      rod.name = prefix + rod.name, rod.body += first, def.capsules.push_back(rod);
    }
    for (CableDef cable : part.cables) {
      cable.name = prefix + cable.name;
      for (AttachmentDef& end : cable.attachments) end.body += first;
      def.cables.push_back(cable);
    }
  }
  return def;
}

/// A chain with joints, which falls on a moving block; neighbors in the chain are kept apart.
ModelDef ChainOverBlock() {
  ModelDef def = scenes::RodChain(60, {0.1, 0, 0.02}, 1.0);
  for (CapsuleDef& rod : def.capsules) rod.collides = true;
  BodyDef block;
  block.name = "block";
  block.fixed = true;
  block.com_m = {2, 0, -0.2};
  def.bodies.push_back(block);
  const int body = static_cast<int>(def.bodies.size()) - 1;
  def.boxes.push_back({"block", body, block.com_m, {}, {0.5, 0.5, 0.1}, {0.5, 0.5, 0.0}});
  MotionDef motion;
  motion.body = body;
  motion.name = "lift";
  motion.slide = {{}, 0.05, 1.0, 0};
  def.motions.push_back(motion);
  def.apart.push_back({3, 40});
  return def;
}

/// Balls of several sizes that fly into each other at up to 40 m/s.
ModelDef FastBalls() {
  ModelDef def;
  def.name = "fast_balls";
  scenes::Chance chance(3);
  for (int i = 0; i < 60; ++i) {
    const double radius_m = i == 0 ? 0.8 : 0.05 + 0.001 * i;
    const Vec3 at{1.9 * (i % 4), 1.7 * (i / 4 % 4), 2.1 * (i / 16)};
    scenes::AddBall(def, "ball_" + std::to_string(i), 0.1, radius_m, at, {0.3, 0.3, 0.9});
    def.bodies.back().velocity_m_per_s = 40.0 * chance.Direction();
  }
  return def;
}

/// Compares runs of all ways; returns the largest number of contacts between moving bodies.
std::size_t ExpectEqualBits(const ModelDef& def, int steps) {
  WorldBatch all(Compiled(def, Pairs::kAll), {});
  WorldBatch near(Compiled(def, Pairs::kNear), {});
  WorldBatch every(Compiled(def, Pairs::kShort), {});
  std::size_t most = 0;
  for (int i = 0; i < steps; ++i) {
    for (WorldBatch* const batch : {&all, &near, &every}) {
      if (i == steps / 2) Stir(*batch, 0, 7);
      batch->Step(kNearStep_s, 1);
    }
    std::size_t contacts = 0;
    for (const ContactState& c : all.Contacts(0)) contacts += c.body_b != kWorld;
    most = std::max(most, contacts);
    if (all.Hash(0) == near.Hash(0) && all.Hash(0) == every.Hash(0)) continue;
    ADD_FAILURE() << "step " << i << ": near " << (all.Hash(0) == near.Hash(0)) << ", every step "
                  << (all.Hash(0) == every.Hash(0));
    break;
  }
  return most;
}

TEST(NearBodies, GiveTheBitsOfAllPairsInAHeap) { EXPECT_GT(ExpectEqualBits(ManyRods(), 400), 40u); }
TEST(NearBodies, GiveTheBitsOfAllPairsInAFleet) { EXPECT_GT(ExpectEqualBits(Robots(), 600), 4u); }
TEST(NearBodies, GiveTheBitsOfAllPairsWithJointsAndMotions) {
  EXPECT_GT(ExpectEqualBits(ChainOverBlock(), 600), 2u);
}
TEST(NearBodies, GiveTheBitsOfAllPairsOfFastBalls) {
  EXPECT_GT(ExpectEqualBits(FastBalls(), 400), 0u);
}

TEST(NearBodies, AreFoundInEveryLane) {
  const ModelDef def = ManyRods();
  constexpr int kWorlds = 9, kSteps = 250;
  WorldBatchOptions options;
  options.worlds = kWorlds;
  options.threads = 2;
  for (const Pairs way : {Pairs::kNear, Pairs::kShort}) {
    WorldBatch together(Compiled(def, way), options);
    for (int i = 0; i < kWorlds; ++i) Stir(together, i, i);
    together.Step(kNearStep_s, kSteps);
    for (int i = 0; i < kWorlds; i += 4) {
      WorldBatch alone(Compiled(def, Pairs::kAll), {});
      Stir(alone, 0, i);
      alone.Step(kNearStep_s, kSteps);
      EXPECT_EQ(together.Hash(i), alone.Hash(0)) << i;
    }
  }
}

/// Bodies moved by a caller, worlds replaced by snapshots, and worlds that pause.
TEST(NearBodies, AreFoundAgainAfterOtherChanges) {
  const ModelDef def = ManyRods();
  WorldBatchOptions options;
  options.worlds = 2;
  options.simd = Simd::kSse2;  // falls back to an available instruction set
  std::vector<std::vector<std::uint64_t>> hashes;
  for (const Pairs way : {Pairs::kAll, Pairs::kNear}) {
    WorldBatch batch(Compiled(def, way), options);
    std::vector<std::uint64_t>& list = hashes.emplace_back();
    const auto keep = [&] { list.push_back(batch.Hash(0)), list.push_back(batch.Hash(1)); };
    Stir(batch, 1, 4);
    batch.Step(kNearStep_s, 150);
    const std::vector<std::uint8_t> snapshot = batch.Save(1);
    BodyState at = batch.Body(0, 49);
    at.position_m = batch.Body(0, 0).position_m + Vec3{0, 0, 0.03};
    batch.SetBodyState(0, 49, at);
    batch.Step(kNearStep_s, 20);
    keep();
    ASSERT_TRUE(batch.Restore(0, snapshot));
    batch.Step(kNearStep_s, 50);
    keep();
    for (int i = 0; i < 60; ++i) {
      const std::uint8_t mask[] = {i % 3 == 0, i % 3 != 1};
      batch.StepMasked(kNearStep_s, mask);
    }
    keep();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(MovingPairs, HaveAscendingKeysWithoutGaps) {
  // Bodies with one to three shapes, a fixed one, one without shapes, two kinematic ones, and some
  // kept apart.
  ModelDef def;
  scenes::AddGround(def, {});
  for (int i = 0; i < 12; ++i) {
    scenes::AddBall(def, "ball_" + std::to_string(i), 1, 0.1, {1.0 * i, 0, 1}, {});
    for (int more = 0; more < i % 3; ++more) def.spheres.push_back(def.spheres.back());
  }
  def.spheres.erase(def.spheres.begin());  // of the first ball
  def.bodies[5].fixed = true;
  for (const int body : {4, 9}) {
    def.bodies[static_cast<std::size_t>(body)].fixed = true;
    MotionDef motion;
    motion.name = "motion_" + std::to_string(body);
    motion.body = body;
    motion.slide = {{}, 0.1, 1.0, 0};
    def.motions.push_back(motion);
  }
  def.apart = {{2, 3}, {2, 11}, {7, 10}, {1, 4}};
  Diagnostics complaints;
  const auto model = Model::Compile(def, complaints);
  ASSERT_NE(model, nullptr) << complaints.Format();
  const auto& tables = static_cast<const sim::Tables&>(*model);
  const sim::View m = tables.View();
  const auto& motions = tables.motion_of_body;
  std::uint32_t key = m.first_pair_id + static_cast<std::uint32_t>(sim::kMaxPointsPerPair) *
                                            static_cast<std::uint32_t>(m.shape_pair_count);
  int bodies = 0;
  for (int i = 0; i < 12; ++i) {
    for (int k = i + 1; k < 12; ++k) {
      bool apart = i == 0 || i == 5 || k == 5 || (i == 4 && k == 9);
      for (const ApartDef& pair : def.apart) apart |= pair.body_a == i && pair.body_b == k;
      if (apart) continue;
      ++bodies;
      const bool led = motions[static_cast<std::size_t>(i)] >= 0;
      const int a = led ? k : i, b = led ? i : k;
      EXPECT_EQ(FirstKeyOf(m, {a, b}), key) << a << ' ' << b;
      for (int s = m.first_shape[a]; s < m.first_shape[a + 1]; ++s) {
        for (int t = m.first_shape[b]; t < m.first_shape[b + 1]; ++t) {
          for (std::uint32_t point = 0; point < sim::kMaxPointsPerPair; ++point) {
            const sim::ShapePairTable pair = PairOfKey(m, key + point);
            EXPECT_EQ(pair.a, m.body_shapes[s]) << key;
            EXPECT_EQ(pair.b, m.body_shapes[t]) << key;
            EXPECT_EQ(pair.id, key);
          }
          key += sim::kMaxPointsPerPair;
        }
      }
    }
  }
  EXPECT_EQ(KeyEnd(m), key);
  EXPECT_EQ(m.moving_pair_count, bodies);
}

/// Neither a world nor a model stores all pairs.
TEST(NearBodies, NeedMemoryInProportionToTheirNumber) {
  const auto size = [](int balls) {
    ModelDef def;
    for (int i = 0; i < balls; ++i) {
      scenes::AddBall(def, std::to_string(i), 1, 0.1, {1.0 * i, 0, 0}, {});
    }
    return MakeBatch(def).BytesPerWorld();
  };
  const std::size_t some = size(1000), more = size(4000);
  EXPECT_LT(more, some * 4 + 1000);
}

}  // namespace
}  // namespace taut::test
