/// Capstan friction of cables in contact with terrain and rods (docs/theory/cables.md, section 7).

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "math/described_path.h"
#include "tests/constants.h"
#include "tests/physics/lanes_alike.h"
#include "tests/physics/touch_scenes.h"

namespace taut::test {
namespace {

/// Checks that the spans' rest lengths add up to the rest length of the cable.
void ExpectNothingLost(const WorldBatch& world) {
  double sum = 0;
  for (int i = 0; i < world.CableSpans(0); ++i) sum += world.CableSpan(0, 0, i).rest_length_m;
  ASSERT_NEAR(sum, world.Cable(0, 0).rest_length_m, 1e-12);
}

/// Lowers two bodies from above to both sides of an obstacle, so that their cable lies over it, and
/// stops them.
void Lower(WorldBatch& world, const Vec3& from, const Vec3& to) {
  constexpr double kAbove = 0.2, kBeside = 0.3;
  for (int i = 1; i <= 100; ++i) {
    const double left = 1 - i / 100.0;
    const auto on_the_way = [&](const Vec3& p, double side) {
      return Vec3{p.x + side * kBeside * left, p.y, p.z + (kAbove - p.z) * left};
    };
    Lead(world, 0, on_the_way(from, -1)), Lead(world, 1, on_the_way(to, 1));
    world.Step(kStep);
  }
  for (int b = 0; b < static_cast<int>(world.model().def().bodies.size()); ++b) {
    BodyState state = world.Body(0, b);
    state.velocity_m_per_s = state.angular_velocity_rad_per_s = {};
    world.SetBodyState(0, b, state);
  }
}

/// Returns two masses on a cable over the two edges of a wall: a wrap angle of half a turn in all.
WorldBatch TouchAtwood(double m1, double m2, double friction, double damping,
                       ActuatorDef::Kind actuator = ActuatorDef::Kind::kNone) {
  const double radius = 1e-3;
  const Vec3 from{-radius, 0, -1}, to{0.1 + radius, 0, -1};
  ModelDef def;
  def.bodies = {Ball(m1, {-0.3, 0, 0.2}), Ball(m2, {0.4, 0, 0.2})};
  def.terrain_boxes = {Box({0, -5, -3}, {0.1, 5, 0})};
  CableDef path = Cable({kWorld, from}, {kWorld, to}, 1, 1, radius);
  for (const double x : {0.0, 0.1}) {
    path.attachments.insert(path.attachments.end() - 1,
                            {kWorld, {x, 0, 0}, 0.0, WheelDef{{0, 1, 0}, radius, true, 0}});
  }
  const double length = math::DescribedPath(path).length_m();
  def.cables = {Cable({0, def.bodies[0].com_m}, {1, def.bodies[1].com_m}, 1e5,
                      length - m2 * kG / 1e5, radius)};
  def.cables[0].touch_friction = friction;
  def.cables[0].damping_n_s_per_m = damping;
  def.cables[0].actuator.kind = actuator;
  WorldBatch world = MakeBatch(def);
  Lower(world, from, to);
  return world;
}

TEST(TouchFriction, AtwoodsMachineOverAWallSlipsAsEytelweinSays) {
  const double c = std::exp(0.2 * std::numbers::pi);
  for (const double m2 : {0.4, 0.5, 0.53}) {
    WorldBatch world = TouchAtwood(1, m2, 0.2, 20);
    const double a = (1 - c * m2) / (1 + c * m2) * kG;
    EXPECT_NEAR(-AccelerationOf(world, 0, 0.6), a, 1e-3) << m2;
    ASSERT_EQ(world.CableBends(0, 0), 2);
    EXPECT_NEAR(world.CableSpan(0, 0, 0).tension_n / world.CableSpan(0, 0, 2).tension_n, c, 1e-8);
    ExpectNothingLost(world);
  }
}

TEST(TouchFriction, WithinTheRatioItDoesNotCreep) {
  for (const double m2 : {0.54, 0.7, 0.9}) {
    WorldBatch world = TouchAtwood(1, m2, 0.2, 200);
    world.Step(1e-3, 4000);
    const double z = world.Body(0, 0).position_m.z;
    world.Step(1e-3, 4000);
    EXPECT_NEAR(world.Body(0, 0).position_m.z, z, 1e-9 * 4) << m2;
    EXPECT_NEAR(world.CableSpan(0, 0, 0).tension_n, kG, 1e-7);
    EXPECT_NEAR(world.CableSpan(0, 0, 2).tension_n, m2 * kG, 1e-7);
  }
}

TEST(TouchFriction, WhatItTakesIsWhatIsMissing) {
  WorldBatch world = TouchAtwood(1, 0.4, 0.2, 0);
  const double before = EnergyOf(world) + world.CableFrictionLoss(0, 0);
  world.Step(1e-3, 900);
  const double loss = world.CableFrictionLoss(0, 0);
  EXPECT_GT(loss, 1.0);
  EXPECT_NEAR(EnergyOf(world) + loss, before, 1e-3 * loss);
}

TEST(TouchFriction, WhatIsWoundComesFromTheFirstSpan) {
  WorldBatch world = TouchAtwood(1, 0.7, 0.2, 200, ActuatorDef::Kind::kIdeal);
  world.Step(1e-3, 2000);
  const double left = world.Body(0, 0).position_m.z, right = world.Body(0, 1).position_m.z;
  const double rest = world.Cable(0, 0).rest_length_m;
  for (int i = 1; i <= 1000; ++i) {
    world.SetRestLengthTarget(0, 0, rest - 5e-6 * i);
    world.Step(1e-3);
  }
  world.Step(1e-3, 2000);
  EXPECT_NEAR(world.Body(0, 0).position_m.z - left, 5e-3, 1e-6);
  EXPECT_NEAR(world.Body(0, 1).position_m.z, right, 1e-6);
  ExpectNothingLost(world);
}

/// A cable whose bodies are repositioned has no contacts until it reaches an obstacle again.
TEST(TouchFriction, PutElsewhereItHasOneSpan) {
  WorldBatch world = TouchAtwood(1, 0.4, 0.2, 20);
  world.Step(1e-3, 100);
  ASSERT_EQ(world.CableSpanTensions(0, 0).size(), 3u);
  for (int b = 0; b < 2; ++b) {
    BodyState state = world.Body(0, b);
    state.position_m.z = 0.5;
    world.SetBodyState(0, b, state);
  }
  EXPECT_EQ(world.CableSpanTensions(0, 0).size(), 1u);
  ExpectNothingLost(world);
  EXPECT_EQ(world.CableSpan(0, 0, 0).rest_length_m, world.Cable(0, 0).rest_length_m);
  world.Step(1e-3, 10);
  ExpectNothingLost(world);
}

/// A rod on an axle that a cable wraps from above, with so much friction that it does not slip.
TEST(TouchFriction, ARodThatTurnsCarriesTheCableAlong) {
  const double radius = 0.05, inertia = 0.002, m2 = 0.7;
  const Vec3 from{-radius, 0, -1}, to{radius, 0, -1};
  ModelDef def;
  def.bodies = {Ball(1, {-0.3, 0, 0.2}), Ball(m2, {0.3, 0, 0.2})};
  AddRod(def, {}, 0.3, radius - 1e-3, 1);
  def.bodies[2].inertia_kg_m2 = {1, inertia, 1, 0, 0, 0};
  const double length = 2 + std::numbers::pi * radius;
  def.cables = {Cable({0, {-0.3, 0, 0.2}}, {1, {0.3, 0, 0.2}}, 1e5, length - 0.8 * kG / 1e5, 1e-3)};
  def.cables[0].touches = CableTouches::kRods;
  def.cables[0].touch_friction = 1;
  def.cables[0].damping_n_s_per_m = 20;
  JointDef axle;
  axle.name = "axle";
  axle.kind = JointKind::kHinge;
  axle.body_a = kWorld;
  axle.body_b = 2;
  axle.axis = {0, 1, 0};
  def.joints.push_back(axle);
  WorldBatch world = MakeBatch(def);
  Lower(world, from, to);
  ASSERT_EQ(world.CableBends(0, 0), 1);
  const double a = (1 - m2) * kG / (1 + m2 + inertia / (radius * radius));
  EXPECT_NEAR(-AccelerationOf(world, 0, 0.6), a, 1e-3);
  EXPECT_NEAR(world.Body(0, 2).angular_velocity_rad_per_s.y * radius,
              world.Body(0, 0).velocity_m_per_s.z, 1e-3);
  ExpectNothingLost(world);
}

/// A ridge along y and a cable over it whose ends, too heavy to be slowed, move along the ridge.
struct Across {
  static constexpr double kSpeed = 0.05, kRadius = 1e-4, kFriction = 0.3;
  const Vec3 from{-0.2, 0, -0.1}, to{0.2, 0, -0.1};
  /// Tangent length from an end to the ridge, wrap angle at the ridge, and lag of the bend.
  const double far_m = std::sqrt(0.2 * 0.2 + 0.1 * 0.1 - kRadius * kRadius);
  const double theta =
      2 * std::numbers::pi - 2 * std::atan2(0.2, 0.1) - 2 * std::atan2(far_m, kRadius);
  const double trails_m = far_m * std::tan(std::asin(0.5 * kFriction * theta));
  ModelDef def;

  Across() {
    def.gravity_m_per_s2 = {};
    def.bodies = {Ball(1e13, from, {0, kSpeed, 0}), Ball(1e13, to, {0, kSpeed, 0})};
    TerrainBoxDef ridge = Box({-1, -9, -1 - std::sqrt(2.0)}, {1, 9, 1 - std::sqrt(2.0)});
    ridge.orientation = {std::cos(std::numbers::pi / 8), 0, std::sin(std::numbers::pi / 8), 0};
    def.terrain_boxes = {ridge};
    def.cables = {Cable({0, from}, {1, to}, 1000, 0.4, kRadius)};
    def.cables[0].touch_friction = kFriction;
  }
};

/// Both parts pull with T sin b along the ridge, against the friction mu T theta.
TEST(TouchFriction, AcrossItSticksAndThenTrailsBehind) {
  const Across across;
  WorldBatch world = MakeBatch(across.def);
  const auto at_middle = [&] { return world.Body(0, 0).position_m.y - 0.5e-3 * Across::kSpeed; };
  const auto bend_y = [&] {
    const std::vector<Vec3> places = world.CableBendPlaces(0, 0);
    return places.size() == 1 ? places[0].y : 1e300;
  };
  world.Step(1e-3);
  const double first = bend_y();
  EXPECT_NEAR(first, at_middle(), 1e-12);
  while (at_middle() < first + 0.99 * across.trails_m) world.Step(1e-3);
  EXPECT_NEAR(bend_y(), first, 1e-12);
  const double tension = world.CableSpan(0, 0, 0).tension_n;
  while (at_middle() < first + 1.1 * across.trails_m) world.Step(1e-3);
  const double loss = world.CableFrictionLoss(0, 0), went = at_middle();
  while (at_middle() < first + 3 * across.trails_m) {
    world.Step(1e-3);
    ASSERT_NEAR(at_middle() - bend_y(), across.trails_m, 1e-9);
  }
  EXPECT_NEAR(world.CableWrap(0, 0), across.theta, 1e-9);
  EXPECT_NEAR(world.CableSpan(0, 0, 1).tension_n, world.CableSpan(0, 0, 0).tension_n, 1e-9);
  EXPECT_NEAR(world.CableSpan(0, 0, 0).tension_n, tension, 2e-3 * tension);
  const double force = Across::kFriction * across.theta * world.CableSpan(0, 0, 0).tension_n;
  EXPECT_NEAR((world.CableFrictionLoss(0, 0) - loss) / (at_middle() - went), force, 1e-3 * force);
}

/// A cable crosses both edges of a wall obliquely; then one end rises until the cable leaves the
/// first edge, and descends again: the contact at the second edge keeps its position.
TEST(TouchFriction, WhatIsHeldStaysWhereOtherBendsComeAndGo) {
  for (const bool first : {true, false}) {
    const Vec3 from{-0.3, 0, -0.1}, to{0.4, 0, -0.1};
    ModelDef def;
    def.gravity_m_per_s2 = {};
    def.bodies = {Ball(1e13, from), Ball(1e13, to)};
    def.terrain_boxes = {Box({0, -5, -3}, {0.1, 5, 0})};
    def.cables = {Cable({0, from}, {1, to}, 1000, 0.6, 1e-3)};
    def.cables[0].touch_friction = 0.5;
    WorldBatch world = MakeBatch(def);
    const auto go = [&](int body, const Vec3& velocity, int steps, int* fewest) {
      BodyState state = world.Body(0, body);
      state.velocity_m_per_s = velocity;
      world.SetBodyState(0, body, state);
      const auto there = [&] {
        const std::vector<Vec3> places = world.CableBendPlaces(0, 0);
        return first ? places.front() : places.back();
      };
      Vec3 last = there();
      for (int i = 0; i < steps; ++i) {
        world.Step(1e-3);
        ASSERT_LT(std::fabs(there().y - last.y), 1e-3) << i;
        last = there();
        *fewest = std::min(*fewest, world.CableBends(0, 0));
        ExpectNothingLost(world);
      }
      state = world.Body(0, body);
      state.velocity_m_per_s = {};
      world.SetBodyState(0, body, state);
    };
    world.Step(1e-3);
    int fewest = 2;
    const int moves = first ? 1 : 0;  // end beyond the edge that the cable leaves
    go(moves, {0, first ? -0.1 : 0.1, 0}, 2000, &fewest);
    ASSERT_EQ(fewest, 2);
    const std::vector<Vec3> askew = world.CableBendPlaces(0, 0);
    EXPECT_GT(std::fabs(askew[1].y - askew[0].y), 0.01);
    go(moves, {0, 0, 0.2}, 1000, &fewest);
    EXPECT_EQ(fewest, 1);
    go(moves, {0, 0, -0.2}, 1000, &fewest);
    EXPECT_EQ(world.CableBends(0, 0), 2);
  }
}

/// A cable that slips over the edge and along it at the same time: friction opposes the resulting
/// slip.
TEST(TouchFriction, WhereItSlipsFrictionIsAgainstItsWay) {
  Across across;
  const double runs = 0.03, aside = 0.02, far = std::hypot(0.2, 0.1);
  across.def.bodies[0].velocity_m_per_s = {0.2 / far * runs, aside, 0.1 / far * runs};
  across.def.bodies[1].velocity_m_per_s = {0.2 / far * runs, aside, -0.1 / far * runs};
  WorldBatch world = MakeBatch(across.def);
  world.Step(1e-3, 2000);
  const double loss = world.CableFrictionLoss(0, 0);
  world.Step(1e-3, 100);
  ASSERT_EQ(world.CableBends(0, 0), 1);
  const double c = std::exp(Across::kFriction * across.theta);
  const double before = world.CableSpan(0, 0, 0).tension_n;
  const double behind = world.CableSpan(0, 0, 1).tension_n;
  EXPECT_NEAR(behind / before, c, 1e-3);
  const std::vector<CablePoint> path = world.CablePath(0, 0);
  ASSERT_EQ(path.size(), 4u);
  // Force of the cable along the edge, at the mean tension.
  const auto rise = [&](std::size_t i) {
    const Vec3 way = path[i].position_m - path[i - 1].position_m;
    return way.y / std::sqrt(Dot(way, way));
  };
  const double force = 0.5 * (before + behind) * (rise(3) - rise(1));
  const double expected = Across::kFriction * across.theta * 0.5 * (before + behind) *
                          std::sin(std::atan(aside / runs));
  EXPECT_NEAR(force, expected, 0.02 * expected);
  const double power = (behind - before) * runs + force * aside;
  EXPECT_NEAR((world.CableFrictionLoss(0, 0) - loss) / 0.1, power, 0.02 * power);
}

TEST(TouchFriction, AFlightKeepsMomentaAndEnergyOnlyFalls) {
  ModelDef def = Flight();
  def.cables[0].touch_friction = 0.3;
  WorldBatch world = MakeBatch(def);
  const double energy = EnergyOf(world);
  const Vec3 momentum = world.Momentum(0), angular = world.AngularMomentum(0);
  int touched = 0;
  for (int i = 0; i < 10000; ++i) {
    world.Step(1e-3);
    touched += world.CableBends(0, 0);
    ASSERT_LT(Distance(world.Momentum(0), momentum), 1e-12) << i;
    ASSERT_LT(Distance(world.AngularMomentum(0), angular), 1e-10) << i;
    ASSERT_NEAR(EnergyOf(world) + world.CableFrictionLoss(0, 0), energy, 2e-4 * energy) << i;
    ExpectNothingLost(world);
  }
  EXPECT_GT(touched, 100);
  EXPECT_GT(world.CableFrictionLoss(0, 0), 3e-4);
}

/// Also on a thick obstacle: obliquely over a rod, like over a wheel.
TEST(TouchFriction, WithHardlyAnyItLiesAsWithout) {
  const Vec3 from{-0.3, -0.1, -0.2}, to{0.4, 0.25, -0.1}, up{0, 0, 1};
  double length[2];
  for (const double friction : {0.0, 1e-12}) {
    ModelDef def = OverARod(from + up, to + up, 0.1, 0.001);
    def.cables[0].touch_friction = friction;
    WorldBatch world = MakeBatch(def);
    for (int i = 0; i <= 100; ++i) {
      Lead(world, 0, from + (1 - 0.01 * i) * up);
      Lead(world, 1, to + (1 - 0.01 * i) * up);
      world.Step(kStep);
    }
    Lead(world, 0, from), Lead(world, 1, to);
    world.Step(kStep);
    ASSERT_EQ(world.CableBends(0, 0), 1);
    length[friction > 0] = world.Cable(0, 0).length_m;
  }
  EXPECT_NEAR(length[0], length[1], 1e-12);
}

TEST(TouchFriction, HardlyAnyIsNone) {
  ModelDef def = Flight();
  WorldBatch without = MakeBatch(def);
  def.cables[0].touch_friction = 1e-12;
  WorldBatch with = MakeBatch(def);
  without.Step(1e-3, 4000), with.Step(1e-3, 4000);
  EXPECT_LT(Distance(without.Body(0, 2).position_m, with.Body(0, 2).position_m), 1e-4);
  EXPECT_GT(Distance(without.Body(0, 2).position_m, def.bodies[2].com_m), 0.05);
}

TEST(TouchFriction, LanesAreLikeWorldsAlone) {
  ModelDef flight = Flight();
  flight.cables[0].touch_friction = 0.3;
  ExpectLanesLikeWorldsAlone(flight, {0.02, 0.01, 0.03}, 2000);
  ModelDef wall;
  const Vec3 from{-0.3, 0, 0.1}, to{0.4, 0.1, 0.07};
  wall.bodies = {Ball(1, from), Ball(1, to)};
  wall.terrain_boxes = {Box({0, -1, -1}, {0.1, 1, 0.06})};
  wall.cables = {Cable({0, from}, {1, to}, 1000, Distance(from, to), 1e-3)};
  wall.cables[0].touch_friction = 0.2;
  ExpectLanesLikeWorldsAlone(wall, {0.01, 0.01, 0.02}, 300);
}

}  // namespace
}  // namespace taut::test
