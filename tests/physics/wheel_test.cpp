/// Cable wrapping on frictionless wheels (docs/theory/cables.md, section 4).

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "math/described_path.h"
#include "tests/physics/lanes_alike.h"

namespace taut::test {
namespace {

BodyDef WheelBall(double mass_kg, const Vec3& p, const Vec3& velocity = {}, double inertia = 1e-4) {
  BodyDef body;
  body.mass_kg = mass_kg;
  body.com_m = p;
  body.velocity_m_per_s = velocity;
  body.inertia_kg_m2 = {inertia, inertia, inertia, 0, 0, 0};
  return body;
}

AttachmentDef Round(int body, const Vec3& center, const Vec3& axis, double radius_m,
                    bool counterclockwise, int turns = 0) {
  return {body, center, 0.0, WheelDef{axis, radius_m, counterclockwise, turns}};
}

CableDef WheelCable(std::vector<AttachmentDef> attachments, double stiffness, double rest_length) {
  CableDef cable;
  cable.name = "cable";
  cable.attachments = std::move(attachments);
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = rest_length;
  return cable;
}

double LengthOf(const std::vector<AttachmentDef>& attachments) {
  return math::DescribedPath(WheelCable(attachments, 1, 1)).length_m();
}

TEST(Wheel, APathOfThreeQuartersOfATurnHasTheLengthOfItsTangentsAndArc) {
  const double radius = 0.1;
  const auto length = [&](bool counterclockwise, int turns) {
    return LengthOf({{kWorld, {-0.5, 0, -0.1}},
                     Round(kWorld, {}, {0, 1, 0}, radius, counterclockwise, turns),
                     {kWorld, {-0.1, 0, -0.4}}});
  };
  // The straight path misses the wheel; with a full turn added, three quarters of a turn lie on it.
  EXPECT_NEAR(length(false, 0), 0.5, 1e-15);
  EXPECT_NEAR(length(false, 1), 1.371238898, 5e-10);
  EXPECT_NEAR(length(false, 1), 0.5 + 0.4 + 1.5 * std::numbers::pi * radius, 1e-14);
  EXPECT_NEAR(length(false, 4), 0.5 + 0.4 + 7.5 * std::numbers::pi * radius, 1e-13);
  const double tangents = std::atan(5.0) + std::atan(4.0);
  const double between = std::atan2(0.1, 0.5) + std::atan2(0.1, 0.4);
  EXPECT_NEAR(length(true, 0), 0.9 + radius * (1.5 * std::numbers::pi + between - tangents), 1e-14);
}

/// An oblique path is straight on the unrolled cylinder: the same slope before and behind it.
TEST(Wheel, ASkewPathMeetsTheAxisAtTheSameAngleBeforeAndBehind) {
  const CableDef cable = WheelCable({{kWorld, {-0.3, -0.1, -0.2}},
                                     Round(kWorld, {}, {0, 1, 0}, 0.01, true),
                                     {kWorld, {0.4, 0.15, -0.1}}},
                                    1, 1);
  math::DescribedPath path(cable);
  EXPECT_NEAR(path.wheels()[0].theta, 0.884976, 5e-7);
  EXPECT_NEAR(path.length_m(), 0.820470984681, 5e-13);
  EXPECT_NEAR(path.points()[1].u.y, 0.304703036, 5e-10);
  EXPECT_NEAR(path.points()[3].u.y, path.points()[1].u.y, 1e-15);
  // No neighboring path is shorter: points moved on the cylinder, with the geodesic between them.
  const Vec3 from = path.points()[0].p, to = path.points()[3].p;
  const auto length = [&](double turn_a, double slide_a, double turn_b, double slide_b) {
    const auto moved = [](Vec3 p, double turn, double slide) {
      const double c = std::cos(turn), s = std::sin(turn);
      return Vec3{c * p.x + s * p.z, p.y + slide, c * p.z - s * p.x};
    };
    const Vec3 a = moved(path.points()[1].p, turn_a, slide_a);
    const Vec3 b = moved(path.points()[2].p, turn_b, slide_b);
    const double theta = path.wheels()[0].theta + turn_b - turn_a;
    return Distance(from, a) + std::hypot(0.01 * theta, b.y - a.y) + Distance(b, to);
  };
  EXPECT_NEAR(length(0, 0, 0, 0), path.length_m(), 1e-15);
  for (const double d : {-1e-3, 1e-3}) {
    EXPECT_GT(length(d, 0, 0, 0), path.length_m());
    EXPECT_GT(length(0, d, 0, 0), path.length_m());
    EXPECT_GT(length(0, 0, d, 0), path.length_m());
    EXPECT_GT(length(0, 0, 0, d), path.length_m());
    EXPECT_GT(length(d, d, d, d), path.length_m());
  }
}

TEST(Wheel, TwoThinOnesAreTheEdgesOfAWallThatIsUnfolded) {
  const auto length = [](double radius) {
    return LengthOf({{kWorld, {-0.3, 0, 0.05}},
                     Round(kWorld, {0, 0, 0.06}, {0, 1, 0}, radius, true),
                     Round(kWorld, {0.1, 0, 0.06}, {0, 1, 0}, radius, true),
                     {kWorld, {0.4, 0.1, 0.02}}});
  };
  const auto closed_form = [](double radius) {
    const double before = std::hypot(0.3, 0.01), behind = std::hypot(0.3, 0.04);
    const double theta = std::atan(0.01 / 0.3) + std::asin(radius / before) +
                         std::atan(0.04 / 0.3) + std::asin(radius / behind);
    return std::hypot(std::sqrt(before * before - radius * radius) + 0.1 + radius * theta +
                          std::sqrt(behind * behind - radius * radius),
                      0.1);
  };
  for (const double radius : {1e-2, 1e-4, 1e-9}) {
    EXPECT_NEAR(length(radius), closed_form(radius), 1e-14) << radius;
  }
}

/// Returns Atwood's machine: the masses hang vertically below the sides of one wheel, or of the
/// outer two of several wheels on an arch, so that they move vertically.
ModelDef Atwood(double m1, double m2, int wheels, double stiffness = 1e5) {
  const double arch = 0.1, radius = wheels == 1 ? arch : 0.005;
  std::vector<AttachmentDef> path{{0, {-arch - (wheels == 1 ? 0 : radius), 0, -1}}};
  for (int k = 0; k < wheels; ++k) {
    const double angle = wheels == 1 ? 0 : std::numbers::pi * k / (wheels - 1);
    const Vec3 center =
        wheels == 1 ? Vec3{} : Vec3{-arch * std::cos(angle), 0, arch * std::sin(angle)};
    path.push_back(Round(kWorld, center, {0, 1, 0}, radius, true));
  }
  path.push_back({1, {-path[0].position_m.x, 0, -1}});
  ModelDef def;
  def.bodies = {WheelBall(m1, path.front().position_m), WheelBall(m2, path.back().position_m)};
  const double tension = 2 * m1 * m2 / (m1 + m2) * 9.81;
  def.cables.push_back(WheelCable(path, stiffness, LengthOf(path)));
  def.cables[0].rest_length_m -= tension / stiffness;
  return def;
}

TEST(Wheel, AtwoodsMachineIsThatOfAFreePulleyWhateverItRunsOver) {
  for (const int wheels : {1, 2, 3, 5, 9}) {
    WorldBatch world = MakeBatch(Atwood(1, 0.7, wheels));
    world.Step(1e-3, 400);
    const double fall = 0.5 * 0.3 / 1.7 * 9.81 * 0.4 * 0.4;
    EXPECT_NEAR(world.Body(0, 0).position_m.z, -1 - fall, 1e-11) << wheels;
    EXPECT_NEAR(world.Body(0, 1).position_m.z, -1 + fall, 1e-11) << wheels;
  }
}

TEST(Wheel, ACableWindsOffADrumAndOnToIt) {
  // Three turns about a free drum to whose rim the cable's end is fixed: pulled straight, the drum
  // spins up as under a force at its radius, and all cable unwinds.
  const double radius = 0.05, inertia = 0.002, turns = 3;
  const Vec3 center{0, 0, 0}, end{1, 0, -radius};
  const double wound = 2 * std::numbers::pi * turns;
  // The cable leaves the drum below its center, towards x.
  const Vec3 rim{radius * std::sin(std::numbers::pi + wound), 0,
                 radius * std::cos(std::numbers::pi + wound)};
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {WheelBall(1, center, {}, inertia)};
  std::vector<AttachmentDef> path{
      {kWorld, end}, Round(0, center, {0, 1, 0}, radius, true, 3), {0, rim}};
  ASSERT_NEAR(LengthOf(path), 1 + radius * wound, 1e-13);
  def.cables.push_back(WheelCable(path, 1e3, 1 + radius * wound - 0.03));
  WorldBatch world = MakeBatch(def);
  const Energy before = world.TotalEnergy(0);
  const Vec3 turned = world.AngularMomentum(0);
  double length = 0;
  for (int i = 0; i < 3000; ++i) {
    world.Step(1e-3);
    length = std::max(length, world.Cable(0, 0).length_m);
  }
  EXPECT_LT(length, 1 + radius * wound + 0.031);
  const Energy after = world.TotalEnergy(0);
  EXPECT_NEAR(after.kinetic_j + after.elastic_j, before.elastic_j, 2e-3 * before.elastic_j);
  (void)turned;
}

/// Returns a scene like NTRT's MuscleNP: two bodies in flight on one cable, a free rod in its way.
ModelDef WheelFlight() {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {WheelBall(0.3927, {0, 0, 3}, {0.4, 0, 0.4}, 0.01),
                WheelBall(0.5, {0, 0, 12}, {0.4, 0, 0.4}, 0.01),
                WheelBall(0.4, {-0.6, 0, 8}, {}, 0.05)};
  def.cables.push_back(WheelCable(
      {{0, {0, 0, 4}}, Round(2, {-0.6, 0, 8}, {0, 1, 0}, 0.25, true), {1, {0, 0, 12}}}, 1000, 8));
  return def;
}

TEST(Wheel, MomentaAndEnergyAreKeptInFreeFlightOverAFreeRod) {
  ModelDef def = WheelFlight();
  def.cables[0].attachments[1].wheel->counterclockwise = false;
  def.bodies[0].velocity_m_per_s = {-2, 0.3, 0.4};
  def.bodies[1].velocity_m_per_s = {-1, -0.2, 0.9};
  WorldBatch world = MakeBatch(def);
  const Vec3 p = world.Momentum(0), l = world.AngularMomentum(0);
  const double energy = EnergyOf(world);
  double off = 0, on = 0;
  for (int i = 0; i < 5000; ++i) {
    world.Step(1e-3);
    off = std::max(off, std::fabs(EnergyOf(world) - energy));
    on = std::max(on, Norm(world.Body(0, 2).velocity_m_per_s));
  }
  EXPECT_GT(on, 0.4);  // the cable touched the rod
  EXPECT_LT(Distance(world.Momentum(0), p), 1e-12);
  EXPECT_LT(Distance(world.AngularMomentum(0), l), 1e-11);
  EXPECT_LT(off, 1e-4 * energy);
}

TEST(Wheel, ForcesAreTheSlopesOfTheLength) {
  // Three wheels in a row on bodies at arbitrary poses: minus the derivative of the length by each
  // coordinate of a body equals the force and torque of a unit tension.
  const auto cable_of = [](const Vec3& shift, int which) {
    std::vector<AttachmentDef> path{{0, {-1, 0.1, 0}},
                                    Round(1, {-0.4, 0, 0.3}, {0, 0.8, 0.6}, 0.1, true),
                                    Round(2, {0.1, 0.2, 0.1}, {0.6, 0.8, 0}, 0.2, true),
                                    Round(3, {0.5, 0, -0.3}, {0, 1, 0}, 0.15, false),
                                    {4, {1.2, -0.2, 0.1}}};
    path[static_cast<std::size_t>(which)].position_m =
        path[static_cast<std::size_t>(which)].position_m + shift;
    return WheelCable(path, 1, 1);
  };
  math::DescribedPath path(cable_of({}, 0));
  for (const Wheel<Vec3>& wheel : path.wheels()) EXPECT_GT(wheel.theta, 0.05);
  for (int which = 0; which < 5; ++which) {
    Vec3 pull;
    for (int i = 0; i < path.count(); ++i) {
      if (path.attachment(i) == static_cast<std::size_t>(which))
        pull = pull + PullAt(path.count(), path.points(), i);
    }
    const double d = 1e-6;
    const auto slope = [&](const Vec3& way) {
      return (math::DescribedPath(cable_of(d * way, which)).length_m() -
              math::DescribedPath(cable_of(-d * way, which)).length_m()) /
             (2 * d);
    };
    EXPECT_NEAR(slope({1, 0, 0}), -pull.x, 1e-9) << which;
    EXPECT_NEAR(slope({0, 1, 0}), -pull.y, 1e-9) << which;
    EXPECT_NEAR(slope({0, 0, 1}), -pull.z, 1e-9) << which;
  }
}

/// Rate of the length for sensors, compared with a difference of lengths; also for a wheel on a
/// rotating body.
TEST(Wheel, TheRateIsThatOfTheLength) {
  const double d = 1e-6;
  const auto at = [&](double time_s) {
    ModelDef def;
    def.gravity_m_per_s2 = {};
    const Vec3 center{0.2, 0.1, 0.3};
    def.bodies = {WheelBall(1, center)};
    // The wheel is off the center of its body.
    def.cables.push_back(WheelCable({{kWorld, {-1, 0, 0}},
                                     Round(0, center + Vec3{0.1, 0, 0.2}, {0, 1, 0}, 0.05, true),
                                     {kWorld, {1, 0.2, 0}}},
                                    1e-9, 1));
    WorldBatch world = MakeBatch(def);
    BodyState state = world.Body(0, 0);
    const double turn = 0.5 * 3.0 * time_s;
    state.position_m = state.position_m + time_s * Vec3{0.3, -0.2, 0.4};
    state.velocity_m_per_s = {0.3, -0.2, 0.4};
    state.orientation = {std::cos(turn), 0, std::sin(turn), 0};
    state.angular_velocity_rad_per_s = {0, 3, 0};
    world.SetBodyState(0, 0, state);
    return world.Cable(0, 0);
  };
  const double slope = (at(d).length_m - at(-d).length_m) / (2 * d);
  EXPECT_NEAR(at(0).rate_m_per_s, slope, 1e-8);
  EXPECT_GT(std::fabs(slope), 0.1);
}

TEST(Wheel, AnInterruptedPendulumKeepsItsEnergy) {
  const auto worst = [](double step_s) {
    ModelDef def;
    // Released at the height of the peg, the pendulum comes to rest at this height on the other
    // side, without winding up.
    const Vec3 start{0.8, 0, -0.6};
    def.bodies = {WheelBall(0.2, start)};
    std::vector<AttachmentDef> path{
        {kWorld, {}}, Round(kWorld, {-0.02, 0, -0.6}, {0, 1, 0}, 0.01, true), {0, start}};
    def.cables.push_back(WheelCable(path, 2000, LengthOf(path) - 0.2 * 9.81 * 0.6 / 2000));
    const double fall = 0.2 * 9.81 * 0.6;
    WorldBatch world = MakeBatch(def);
    const double energy = EnergyOf(world);
    double most = 0;
    double off = 0;
    for (int i = 0; i < StepsIn(20, step_s); ++i) {
      world.Step(step_s);
      off = std::max(off, std::fabs(EnergyOf(world) - energy) / fall);
      most = std::max(most, -world.Body(0, 0).position_m.x);
    }
    EXPECT_GT(most, 0.2);  // the peg interrupts it: otherwise it would swing out to 0.8
    EXPECT_LT(most, 0.5);
    return off;
  };
  EXPECT_LT(worst(1e-3), 0.003);
  EXPECT_LT(worst(5e-4), 0.001);
}

TEST(Wheel, LanesAreLikeWorldsAlone) {
  ExpectLanesLikeWorldsAlone(WheelFlight(), {0.02, 0.01, 0.03}, 300);
  ExpectLanesLikeWorldsAlone(Atwood(1, 0.7, 9), {0.002, 0.01, 0.03}, 100);
}

}  // namespace
}  // namespace taut::test
