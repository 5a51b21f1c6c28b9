/// Contact-rich scenes: properties and starts

#include <gtest/gtest.h>

#include <map>

#include "math/vec.h"
#include "taut/world_batch.h"
#include "tests/scenes/heap.h"
#include "tests/scenes/many_rows.h"
#include "tests/scenes/prism_tower.h"
#include "tests/scenes/single_rod.h"
#include "tests/scenes/spine_on_rubble.h"
#include "tests/scenes/stacks.h"

namespace taut::test {
namespace {

template <class Scene>
ModelDef Seeded(std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  return scene.Def();
}

const std::map<std::string, ModelDef (*)(std::uint64_t)> kSeeded = {
    {"rod heap", Seeded<scenes::RodHeap>},     {"mixed heap", Seeded<scenes::MixedHeap>},
    {"box stack", Seeded<scenes::BoxStack>},   {"log pile", Seeded<scenes::LogPile>},
    {"slab", Seeded<scenes::SlabOnRods>},      {"brick wall", Seeded<scenes::BrickWall>},
    {"net", Seeded<scenes::BallInNet>},        {"prism tower", Seeded<scenes::PrismTower>},
    {"rubble", Seeded<scenes::SpineOnRubble>},
};

std::map<std::string, ModelDef> Scenes() {
  std::map<std::string, ModelDef> all = {{"disc", scenes::FootedDisc().Def()},
                                         {"Painleve", scenes::PainleveRod().Def()},
                                         {"wedge", scenes::RodInWedge().Def()}};
  for (const auto& [name, make] : kSeeded) all[name] = make(1);
  return all;
}

WorldBatch World(const ModelDef& def) {
  Diagnostics complaints;
  const auto model = Model::Compile(def, complaints);
  EXPECT_NE(model, nullptr) << complaints.Format();
  return {model, {}};
}

/// Returns the hash of the state after some steps.
std::uint64_t HashAfter(const ModelDef& def, int steps) {
  WorldBatch world = World(def);
  world.Step(0.001, steps);
  return world.Hash(0);
}

TEST(ContactScenes, FollowFromTheirSeedAlone) {
  for (const auto& [name, make] : kSeeded) {
    EXPECT_EQ(HashAfter(make(7), 1), HashAfter(make(7), 1)) << name;
    EXPECT_NE(HashAfter(make(7), 200), HashAfter(make(8), 200)) << name;
  }
}

TEST(ContactScenes, DoNotStartInsideEachOther) {
  for (const auto& [name, def] : Scenes()) {
    WorldBatch world = World(def);
    world.Step(1e-6);
    for (const ContactState& c : world.Contacts(0)) {
      EXPECT_GT(c.gap_m, -1e-6) << name << ": bodies " << c.body_a << " and " << c.body_b;
    }
  }
}

TEST(ContactScenes, HaveRoomForTheirContactsAndStayFinite) {
  for (const auto& [name, def] : Scenes()) {
    WorldBatch world = World(def);
    world.Step(0.001, 200);
    EXPECT_EQ(world.Status(0).bits & ~kStatusNotConverged, 0U) << name;
  }
}

TEST(ContactScenes, AHeapTouchesItselfAndItsFunnelHoldsIt) {
  scenes::RodHeap heap;
  heap.rods = 6;
  WorldBatch world = World(heap.Def());
  world.Step(0.001, 1000);
  int pairs = 0;
  for (const ContactState& c : world.Contacts(0)) pairs += c.body_b != kWorld;
  EXPECT_GT(pairs, 0);
  for (int rod = 0; rod < heap.rods; ++rod) {
    const Vec3 p = world.Body(0, rod).position_m;
    EXPECT_LT(std::fmax(std::fabs(p.x), std::fabs(p.y)), 0.3 + 0.3 * p.z) << rod;
    EXPECT_GT(p.z, 0) << rod;
  }
}

TEST(ContactScenes, ANetHoldsItsBallByCablesAlone) {
  scenes::BallInNet net;
  net.damping_n_s_per_m = 1e4;
  const ModelDef def = net.Def();
  EXPECT_EQ(def.cables.size(), 24U) << "none along the rim";
  WorldBatch world = World(def);
  world.Step(0.001, 500);
  const int ball = static_cast<int>(def.bodies.size()) - 1;
  const BodyState state = world.Body(0, ball);
  EXPECT_GT(state.position_m.z, 1.1);
  EXPECT_LT(std::fabs(state.velocity_m_per_s.z), 0.5) << "free it would be 4.9 m/s";
}

TEST(ContactScenes, AStackStandsAndAWallAndATower) {
  const auto top = [](const ModelDef& def) {
    const int last = static_cast<int>(def.bodies.size()) - 1;
    WorldBatch world = World(def);
    const double before = world.Body(0, last).position_m.z;
    world.Step(0.001, 300);
    return world.Body(0, last).position_m.z / before;
  };
  scenes::BoxStack stack;
  stack.boxes = 3;
  EXPECT_GT(top(stack.Def()), 0.85) << "fell further than the gaps between its boxes";
  EXPECT_GT(top(scenes::BrickWall().Def()), 0.95);
  EXPECT_GT(top(scenes::PrismTower().Def()), 0.95);
}

TEST(ContactScenes, APainleveRodTouchesWithItsLowerEndOnly) {
  scenes::PainleveRod rod;
  rod.friction = 0.1;
  WorldBatch world = World(rod.Def());
  world.Step(0.001);
  const std::vector<ContactState> contacts = world.Contacts(0);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_LT(std::fabs(contacts[0].point_m.x), 0.01);
  EXPECT_LT(contacts[0].force_n.x, 0) << "friction is against the sliding";
}

TEST(ContactScenes, ARodInAWedgeTouchesBothPlanesAndStays) {
  WorldBatch world = World(scenes::RodInWedge().Def());
  world.Step(0.001, 2000);
  EXPECT_EQ(world.Contacts(0).size(), 2U);
  const BodyState state = world.Body(0, 0);
  EXPECT_LT(std::sqrt(Dot(state.velocity_m_per_s, state.velocity_m_per_s)), 1e-3);
}

}  // namespace
}  // namespace taut::test
