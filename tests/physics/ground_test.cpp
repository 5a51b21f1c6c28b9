// Height fields and meshes under balls, rods and robots (docs/theory/ground.md): motion as on a
// plane, closed forms, and bounds of energy and penetration on hills.
#include <gtest/gtest.h>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"
#include "tests/scenes/rough_ground.h"
#include "tests/scenes/six_strut.h"

namespace taut::test {
namespace {

using Split = HeightFieldDef::Split;

/// A flat ground: a height field with one of three triangle splits, or a mesh.
struct Ground {
  const char* name;
  int form;

  void AddTo(ModelDef& def, double slope, const Material& material) const {
    HeightFieldDef field =
        scenes::Field(300, 40, 0.04, material, [=](double x, double) { return -slope * x; });
    field.split = form == 0 ? Split::kSame : form == 1 ? Split::kAlternating : Split::kShortest;
    if (form < 3) {
      def.height_fields.push_back(field);
    } else {
      def.terrain_meshes.push_back(scenes::MeshOf(field, 7));
    }
  }
};
constexpr Ground kGrounds[] = {
    {"same", 0}, {"alternating", 1}, {"shortest", 2}, {"mesh, random diagonals", 3}};

TEST(Ground, ABallRollsOverTheTrianglesOfAPlaneAsOnAPlane) {
  const Material material{0.5, 0.5, 0};
  for (const Ground& ground : kGrounds) {
    for (const double angle : {0.0, 10 * 3.14159265358979323846 / 180}) {
      ModelDef def;
      const double r = 0.05;
      const Vec3 up{std::sin(angle), 0, std::cos(angle)},
          down{std::cos(angle), 0, -std::sin(angle)};
      const Vec3 start = Vec3{-5.5, 0.013, 5.5 * std::tan(angle)} + r * up;
      scenes::AddBall(def, "ball", 0.3, r, start, material);
      def.bodies[0].velocity_m_per_s = 1.0 * down;
      def.bodies[0].angular_velocity_rad_per_s = {0, 1.0 / r, 0};
      ground.AddTo(def, std::tan(angle), material);
      WorldBatch world = MakeBatch(def);
      const double h = 1e-3;
      const int steps = StepsIn(3, h);
      world.Step(h, steps);
      const BodyState end = world.Body(0, 0);
      const double speed = 1 + 5.0 / 7.0 * kG * std::sin(angle) * 3;
      EXPECT_NEAR(Dot(end.velocity_m_per_s, down), speed, 1e-9) << ground.name << " " << angle;
      EXPECT_NEAR(end.position_m.y, 0.013, 1e-10) << ground.name << " " << angle;
      EXPECT_NEAR(Dot(end.position_m - start, up), 0, 1e-9) << ground.name << " " << angle;
      EXPECT_NEAR(Dot(end.position_m - start, down), 3 * 0.5 * (1 + speed), 1e-8)
          << ground.name << " " << angle;
    }
  }
}

TEST(Ground, WhoeverFallsOffSaysSo) {
  // A ball next to two fields, from 0.2 m above the plane of the lower field.
  const double h = 1e-3, fall = std::sqrt(2 * 0.2 / kG);
  ModelDef def;
  scenes::AddBall(def, "far", 1, 0.05, {0, 0, 1.05}, {0.5, 0.5, 0});
  scenes::AddBall(def, "ball", 1, 0.05, {0, 3, 0.2}, {0.5, 0.5, 0});
  def.height_fields.push_back(scenes::Field(20, 20, 0.1, {}, [](double, double) { return 1.0; }));
  def.height_fields.push_back(scenes::Field(20, 20, 0.1, {}, [](double, double) { return 0.0; }));
  def.height_fields[1].origin_m = {0, 5.0, 0};
  WorldBatchOptions options;
  options.worlds = 3;
  for (const Simd simd : {Simd::kScalar, Simd::kSse2, Simd::kAvx2, Simd::kAvx512}) {
    options.simd = simd;
    WorldBatch world = MakeBatch(def, options);
    for (const int safe : {0, 2}) {
      BodyState s = world.Body(safe, 1);
      s.position_m = {0, 5, 0.05};
      world.SetBodyState(safe, 1, s);
    }
    world.Step(h, StepsIn(0.3, h));
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
    EXPECT_EQ(world.Status(2).bits, kStatusOk);
    const WorldStatus status = world.Status(1);
    EXPECT_EQ(status.bits, kStatusFellOff);
    EXPECT_EQ(status.body, 1);
    EXPECT_EQ(status.ground, 1);
    EXPECT_NEAR(status.first_time_s, fall, h);
    // The status persists until ClearStatus with the ball back above the field.
    BodyState back = world.Body(1, 1);
    back.position_m.z = 0.2;
    back.velocity_m_per_s = {};
    world.SetBodyState(1, 1, back);
    world.Step(h);
    EXPECT_EQ(world.Status(1).bits, kStatusFellOff);
    EXPECT_EQ(world.Status(1).first_time_s, status.first_time_s);
    world.ClearStatus(1);
    world.Step(h);
    EXPECT_EQ(world.Status(1).bits, kStatusOk);
  }
  const auto bits = [&](const ModelDef& other) {
    WorldBatch world = MakeBatch(other);
    world.Step(h, StepsIn(0.3, h));
    return world.Status(0).bits;
  };
  ModelDef caught = def;  // finally caught by a plane
  caught.planes.push_back({"floor", {0, 0, 1}, {0, 0, -9}, {}});
  EXPECT_EQ(bits(caught), kStatusOk);
  ModelDef held = def;
  held.bodies[1].fixed = true;
  held.bodies[1].com_m.z = held.spheres[1].center_m.z = -1;
  EXPECT_EQ(bits(held), kStatusOk);
  ModelDef weightless = def;
  weightless.gravity_m_per_s2 = {};
  weightless.bodies[1].com_m.z = weightless.spheres[1].center_m.z = -1;
  EXPECT_EQ(bits(weightless), kStatusOk);
  ModelDef above_a_box = def;
  above_a_box.terrain_boxes.push_back({"low", {9, 9, -3}, {}, {1, 1, 1}, {}});
  EXPECT_EQ(bits(above_a_box), kStatusOk);
}

TEST(Ground, ARodSlidesAsFarAsOnAPlane) {
  const Material material{0.2, 0.2, 0};
  for (const Ground& ground : kGrounds) {
    for (const double turn : {0.0, 0.3, 1.1}) {
      ModelDef def;
      const double r = 0.01;
      const Vec3 along{std::cos(turn), std::sin(turn), 0};
      const Vec3 middle{-0.5, 0.013, r};
      scenes::AddRod(def, "rod", 0.1, r, middle - 0.19 * along, middle + 0.19 * along, material);
      // The rod slides along its axis and does not roll.
      def.bodies[0].velocity_m_per_s = 1.0 * along;
      ground.AddTo(def, 0, material);
      WorldBatch world = MakeBatch(def);
      const double h = 1e-3;
      world.Step(h, StepsIn(1, h));
      const BodyState end = world.Body(0, 0);
      EXPECT_NEAR(Dot(end.position_m - middle, along), 1 / (2 * 0.2 * kG), 2e-6) << ground.name;
      EXPECT_NEAR(end.position_m.z, r, 1e-9) << ground.name;
      EXPECT_LE(Norm(end.velocity_m_per_s), 1e-9) << ground.name;
    }
  }
}

TEST(Ground, ARodRollsWithoutLoss) {
  const Material material{0.5, 0.5, 0};
  for (const Ground& ground : kGrounds) {
    ModelDef def;
    const double r = 0.02;
    scenes::AddRod(def, "rod", 0.1, r, {-0.6, -0.17, r}, {-0.6, 0.21, r}, material);
    def.bodies[0].velocity_m_per_s = {0.3, 0, 0};
    def.bodies[0].angular_velocity_rad_per_s = {0, 0.3 / r, 0};
    ground.AddTo(def, 0, material);
    WorldBatch world = MakeBatch(def);
    const double h = 1e-3;
    world.Step(h, StepsIn(2, h));
    const BodyState end = world.Body(0, 0);
    EXPECT_NEAR(end.velocity_m_per_s.x, 0.3, 1e-9) << ground.name;
    EXPECT_NEAR(end.position_m.x, 0.0, 1e-8) << ground.name;
    EXPECT_NEAR(end.position_m.y, 0.02, 1e-9) << ground.name;
  }
}

TEST(Ground, AFlatFieldIsThePlane) {
  const Material material{0.5, 0.4, 0.3};
  scenes::SixStrut robot;
  robot.material = material;
  robot.center_m.z = 0.6;
  robot.orientation = scenes::Turn({0.6, 0.0, 0.8}, 0.3);
  ModelDef on_plane = robot.Def();
  for (BodyDef& body : on_plane.bodies) body.velocity_m_per_s = {0.4, 0.2, 0};
  ModelDef on_field = on_plane;
  scenes::AddGround(on_plane, material);
  Ground{"alternating", 1}.AddTo(on_field, 0, material);
  // Both batches solve the same equations in different directions, each to its tolerance.
  WorldBatchOptions options;
  options.tolerance_m_per_s = 1e-12;
  WorldBatch plane = MakeBatch(on_plane, options), field = MakeBatch(on_field, options);
  const double h = 1e-3;
  for (int i = 0; i < 400; ++i) {
    plane.Step(h, 1);
    field.Step(h, 1);
    ASSERT_LE(Distance(plane.Body(0, 0).position_m, field.Body(0, 0).position_m), 1e-9) << i;
  }
  EXPECT_EQ(field.Status(0).bits, kStatusOk);
}

/// A six-strut robot that drops onto hills.
struct OnHills {
  static ModelDef Def(std::uint64_t seed, double drop_m) {
    scenes::SixStrut robot;
    const Material material{0.6, 0.5, 0.0};
    robot.material = material;
    robot.length_m = 0.4;
    robot.rod_mass_kg = 0.05;
    robot.rod_radius_m = 0.005;
    robot.damping_n_s_per_m = 3;
    scenes::Chance chance(seed);
    robot.center_m = {chance.Within(-0.3, 0.3), chance.Within(-0.3, 0.3), 0.24 + drop_m};
    robot.orientation = scenes::Turn(chance.Direction(), chance.Within(0.0, 3.0));
    ModelDef def = robot.Def();
    def.height_fields.push_back(scenes::Hills(120, 120, material));
    return def;
  }
};

/// Returns rods and balls of several sizes that fall onto hills.
ModelDef ThingsOverHills(std::uint64_t seed) {
  const Material material{0.6, 0.5, 0.0};
  ModelDef def;
  scenes::Chance chance(seed);
  for (int i = 0; i < 4; ++i) {
    const Vec3 middle{chance.Within(-0.6, 0.6), chance.Within(-0.6, 0.6), 0.25 + 0.1 * i};
    const Vec3 half = chance.Within(0.05, 0.2) * chance.Direction();
    const std::string name = std::to_string(i);
    scenes::AddRod(def, "rod_" + name, 0.05, 0.004 + 0.003 * i, middle - half, middle + half,
                   material);
    scenes::AddBall(def, "ball_" + name, 0.02, 0.01 + 0.01 * i,
                    {chance.Within(-0.6, 0.6), chance.Within(-0.6, 0.6), 0.7 + 0.1 * i}, material);
  }
  def.height_fields.push_back(scenes::Hills(120, 120, material));
  return def;
}

TEST(Ground, OnHillsEnergyNeverRisesAndNothingSinksIn) {
  double highest_m = 0, deepest_m = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ModelDef def = ThingsOverHills(seed);
    WorldBatch world = MakeBatch(def);
    double mass_kg = 0;
    for (const BodyDef& body : def.bodies) mass_kg += body.mass_kg;
    double least_j = EnergyOf(world);
    for (int i = 0; i < 2000; ++i) {
      world.Step(1e-3, 1);
      const double now_j = EnergyOf(world);
      highest_m = std::max(highest_m, (now_j - least_j) / (mass_kg * kG));
      least_j = std::min(least_j, now_j);
      for (const Overlap& overlap : world.Overlaps(0)) {
        if (overlap.body_b == kWorld) deepest_m = std::max(deepest_m, overlap.depth_m);
      }
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk) << "seed " << seed;
    for (std::size_t b = 0; b < def.bodies.size(); ++b) {
      EXPECT_GT(world.Body(0, static_cast<int>(b)).position_m.z, -0.02) << seed << " " << b;
    }
  }
  EXPECT_LE(highest_m, 1e-4);
  EXPECT_LE(deepest_m, 1e-4);
  RecordProperty("highest_um", std::to_string(1e6 * highest_m));
  RecordProperty("deepest_um", std::to_string(1e6 * deepest_m));
}

TEST(Ground, ARobotStandsOnHillsWithoutCreeping) {
  const ModelDef def = OnHills::Def(3, 0.03);
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 20000);
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    EXPECT_LE(Norm(world.Body(0, static_cast<int>(b)).velocity_m_per_s), 1e-9) << b;
  }
}

TEST(Ground, LanesOnDifferentHillsHaveTheBitsOfAWorldAlone) {
  WorldBatchOptions options;
  options.worlds = 8;
  const ModelDef def = OnHills::Def(1, 0.05);
  WorldBatch all = MakeBatch(def, options);
  const auto start = [&](WorldBatch& batch, int world, int which) {
    for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) {
      BodyState state = batch.Body(world, b);
      state.position_m = state.position_m + Vec3{0.07 * which, -0.05 * which, 0};
      batch.SetBodyState(world, b, state);
    }
  };
  for (int w = 0; w < 8; ++w) start(all, w, w);
  all.Step(1e-3, 600);
  for (int w = 0; w < 8; ++w) {
    WorldBatch alone = MakeBatch(def);
    start(alone, 0, w);
    alone.Step(1e-3, 600);
    EXPECT_EQ(alone.Hash(0), all.Hash(w)) << w;
  }
}

TEST(Ground, WhenItIsLookedAtChangesNothing) {
  // After Restore all pairs are tested again; a world that continues tests a pair only when it has
  // come near.
  const ModelDef def = OnHills::Def(5, 0.05);
  WorldBatch goes_on = MakeBatch(def), looks = MakeBatch(def);
  for (int i = 0; i < 600; ++i) {
    goes_on.Step(1e-3, 1);
    ASSERT_TRUE(looks.Restore(0, looks.Save(0)));
    looks.Step(1e-3, 1);
    ASSERT_EQ(goes_on.Hash(0), looks.Hash(0)) << i;
  }
}

/// Returns two rods, tied by a stiff cable, that fall onto bumps of a few centimeters.
ModelDef TiedRodsOverBumps() {
  const Material material{0.6, 0.5, 0.2};
  ModelDef def;
  scenes::AddRod(def, "a", 0.05, 0.004, {-0.15, -0.05, 0.06}, {0.15, -0.05, 0.06}, material);
  scenes::AddRod(def, "b", 0.05, 0.004, {-0.15, 0.05, 0.06}, {0.15, 0.05, 0.06}, material);
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{0, {-0.15, -0.05, 0.06}}, {1, {-0.15, 0.05, 0.06}}};
  cable.stiffness_n_per_m = 50000;
  cable.damping_n_s_per_m = 3;
  cable.rest_length_m = 0.0995;
  def.cables.push_back(cable);
  scenes::Chance chance(4);
  def.height_fields.push_back(scenes::Field(
      200, 200, 0.02, material, [&](double, double) { return chance.Within(-0.002, 0.002); }));
  return def;
}

TEST(Ground, WorldsWithManyContactsAndWithFewHaveTheBitsOfAWorldAlone) {
  WorldBatchOptions options;
  options.worlds = 8;
  const ModelDef def = TiedRodsOverBumps();
  WorldBatch all = MakeBatch(def, options);
  const auto start = [&](WorldBatch& batch, int world, int which) {
    for (int b = 0; b < 2; ++b) {
      BodyState state = batch.Body(world, b);
      state.position_m = state.position_m + Vec3{0.05 * which, -0.05 * which, 0.002 * which};
      state.velocity_m_per_s = {0.02 * which, 0, 0};
      batch.SetBodyState(world, b, state);
    }
  };
  for (int w = 0; w < 8; ++w) start(all, w, w);
  std::vector<WorldBatch> alone;
  for (int w = 0; w < 8; ++w) {
    alone.push_back(MakeBatch(def));
    start(alone.back(), 0, w);
  }
  // A pair of rods has room for seven contacts where worlds share SIMD registers.
  std::size_t most = 0, fewest = 1000;
  for (int i = 0; i < 50; ++i) {
    all.Step(1e-3, 20);
    for (int w = 0; w < 8; ++w) {
      WorldBatch& one = alone[static_cast<std::size_t>(w)];
      one.Step(1e-3, 20);
      ASSERT_EQ(one.Hash(0), all.Hash(w)) << w << " " << i;
      EXPECT_EQ(one.Status(0).bits, kStatusOk) << w << " " << i;
      const std::size_t contacts = one.Contacts(0).size();
      if (contacts > 0) fewest = std::min(fewest, contacts);
      most = std::max(most, contacts);
    }
  }
  EXPECT_LE(fewest, 3u);
  EXPECT_GE(most, 8u);
}

}  // namespace
}  // namespace taut::test
