// Joints in kinematic loops, in SIMD lanes and in serialization, and their diagnostics
// (docs/theory/joints.md).
#include <gmock/gmock.h>

#include "math/vec.h"
#include "tests/physics/joint_scenes.h"

namespace taut::test {
namespace {

/// Returns a parallelogram linkage in the plane of x and z: three rods on hinges about y, pinned to
/// the world at both lower ends.
ModelDef FourBars(JointKind kind) {
  ModelDef def;
  const Vec3 corners[] = {{0, 0, 0}, {0.2, 0, 1}, {1.2, 0, 1}, {1, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    scenes::AddRod(def, "rod" + std::to_string(i), 1, 0.02, corners[i], corners[i + 1], {});
    def.capsules.back().collides = false;
  }
  for (int i = 0; i < 4; ++i) {
    JointDef j;
    j.name = "hinge" + std::to_string(i), j.kind = kind, j.axis = {0, 1, 0};
    j.body_a = i == 0 || i == 3 ? kWorld : i - 1, j.body_b = i == 3 ? 2 : i;
    j.from_m = j.to_m = corners[i];
    def.joints.push_back(j);
  }
  return def;
}

TEST(Joint, AClosedLoopWithRedundantRowsMovesAsAParallelogram) {
  // Two rods rotate about their ends and carry a third: (1/3 + 1/3 + 1) m L^2 w' = (1/2
  // + 1/2 + 1) m g L sin(a). Compared with a fine integration of this equation.
  const ModelDef def = FourBars(JointKind::kHinge);
  const double L = std::sqrt(1.04), k = 2.0 / (5.0 / 3) * kG / L;
  WorldBatch world = MakeBatch(def);
  double a = std::atan(0.2), w = 0;
  const double a0 = a;
  for (int n = 1; n <= 2000; ++n) {
    world.Step(1e-3);
    ASSERT_EQ(world.Status(0).bits, kStatusOk) << n;
    ASSERT_LE(world.Status(0).linear_solves, 6) << n;
    ASSERT_LT(WorstGap(world, def), 1e-10) << n;
    for (int i = 0; i < 10; ++i) {  // leapfrog, 0.1 ms
      a += 0.5e-4 * w, w += 1e-4 * k * std::sin(a), a += 0.5e-4 * w;
    }
    ASSERT_NEAR(world.Joint(0, 0).coordinate, a - a0, 2e-3) << n;
  }
}

TEST(Joint, HowThickRodsAreIsNothingToAnOpenOrClosedChainOfBalls) {
  // Two cables pull a folded square of four rods through itself and out again, all in space. Spin
  // of a thin rod about its axis would cost next to no energy.
  for (const bool closed : {true, false}) {
    for (const double radius_m : {0.05, 1e-4}) {
      double off[2] = {};
      for (int k = 0; k < 2; ++k) {
        const double h = k == 0 ? 1e-3 : 0.5e-3;
        ModelDef def;
        def.gravity_m_per_s2 = {};
        const Vec3 corners[] = {{-1, 0, 0}, {0, -1, 0.3}, {1, 0, 0}, {0, 1, 0.3}};
        for (int i = 0; i < 4; ++i) {
          scenes::AddRod(def, "rod" + std::to_string(i), 1, radius_m, corners[i],
                         corners[(i + 1) % 4], {});
          def.capsules.back().collides = false;
          if (i == 0 && !closed) continue;
          JointDef j;
          j.name = "ball" + std::to_string(i), j.body_a = (i + 3) % 4, j.body_b = i;
          j.from_m = j.to_m = corners[i];
          def.joints.push_back(j);
        }
        for (int i = 0; i < 2; ++i) {
          CableDef cable;
          cable.name = "cable" + std::to_string(i);
          cable.attachments = {{i, corners[i]}, {i + 2, corners[i + 2]}};
          cable.stiffness_n_per_m = 100, cable.rest_length_m = i == 0 ? 0.5 : 1.0;
          def.cables.push_back(cable);
        }
        WorldBatch world = MakeBatch(def);
        const double start = EnergyOf(world);
        for (int n = 0; n < StepsIn(2, h); ++n) {
          world.Step(h);
          off[k] = std::max(off[k], std::fabs(EnergyOf(world) - start));
          ASSERT_LT(WorstGap(world, def), 1e-9) << n;
        }
      }
      EXPECT_LT(off[0], 0.02) << closed << " " << radius_m;  // of 162 J
      EXPECT_NEAR(off[0] / off[1], 4, 0.5) << closed << " " << radius_m;
    }
  }
}

TEST(Joint, AFrameOfWeldsThatTumblesIsSolvedThoughSixOfItsRowsAreRedundant) {
  ModelDef def;
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 0.7, 0.2}, {0, 0.7, 0.1}};
  for (int i = 0; i < 4; ++i) {
    scenes::AddRod(def, "rod" + std::to_string(i), 1 + i, 0.02, corners[i], corners[(i + 1) % 4],
                   {});
    def.capsules.back().collides = false;
    def.bodies.back().angular_velocity_rad_per_s = {8, 5, -6};
    def.bodies.back().velocity_m_per_s = Cross(Vec3{8, 5, -6}, def.bodies.back().com_m);
    JointDef j;
    j.name = "weld" + std::to_string(i), j.kind = JointKind::kWeld;
    j.body_a = (i + 3) % 4, j.body_b = i, j.from_m = j.to_m = corners[i];
    def.joints.push_back(j);
  }
  WorldBatch world = MakeBatch(def);
  int solves = 0;
  for (int n = 0; n < 2000; ++n) {
    world.Step(1e-3);
    solves = std::max(solves, world.Status(0).linear_solves);
    ASSERT_LT(WorstGap(world, def), 1e-9) << n;
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  EXPECT_LE(solves, 6);
}

TEST(Joint, ABodyThatIsFixedHoldsLikeTheWorld) {
  const ModelDef by_world = Chain(3, {0.1, 0, 0}, 1);
  ModelDef by_body = by_world;
  BodyDef post;
  post.name = "post", post.com_m = {0.3, 0.1, 0.2}, post.fixed = true;
  by_body.bodies.push_back(post);
  by_body.joints[0].body_a = 3;
  WorldBatch one = MakeBatch(by_world), other = MakeBatch(by_body);
  one.Step(1e-3, 1000), other.Step(1e-3, 1000);
  EXPECT_EQ(other.Status(0).bits, kStatusOk);
  EXPECT_LT(Distance(one.Body(0, 2).position_m, other.Body(0, 2).position_m), 1e-9);
  EXPECT_GT(Distance(one.Body(0, 2).position_m, by_world.bodies[2].com_m), 0.05);
}

TEST(JointLong, AnHourOfSwingsLeavesNoGap) {
  for (const bool loop : {false, true}) {
    const ModelDef def = loop ? FourBars(JointKind::kHinge) : Chain(3, {0.1, 0, 0}, 1);
    WorldBatch world = MakeBatch(def);
    double gap = 0;
    int unsolved = 0;
    for (int n = 0; n < 3'600'000; ++n) {
      world.Step(1e-3);
      gap = std::max(gap, WorstGap(world, def));
      if (world.Status(0).bits == kStatusOk) continue;
      // At its flat pose a parallelogram has one more redundant row.
      ASSERT_EQ(world.Status(0).bits, kStatusNotConverged) << n;
      ASSERT_LT(world.Status(0).residual_m_per_s, 1e-7) << n;
      world.ClearStatus(0);
      ++unsolved;
    }
    EXPECT_LT(gap, 1e-9) << loop;
    EXPECT_LE(unsolved, loop ? 100 : 0);
  }
}

void ExpectLanesLikeAlone(const ModelDef& def) {
  const auto prepare = [](WorldBatch& batch, int world, int as) {
    batch.SetParameter(world, Parameter::kBodyMass, 1, 1 + 0.3 * as);
  };
  constexpr int kWorlds = 11;
  std::vector<std::uint64_t> alone;
  for (int w = 0; w < kWorlds; ++w) {
    WorldBatchOptions one;
    one.simd = Simd::kScalar;
    WorldBatch world = MakeBatch(def, one);
    prepare(world, 0, w);
    world.Step(1e-3, 1500);
    alone.push_back(world.Hash(0));
  }
  for (const int lanes : {2, 4, 8}) {
    WorldBatchOptions options;
    options.worlds = kWorlds, options.simd = static_cast<Simd>(lanes);  // or the widest available
    WorldBatch together = MakeBatch(def, options);
    for (int w = 0; w < kWorlds; ++w) prepare(together, w, w);
    together.Step(1e-3, 1500);
    for (int w = 0; w < kWorlds; ++w) {
      EXPECT_EQ(alone[static_cast<std::size_t>(w)], together.Hash(w)) << lanes << " " << w;
    }
  }
}

TEST(Joint, LanesHaveTheBitsOfAWorldAlone) {
  ModelDef def = FourBars(JointKind::kHinge);
  def.joints[1].friction = 0.2, def.joints[0].most = 2.0, def.joints[0].restitution = 0.5;
  def.joints[2].stiffness = 1;
  ExpectLanesLikeAlone(def);
}

TEST(Joint, LanesOfBallsWithFrictionAndSpringsHaveTheBitsOfAWorldAlone) {
  ModelDef def = Chain(4, {0.06, 0.08, 0}, 1);
  def.gravity_m_per_s2 = {1, 2, -kG};
  for (JointDef& j : def.joints) j.friction = 0.4, j.stiffness = 3, j.damping = 0.01;
  def.joints[1].friction = 0, def.joints[2].stiffness = 0, def.joints[3].most = 0.5;
  ExpectLanesLikeAlone(def);
}

TEST(Joint, LanesOfStopsThatPressAndOfFastRotorsHaveTheBitsOfAWorldAlone) {
  // The damper slows the rotor, body 1, at a different time in each world: some rotate slowly
  // enough for the series of the drift while others still use sine and cosine.
  ModelDef def = Chain(1, {0.06, 0.08, 0}, 1);
  def.joints[0].kind = JointKind::kHinge, def.joints[0].most = 0.2;
  scenes::AddRod(def, "rotor", 1, 0.1, {2, 0, 0}, {2, 0.1, 0}, {});
  scenes::AddRod(def, "rod", 1, 0.01, {0.06, 0.08, 0}, {0.12, 0.16, 0}, {});
  for (CapsuleDef& capsule : def.capsules) capsule.collides = false;
  JointDef axle;
  axle.name = "axle", axle.kind = JointKind::kHinge, axle.body_b = 1, axle.axis = {0, 1, 0};
  axle.from_m = axle.to_m = {2, 0.05, 0}, axle.damping = 2e-2;
  def.bodies[1].angular_velocity_rad_per_s = {0, 2000, 0};
  def.joints.push_back(axle);
  JointDef cone;
  cone.name = "cone", cone.body_a = 0, cone.body_b = 2, cone.most = 0.3;
  cone.from_m = cone.to_m = {0.06, 0.08, 0};
  def.joints.push_back(cone);
  ExpectLanesLikeAlone(def);
}

TEST(Joint, AParallelogramComesToRestOnTheStopOfOneHinge) {
  for (const double restitution : {0.0, 0.5}) {
    ModelDef def = FourBars(JointKind::kHinge);
    def.joints[0].most = 0.5, def.joints[0].restitution = restitution;
    WorldBatch world = MakeBatch(def);
    double energy = EnergyOf(world);
    for (int n = 1; n <= 4000; ++n) {
      world.Step(1e-3);
      ASSERT_EQ(world.Status(0).bits, kStatusOk) << n;
      ASSERT_LT(WorstGap(world, def), 1e-10) << n;
      ASSERT_LT(world.Joint(0, 0).coordinate, 0.5 + 1e-9) << n;
      ASSERT_LT(EnergyOf(world), energy + 1e-3) << n;
    }
    EXPECT_NEAR(world.Joint(0, 0).coordinate, 0.5, 1e-9);
    EXPECT_LT(std::fabs(world.Joint(0, 0).rate), 1e-9);
  }
}

TEST(Joint, ASnapshotGoesOnWithTheSameBits) {
  ModelDef def = FourBars(JointKind::kBall);
  def.joints[1].friction = 0.2, def.joints[2].stiffness = 1, def.joints[3].damping = 0.1;
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 300);
  const auto snapshot = world.Save(0);
  world.Step(1e-3, 300);
  const auto there = world.Hash(0);
  ASSERT_TRUE(world.Restore(0, snapshot));
  world.Step(1e-3, 300);
  EXPECT_EQ(world.Hash(0), there);
}

TEST(Joint, WrongOnesAreAllNamed) {
  const auto complaints = [](auto&& change) {
    ModelDef def = Chain(2, {0.1, 0, 0}, 1);
    change(def);
    Diagnostics out;
    EXPECT_EQ(Model::Compile(def, out), nullptr);
    return out.Format();
  };
  using testing::HasSubstr;
  EXPECT_THAT(complaints([](ModelDef& d) { d.joints[1].body_a = 1; }),
              HasSubstr("connects a body to itself"));
  EXPECT_THAT(complaints([](ModelDef& d) { d.joints[1].body_a = 7; }), HasSubstr("does not exist"));
  EXPECT_THAT(complaints([](ModelDef& d) { d.joints[1].to_m.y = 0.2; }), HasSubstr("0.2 m apart"));
  EXPECT_THAT(complaints([](ModelDef& d) {
                d.joints[1].axis = {0, 0, 2};
              }),
              HasSubstr("unit vector"));
  EXPECT_THAT(complaints([](ModelDef& d) { d.joints[1].friction = -1; }),
              HasSubstr("friction must be zero or"));
  EXPECT_THAT(complaints([](ModelDef& d) { d.joints[1].rest = 1; }),
              HasSubstr("at rest in the described pose"));
  EXPECT_THAT(complaints([](ModelDef& d) {
                d.joints[1].kind = JointKind::kHinge;
                d.joints[1].least = 1, d.joints[1].most = 0;
              }),
              HasSubstr("must be below its upper limit"));
  EXPECT_THAT(complaints([](ModelDef& d) { d.bodies[0].fixed = true; }),
              HasSubstr("both of its bodies are fixed"));
  const std::string all = complaints([](ModelDef& d) {
    d.joints[0].axis = {}, d.joints[1].restitution = 2, d.apart.push_back({0, 5});
  });
  EXPECT_THAT(all, testing::AllOf(HasSubstr("unit vector"), HasSubstr("restitution"),
                                  HasSubstr("a pair of bodies that do not collide")));
}

TEST(Joint, WhatItJoinsDoesNotTouchUnlessItSaysSo) {
  for (const bool collides : {false, true}) {
    ModelDef def = Chain(2, {0.1, 0, 0}, 1);
    for (CapsuleDef& rod : def.capsules) rod.collides = true;
    def.gravity_m_per_s2 = {};
    def.joints[1].collides = collides;
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3);
    EXPECT_EQ(world.Contacts(0).empty(), !collides);
  }
}

}  // namespace
}  // namespace taut::test
