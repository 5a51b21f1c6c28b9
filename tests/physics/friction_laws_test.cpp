/// Velocity-dependent, anisotropic and user-defined friction laws (docs/theory/friction.md) against
/// closed forms.

#include "taut/friction.h"

#include <gtest/gtest.h>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/block_on_slope.h"
#include "tests/scenes/box.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

constexpr double kBlockHeight_m = 0.03;  ///< Height of the block's center above its support.

/// Returns a block on a level or tilted plane, or on a terrain box with the same surface.
ModelDef Block(double angle_rad, const Material& material, bool on_box = false) {
  scenes::BlockOnSlope scene;
  scene.slope.angle_rad = angle_rad;
  scene.slope.material = {1, 1, 0};
  scene.material = material;
  ModelDef def = scene.Def();
  def.friction_combine = CombineRule::kProduct;
  if (on_box) {
    const Vec3 middle = -0.1 * scene.slope.normal();
    def.terrain_boxes.push_back(
        {"slab", middle, scene.slope.orientation(), {20, 20, 0.1}, scene.slope.material});
    def.planes.clear();
  }
  return def;
}
Material Stribeck(double at_rest, double sliding, double speed_m_per_s, double viscous = 0) {
  Material m{at_rest, sliding, 0};
  m.stribeck = StribeckDef{speed_m_per_s, viscous};
  return m;
}
Material Directed(double friction, double forward, double backward, double sideways, Vec3 axis) {
  Material m{friction, friction, 0};
  m.directions = FrictionDirections{forward, backward, sideways, axis};
  return m;
}

// dv/dt = -g (k + (s - k) / (1 + (v / w)^2)). With X = v0 / w it stops after
//   T = w / (g k) (X - (s - k) / sqrt(s k) atan(X sqrt(k / s)))
//   D = w^2 / (g k) (X^2 / 2 - (s - k) / (2 k) ln(1 + k X^2 / s))
TEST(FrictionLaws, ABlockStopsAfterTheTimeAndTheWayOfStribecksCurve) {
  const double s = 0.6, k = 0.2, w = 0.3, v0 = 1.0, x = v0 / w;
  const double time =
      w / (kG * k) * (x - (s - k) / std::sqrt(s * k) * std::atan(x * std::sqrt(k / s)));
  const double way =
      w * w / (kG * k) * (x * x / 2 - (s - k) / (2 * k) * std::log(1 + k * x * x / s));
  for (const double h : kThreeStepsS) {
    ModelDef def = Block(0, Stribeck(s, k, w));
    def.bodies[0].velocity_m_per_s = {v0, 0, 0};
    WorldBatch world = MakeBatch(def);
    int steps = 0;
    while (world.Body(0, 0).velocity_m_per_s.x > 1e-9 && steps < 100000) world.Step(h), ++steps;
    EXPECT_NEAR(steps * h, time, 1.5 * h) << h;
    // Second-order errors of the size h^2 |a'| v0 / 12, with a' = da/dv.
    EXPECT_NEAR(world.Body(0, 0).position_m.x, way, 1.5 * h * h + 1e-9) << h;
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
  }
}

// Without a Stribeck peak, dv/dt = -g (k + c v): v = (v0 + k / c) exp(-g c t) - k / c.
TEST(FrictionLaws, ViscousFrictionIsAnExponential) {
  const double k = 0.1, c = 0.2, v0 = 1.0, time = 0.4;
  for (const double h : kThreeStepsS) {
    ModelDef def = Block(0, Stribeck(k, k, 0.1, c));
    def.bodies[0].velocity_m_per_s = {0, v0, 0};
    WorldBatch world = MakeBatch(def);
    world.Step(h, StepsIn(time, h));
    const double v = (v0 + k / c) * std::exp(-kG * c * time) - k / c;
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.y, v, 3 * h * h) << h;
  }
}

TEST(FrictionLaws, UnderStribecksCurveABlockHoldsUpToTheStaticCoefficientAndThenRunsAway) {
  const Material material = Stribeck(0.5, 0.2, 0.05);
  for (const double share : {0.99, 1.01}) {
    WorldBatch world = MakeBatch(Block(std::atan(share * 0.5), material));
    const Vec3 start = world.Body(0, 0).position_m;
    world.Step(1e-3, 2000);
    const double way = Distance(world.Body(0, 0).position_m, start);
    if (share < 1) {
      EXPECT_LT(way, 1e-8);
    } else {
      EXPECT_GT(way, 0.5);
    }
  }
}

TEST(FrictionLaws, ABlockSlidesDownWithTheCoefficientOfItsDirection) {
  // A constant force: v = g (sin a - mu cos a) t without an error of the scheme.
  const double angle = 0.5, mu = 0.3;
  const scenes::Slope slope{angle, {}};
  struct Way {
    Vec3 axis;
    double factor;
  };
  const Way ways[] = {{slope.downhill(), 0.4}, {-1.0 * slope.downhill(), 1.5}, {{0, 7, 0}, 1.2}};
  for (const Way& way : ways) {
    for (const bool on_box : {false, true}) {
      for (const double h : kThreeStepsS) {
        WorldBatch world = MakeBatch(Block(angle, Directed(mu, 0.4, 1.5, 1.2, way.axis), on_box));
        const int steps = StepsIn(0.5, h);
        world.Step(h, steps);
        const double a = kG * (std::sin(angle) - way.factor * mu * std::cos(angle));
        EXPECT_LE(Distance(world.Body(0, 0).velocity_m_per_s, (0.5 * a) * slope.downhill()),
                  SolverError(steps))
            << way.factor << (on_box ? ", box, " : ", plane, ") << h;
      }
    }
  }
}

TEST(FrictionLaws, WhatGroundSaysOfDirectionsHoldsForWhatSlidesOverIt) {
  // Forward direction of the ground's material: a body slides forward over it like a block with
  // that material slides backward.
  const double angle = 0.5, mu = 0.3, h = 1e-3;
  const scenes::Slope slope{angle, {}};
  for (const double sign : {1.0, -1.0}) {
    ModelDef def = Block(angle, {1, 1, 0});
    def.planes[0].material = Directed(mu, 0.4, 1.5, 1.2, sign * slope.downhill());
    WorldBatch world = MakeBatch(def);
    world.Step(h, 500);
    const double a = kG * (std::sin(angle) - (sign > 0 ? 1.5 : 0.4) * mu * std::cos(angle));
    EXPECT_LE(Distance(world.Body(0, 0).velocity_m_per_s, (0.5 * a) * slope.downhill()),
              SolverError(500));
  }
}

TEST(FrictionLaws, ARodSlidesByItsOwnAxisWithoutSayingWhich) {
  for (const double sign : {1.0, -1.0}) {
    const Vec3 along{0.6, 0.8, 0};
    ModelDef def;
    scenes::AddRod(def, "rod", 0.1, 0.01, Vec3{0, 0, 0.01} - 0.2 * along,
                   Vec3{0, 0, 0.01} + 0.2 * along, Directed(0.2, 0.5, 1.5, 3, {}));
    def.planes.push_back({"ground", {0, 0, 1}, {}, {1, 1, 0}});
    def.friction_combine = CombineRule::kProduct;
    def.bodies[0].velocity_m_per_s = (sign * 1.0) * along;
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3, 300);
    const double v = 1 - kG * 0.2 * (sign > 0 ? 0.5 : 1.5) * 0.3;
    EXPECT_LE(Distance(world.Body(0, 0).velocity_m_per_s, (sign * v) * along), SolverError(300));
  }
}

TEST(FrictionLaws, BetweenTwoAnglesABlockGoesForwardOnly) {
  // Like snakeskin: on a slope between the two friction angles the block sticks backward and slides
  // forward.
  const double angle = std::atan(0.3);
  const scenes::Slope slope{angle, {}};
  for (const double h : kThreeStepsS) {
    for (const bool forward : {true, false}) {
      const Vec3 axis = (forward ? 1.0 : -1.0) * slope.downhill();
      WorldBatch world = MakeBatch(Block(angle, Directed(0.3, 0.5, 1.2, 1, axis)));
      const Vec3 start = world.Body(0, 0).position_m;
      world.Step(h, StepsIn(1, h));
      const double way = Distance(world.Body(0, 0).position_m, start);
      const double free = 0.5 * kG * (std::sin(angle) - 0.15 * std::cos(angle));
      EXPECT_NEAR(way, forward ? free : 0, 1e-8) << h;
    }
  }
}

TEST(FrictionLaws, AskewABlockSlidesAsThePrincipleOfMostDissipationSays) {
  // Friction is the force of greatest dissipation in the ellipse with half axes m1, m2: f = -N
  // (m1^2 v1, m2^2 v2) / |(m1 v1, m2 v2)|. The step is an implicit Euler step; the test solves v' =
  // v - g h f(v') by iteration.
  const double m1 = 0.1, m2 = 0.4, h = 1e-3;
  ModelDef def = Block(0, Directed(0.2, m1 / 0.2, 9, m2 / 0.2, {2, 0, 0}));
  def.bodies[0].velocity_m_per_s = {1, 0.7, 0};
  WorldBatch world = MakeBatch(def);
  double x = 1, y = 0.7;
  for (int n = 0; n < 250; ++n) {
    world.Step(h);
    const double x0 = x, y0 = y;
    for (int i = 0; i < 200; ++i) {
      const double size = std::hypot(m1 * x, m2 * y);
      x = x0 - kG * h * m1 * m1 * x / size;
      y = y0 - kG * h * m2 * m2 * y / size;
    }
    const Vec3 v = world.Body(0, 0).velocity_m_per_s;
    ASSERT_NEAR(v.x, x, SolverError(n + 1)) << n;
    ASSERT_NEAR(v.y, y, SolverError(n + 1)) << n;
  }
  EXPECT_GT(x, 0.5);
  EXPECT_LT(y, 0.12);  // it has turned towards the direction of lower friction
}

TEST(FrictionLaws, TwoBodiesRubByDirectionAndKeepTheirMomentum) {
  // A block on a freely sliding slab: m dv/dt = -mu m g, M dV/dt = mu m g.
  for (const double sign : {1.0, -1.0}) {
    ModelDef def;
    const double m = 0.5, M = 2;
    scenes::AddBox(def, "slab", M, {2, 2, 0.1}, {0, 0, 0.1}, {}, {1, 1, 0});
    scenes::AddBox(def, "block", m, {0.1, 0.06, kBlockHeight_m}, {0, 0, 0.2 + kBlockHeight_m}, {},
                   Directed(0.3, 0.5, 1.5, 1, {1, 0, 0}));
    def.planes.push_back({"ice", {0, 0, 1}, {}, {0, 0, 0}});
    def.friction_combine = CombineRule::kProduct;
    def.bodies[1].velocity_m_per_s = {sign, 0, 0};
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3, 150);
    const double a = kG * 0.3 * (sign > 0 ? 0.5 : 1.5), t = 0.15;
    EXPECT_NEAR(world.Body(0, 1).velocity_m_per_s.x, sign * (1 - a * t), SolverError(150));
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.x, sign * a * t * m / M, SolverError(150));
  }
}

/// User-defined law: mu = base + by_time t + by_place x.
struct OwnLaw final : ContactFriction {
  double base = 0, by_time = 0, by_place = 0;
  double Coefficient(const FrictionContact& c) const noexcept override {
    return base + by_time * c.time_s + by_place * c.point_m.x;
  }
};
WorldBatch WithLaw(const ModelDef& def, const OwnLaw& law) {
  WorldBatchOptions options;
  options.friction = std::make_shared<OwnLaw>(law);
  return MakeBatch(def, options);
}

TEST(FrictionLaws, ALawOfOnesOwnDecidesByTime) {
  OwnLaw law;
  law.base = 0.1, law.by_time = 0.3;
  for (const double h : kThreeStepsS) {
    ModelDef def = Block(0, {0.9, 0.9, 0});
    def.bodies[0].velocity_m_per_s = {1, 0, 0};
    WorldBatch world = WithLaw(def, law);
    const int n = StepsIn(0.4, h);
    world.Step(h, n);
    // Evaluated at the start of each step: sum of h (base + by_time i h).
    const double v = 1 - kG * (law.base * n * h + law.by_time * h * h * n * (n - 1) / 2);
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.x, v, SolverError(n)) << h;
  }
}

TEST(FrictionLaws, ALawOfOnesOwnDecidesByPlace) {
  // The block leans on its front edge: friction acts at the center of pressure, at c mu ahead of
  // the block's center, c the height of the center. mu = (base + k x) / (1 - k c), so x'' = -g mu:
  // x = (v0 / w) sin wt - (base / k) (1 - cos wt), w^2 = g k / (1 - k c).
  OwnLaw law;
  law.base = 0.1, law.by_place = 0.5;
  const double w = std::sqrt(kG * law.by_place / (1 - law.by_place * kBlockHeight_m)), time = 0.3;
  const double x = std::sin(w * time) / w - law.base / law.by_place * (1 - std::cos(w * time));
  for (const double h : kThreeStepsS) {
    ModelDef def = Block(0, {0.9, 0.9, 0});
    def.bodies[0].velocity_m_per_s = {1, 0, 0};
    WorldBatch world = WithLaw(def, law);
    world.Step(h, StepsIn(time, h));
    EXPECT_NEAR(world.Body(0, 0).position_m.x, x, h * h + 1e-9) << h;
  }
}

TEST(FrictionLaws, ALawOfOnesOwnIsToldWhatTouches) {
  struct Witness final : ContactFriction {
    mutable std::vector<FrictionContact> seen;
    double Coefficient(const FrictionContact& c) const noexcept override {
      seen.push_back(c);
      return c.kinetic_friction;
    }
  };
  const auto witness = std::make_shared<Witness>();
  WorldBatchOptions options;
  options.friction = witness;
  ModelDef def = Block(0, {0.3, 0.2, 0});
  def.bodies[0].velocity_m_per_s = {0.5, 0, 0};
  WorldBatch world = MakeBatch(def, options);
  world.Step(1e-3, 2);
  ASSERT_EQ(witness->seen.size(), 8U);
  double pressing = 0;
  for (std::size_t i = 4; i < 8; ++i) {
    const FrictionContact& c = witness->seen[i];
    EXPECT_EQ(c.world, 0);
    EXPECT_EQ(c.time_s, 1e-3);
    EXPECT_EQ(c.body_a, 0);
    EXPECT_EQ(c.body_b, kWorld);
    EXPECT_EQ(c.surface_a.list, ShapeRef::List::kBoxes);
    EXPECT_EQ(c.surface_b.list, ShapeRef::List::kPlanes);
    EXPECT_NEAR(c.point_m.z, 0, 1e-9);
    EXPECT_EQ(c.normal.z, 1);
    EXPECT_NEAR(c.slip_m_per_s.x, 0.5 - 1.5 * kG * 0.2 * 1e-3, 1e-6);  // mean of this step
    EXPECT_EQ(c.static_friction, 0.3);
    EXPECT_EQ(c.kinetic_friction, 0.2);
    pressing += c.normal_force_n;
  }
  EXPECT_NEAR(pressing, kG, 1e-6);
  EXPECT_EQ(witness->seen[0].normal_force_n, 0);
}

TEST(FrictionLaws, BelowZeroIsZeroAndWhatIsNoNumberHaltsTheWorld) {
  OwnLaw law;
  law.base = -3;
  ModelDef def = Block(0, {0.9, 0.9, 0});
  def.bodies[0].velocity_m_per_s = {1, 0, 0};
  WorldBatch slips = WithLaw(def, law);
  slips.Step(1e-3, 100);
  EXPECT_NEAR(slips.Body(0, 0).velocity_m_per_s.x, 1, SolverError(100));
  law.base = std::numeric_limits<double>::quiet_NaN();
  WorldBatch stands = WithLaw(def, law);
  stands.Step(1e-3, 100);
  EXPECT_TRUE(stands.Status(0).bits & kStatusNonFinite);
  EXPECT_TRUE(std::isfinite(stands.Body(0, 0).position_m.x));
}

TEST(FrictionLaws, AWorldHasTheSameBitsInCompanyAsAlone) {
  // Rods with scales and Stribeck's curve on a plane, a box and each other, different in each
  // world.
  ModelDef def;
  Material scales = Directed(0.4, 0.5, 1.5, 1.2, {});
  scales.stribeck = StribeckDef{0.1, 0.05};
  scales.kinetic_friction = 0.3;
  for (int i = 0; i < 3; ++i) {
    scenes::AddRod(def, "rod" + std::to_string(i), 0.1, 0.01, {-0.2, 0.1 * i, 0.011 + 0.02 * i},
                   {0.2, 0.2 - 0.1 * i, 0.03 + 0.02 * i}, scales);
  }
  def.planes.push_back({"ground", {0, 0, 1}, {}, {0.5, 0.5, 0}});
  def.terrain_boxes.push_back({"step", {0.3, 0, 0}, {}, {0.1, 1, 0.02}, scales});
  def.terrain_boxes[0].material.directions->axis = {0, 1, 0};
  OwnLaw law;
  law.base = 0.2, law.by_place = 0.3;
  for (const bool own : {false, true}) {
    WorldBatchOptions options;
    if (own) options.friction = std::make_shared<OwnLaw>(law);
    const auto push = [](WorldBatch& world, int at, int number) {
      for (int body = 0; body < 3; ++body) {
        BodyState s = world.Body(at, body);
        s.velocity_m_per_s = {0.3 * number - 0.9, 0.1 * body, 0};
        s.angular_velocity_rad_per_s = {0, 0, 0.5 * number - body};
        world.SetBodyState(at, body, s);
      }
    };
    options.worlds = 7;
    for (const Simd simd : {Simd::kSse2, Simd::kAvx2, Simd::kAvx512}) {
      options.simd = simd;
      WorldBatch many = MakeBatch(def, options);
      for (int w = 0; w < 7; ++w) push(many, w, w);
      many.Step(1e-3, 400);
      WorldBatchOptions alone = options;
      alone.worlds = 1;
      alone.simd = Simd::kScalar;
      for (int w = 0; w < 7; ++w) {
        WorldBatch one = MakeBatch(def, alone);
        push(one, 0, w);
        one.Step(1e-3, 400);
        EXPECT_EQ(one.Hash(0), many.Hash(w)) << w << " of " << many.lanes() << " lanes";
      }
    }
  }
}

TEST(FrictionLaws, WrongNumbersAreNamed) {
  ModelDef def = Block(0, Directed(0.3, -1, std::nan(""), -2, {}));
  def.boxes[0].material.stribeck = StribeckDef{0, -1};
  def.friction_law = FrictionLaw::kAlongSlip;
  Diagnostics complaints;
  EXPECT_EQ(Model::Compile(def, complaints), nullptr);
  const std::string all = complaints.Format();
  for (const char* what :
       {"box block: Stribeck's speed must be a positive number",
        "box block: viscous friction must be zero or a positive number",
        "box block: forward friction factor must be zero or a positive number",
        "box block: backward friction factor must be zero or a positive number",
        "box block: sideways friction factor must be zero or a positive number",
        "box block: the friction axis must not be zero; only rods have a default axis",
        "box block: directional friction needs FrictionLaw::kCone"}) {
    EXPECT_NE(all.find(what), std::string::npos) << what << "\n" << all;
  }
  def.boxes[0].material.directions->axis = {std::nan(""), 0, 0};
  complaints = {};
  EXPECT_EQ(Model::Compile(def, complaints), nullptr);
  EXPECT_NE(complaints.Format().find("box block: friction axis must be finite"), std::string::npos);
}

}  // namespace
}  // namespace taut::test
