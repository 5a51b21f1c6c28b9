// Height fields in the engines: all have the same triangles at the same places. Rolling and sliding
// on them depends on the engine (docs/theory/ground.md describes taut's method).
#include <gtest/gtest.h>

#include <cmath>

#include "math/vec.h"
#include "tests/constants.h"
#include "tests/peers/engine_test.h"
#include "tests/peers/sled.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"
#include "tests/scenes/rough_ground.h"

namespace taut::peers {
namespace {

constexpr double kSlope = 10 * 3.14159265358979323846 / 180;

HeightFieldDef SplitTheSame(HeightFieldDef field) {
  field.split = HeightFieldDef::Split::kSame;
  return field;
}

/// A plane that descends towards x by `angle`, as a height field or as a plane.
struct Slope {
  double angle = 0;
  Vec3 Up() const { return {std::sin(angle), 0, std::cos(angle)}; }
  Vec3 Down() const { return {std::cos(angle), 0, -std::sin(angle)}; }
  Vec3 At(double x, double y) const { return {x, y, -std::tan(angle) * x}; }
  void AddTo(ModelDef& def, bool field, const Material& material) const {
    if (!field) {
      def.planes.push_back({"plane", Up(), {}, material});
      return;
    }
    def.height_fields.push_back(SplitTheSame(scenes::Field(
        400, 40, 0.04, material, [this](double x, double) { return -std::tan(angle) * x; })));
  }
};

class GroundOf : public EngineTest {
 protected:
  static bool Is(Engine engine) { return GetParam().engine == engine; }
};

TEST_P(GroundOf, ABallFallsFreelyDownToItsTriangle) {
  // NTRT's hills, shifted so that the halves of the field differ; the field is neither square nor
  // centered. Above the centroid of a triangle, a small ball touches that triangle first. The
  // diagonal of the cell changes this height by as much as 1 cm.
  constexpr double kStep_s = 1e-4, kRadius_m = 0.002, kDrop_m = 0.01;
  HeightFieldDef field =
      SplitTheSame(scenes::Field(40, 30, 0.04, {0, 0, 0}, [](double x, double y) {
        return 0.02 * std::sin(x / 0.04 + 1) * std::cos(y / 0.04 + 2);
      }));
  field.origin_m = {0.3, -0.2, 0.1};
  for (int k = 0; k < 24; ++k) {
    const int i = 3 + 5 * k % 33, j = 2 + 7 * k % 25;
    const auto z = [&](int right, int back) {
      return field.height_m[static_cast<std::size_t>(i + right + (j + back) * field.columns)];
    };
    const bool below = k % 2 == 1;  // below the diagonal, on the side of smaller y
    const double u = below ? 2.0 / 3 : 1.0 / 3, v = 1 - u;
    const double by_x = below ? z(1, 0) - z(0, 0) : z(1, 1) - z(0, 1);
    const double by_y = below ? z(1, 1) - z(1, 0) : z(0, 1) - z(0, 0);
    const double steep = std::hypot(1, by_x / field.cell_m, by_y / field.cell_m);
    const Vec3 touching = field.origin_m + Vec3{(i + u - 0.5 * (field.columns - 1)) * field.cell_m,
                                                (j + v - 0.5 * (field.rows - 1)) * field.cell_m,
                                                z(0, 0) + u * by_x + v * by_y + kRadius_m * steep};
    ModelDef def;
    scenes::AddBall(def, "ball", 1, kRadius_m, touching + Vec3{0, 0, kDrop_m}, {0, 0, 0});
    def.height_fields = {field};
    const auto world = Make(def);
    double at_m = 0, speed = 0;
    for (int step = 0; step < 1000; ++step) {
      at_m = world->Body(0).position_m.z;
      world->Step(kStep_s);
      const double now = world->Body(0).velocity_m_per_s.z;
      if (now > speed - 0.9 * kG * kStep_s) break;
      speed = now;
    }
    // Some engines detect the ground only after penetration, by at most a step's travel.
    EXPECT_NEAR(at_m, touching.z, 1.1 * kStep_s * std::sqrt(2 * kG * kDrop_m)) << i << ' ' << j;
  }
}

TEST_P(GroundOf, OnlyOdesBallRollsOverTrianglesAsOnAPlane) {
  // Ball with 1 m/s for 3 s. The balls of the other engines lose speed by bumps where triangles
  // meet.
  struct Kept {
    double level, slope;
  };
  const Kept kept = Is(Engine::kOde)              ? Kept{1, 1}
                    : Is(Engine::kBullet)         ? Kept{0.955, 0.918}
                    : GetParam().options.elliptic ? Kept{0.802, 0.971}
                                                  : Kept{0.949, 0.988};
  const Material material{0.5, 0.5, 0};
  for (const double angle : {0.0, kSlope}) {
    for (const bool field : {false, true}) {
      const Slope slope{angle};
      constexpr double kRadius_m = 0.05;
      ModelDef def;
      scenes::AddBall(def, "ball", 0.3, kRadius_m, slope.At(-5.5, 0.013) + kRadius_m * slope.Up(),
                      material);
      def.bodies[0].velocity_m_per_s = slope.Down();
      def.bodies[0].angular_velocity_rad_per_s = {0, 1 / kRadius_m, 0};
      slope.AddTo(def, field, material);
      const auto world = Make(def);
      world->Step(1e-3, 3000);
      const double want = 1 + 5.0 / 7 * kG * std::sin(angle) * 3;
      const double share = field ? angle == 0 ? kept.level : kept.slope : 1.0;
      EXPECT_NEAR(Dot(world->Body(0).velocity_m_per_s, slope.Down()) / want, share,
                  share == 1 ? 0.002 : 0.02)
          << angle << (field ? " field" : " plane");
    }
  }
}

TEST_P(GroundOf, ARodLiesOnASlopeOrSlidesDown) {
  // The rod slides along its axis for 1 s. The friction coefficient combines ground and rod.
  const Slope slope{kSlope};
  for (const double mu : {0.5, 0.1}) {
    constexpr double kRadius_m = 0.01;
    ModelDef def;
    const Vec3 middle = slope.At(-0.5, 0.013) + kRadius_m * slope.Up();
    scenes::AddRod(def, "rod", 0.1, kRadius_m, middle - 0.19 * slope.Down(),
                   middle + 0.19 * slope.Down(), {2 * mu, 2 * mu, 0});
    slope.AddTo(def, true, {mu / 2, mu / 2, 0});
    const auto world = Make(def);
    world->Step(1e-3, 1000);
    const double pull = std::sin(kSlope) - mu * std::cos(kSlope);
    const Vec3 way = world->Body(0).position_m - middle;
    EXPECT_NEAR(Dot(way, slope.Down()), pull < 0 ? 0 : kG / 2 * pull, pull < 0 ? 0.002 : 0.01);
    EXPECT_NEAR(Dot(way, slope.Up()), 0, 1e-4);
  }
}

/// Returns the depth of the robot in the ground, by taut's geometry.
double Deepest(WorldBatch& ours, const World& world) {
  for (int b = 0; b < static_cast<int>(ours.model().def().bodies.size()); ++b) {
    ours.SetBodyState(0, b, world.Body(b));
  }
  double deepest_m = 0;
  for (const Overlap& overlap : ours.Overlaps(0)) {
    if (overlap.body_b == kWorld) deepest_m = std::max(deepest_m, overlap.depth_m);
  }
  return deepest_m;
}

TEST_P(GroundOf, ARobotStandsOnHills) {
  // The robot has landed. ODE lets rods sink into ridges. Bullet does not hold them for long: with
  // 50 iterations, after 1.6 s, a rod is 31 mm deep.
  ModelDef def = test::Robot("tetraspine3");
  def.height_fields = {SplitTheSame(scenes::Hills(120, 120, {0.5, 0.5, 0}))};
  def.height_fields[0].origin_m.z = -0.03;
  Diagnostics complaints;
  WorldBatch ours(Model::Compile(def, complaints), {});
  const auto world = Make(def);
  world->Step(1e-3, 600);
  if (Is(Engine::kOde)) {
    EXPECT_NEAR(Deepest(ours, *world), 0.0057, 0.001);
  } else {
    EXPECT_LT(Deepest(ours, *world), 0.001);
  }
  double lowest_m = 1;
  for (int b = 0; b < 3; ++b) lowest_m = std::min(lowest_m, world->Body(b).position_m.z);
  EXPECT_GT(lowest_m, 0.05);
}

std::string GroundCaseName(const testing::TestParamInfo<Setting>& info) {
  return std::string(Name(info.param.engine)) + "_" + info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Peers, GroundOf, testing::ValuesIn(kSettings), GroundCaseName);

}  // namespace
}  // namespace taut::peers
