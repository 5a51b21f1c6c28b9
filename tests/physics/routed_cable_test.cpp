/// Routed cables through eyelets: one length, one tension (docs/theory/cables.md).

#include <gtest/gtest.h>

#include "tests/physics/world.h"
#include "tests/scenes/hanging_mass.h"

namespace taut::test {
namespace {

BodyDef PointMass(const std::string& name, double mass_kg, const Vec3& p) {
  BodyDef body;
  body.name = name;
  body.mass_kg = mass_kg;
  body.com_m = p;
  body.inertia_kg_m2 = scenes::SphereInertia(mass_kg, 0.05);
  return body;
}

CableDef CableAlong(std::vector<AttachmentDef> attachments, double stiffness, double rest_length) {
  CableDef cable;
  cable.name = "cable";
  cable.attachments = std::move(attachments);
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = rest_length;
  return cable;
}

/// Checks the equilibrium of a mass that slides without friction on a cable between two points
/// `span` apart, one higher than the other by `rise`. With one tension, both parts make the same
/// angle a with the vertical: sin a = span / l, and 2 T cos a = m g with T = k (l - L) gives the
/// length.
void HangsStill(double span, double rise) {
  const double m = 0.4, g = 9.81, k = 300, rest = 1.3;
  double low = std::hypot(span, rise), high = 10;
  for (int i = 0; i < 200; ++i) {
    const double l = (low + high) / 2;
    const double tension = std::max(k * (l - rest), 0.0);
    (2 * tension * std::sqrt(1 - span * span / (l * l)) < m * g ? low : high) = l;
  }
  const double l = low, cosine = std::sqrt(1 - span * span / (l * l));
  const double left = (l - rise / cosine) / 2;  // (right - left) cos a = rise
  const Vec3 p{left * span / l, 0, -left * cosine};
  ModelDef def;
  def.bodies.push_back(PointMass("mass", m, p));
  def.cables.push_back(
      CableAlong({{kWorld, {0, 0, 0}}, {0, p}, {kWorld, {span, 0, rise}}}, k, rest));
  WorldBatch world = MakeBatch(def);
  EXPECT_NEAR(world.Cable(0, 0).length_m, l, RoundOff(1, l));
  EXPECT_NEAR(world.Cable(0, 0).tension_n, k * (l - rest), RoundOff(1, k));
  world.Step(1e-3, 2000);
  // Only the rounding of lengths of 1 m may move it.
  EXPECT_LE(Distance(world.Body(0, 0).position_m, p), RoundOff(2000, 1));
  // Displaced sideways it is not in equilibrium, which the test detects.
  world.SetBodyState(0, 0, {p + Vec3{0.01, 0, 0}, {}, {}, {}});
  world.Step(1e-3, 100);
  EXPECT_LT(world.Body(0, 0).velocity_m_per_s.x, -1e-3);
}

TEST(RoutedCable, AMassOnACableHangsInTheMiddleOfLevelEyelets) { HangsStill(1.0, 0.0); }

TEST(RoutedCable, AMassOnACableHangsWhereTheAnglesAreEqualBetweenEyeletsOfDifferentHeight) {
  HangsStill(1.0, 0.5);
  HangsStill(0.6, -0.7);
}

/// 1.0 m of cable between supports 0.8 m apart: 3-4-5 triangles at any heights.
TEST(RoutedCable, AHeavyRingHangsOnOneMetreOfCable) {
  const double k = 1e6, tension = 9.81 / (2 * 0.6);
  EXPECT_NEAR(tension, 8.175, 1e-12);
  for (const double rise : {0.0, 0.2}) {
    const double left = (1.0 - rise / 0.6) / 2;  // 1/2, or 1/3
    const Vec3 p{0.8 * left, 0, -0.6 * left};
    ModelDef def;
    def.bodies.push_back(PointMass("ring", 1.0, p));
    def.cables.push_back(
        CableAlong({{kWorld, {0, 0, 0}}, {0, p}, {kWorld, {0.8, 0, rise}}}, k, 1.0 - tension / k));
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3, 2000);
    EXPECT_NEAR(world.Cable(0, 0).tension_n, 8.175, 1e-6) << rise;
    EXPECT_NEAR(Norm(world.Body(0, 0).position_m), left, 1e-9) << rise;
    EXPECT_NEAR(Distance(world.Body(0, 0).position_m, {0.8, 0, rise}), 1.0 - left, 1e-9) << rise;
  }
}

TEST(RoutedCable, AMassOnACableThroughTwoFixedEyeletsIsTheLeapfrogsOscillator) {
  // The mass hangs vertically; the part before the last eyelet only adds to the cable's length.
  const double m = 0.5, k = 400, rest = 2.0, h = 1e-3, a = 0.004;
  const double before = 0.5 + 0.5;  // anchor to eyelet to eyelet
  const double hang = rest + m * 9.81 / k - before;
  const Vec3 p{0.4, 0.3, -(hang + a)};
  ModelDef def;
  def.bodies.push_back(PointMass("mass", m, p));
  def.cables.push_back(CableAlong(
      {{kWorld, {0, 0, 0.5}}, {kWorld, {0, 0, 0}}, {kWorld, {0.4, 0.3, 0}}, {0, p}}, k, rest));
  WorldBatch world = MakeBatch(def);
  const double theta = 2 * std::asin(std::sqrt(k / m) * h / 2);
  for (int n = 1; n <= 3000; ++n) {
    world.Step(h);
    const Vec3 now = world.Body(0, 0).position_m;
    ASSERT_NEAR(-now.z - hang, a * std::cos(n * theta), RoundOff(n, 2));
    ASSERT_EQ(now.x, 0.4);
    ASSERT_EQ(now.y, 0.3);
  }
}

/// Returns two masses on one cable over two eyelets. The tension is equal on both sides, so m1 z1 -
/// m2 z2 falls as (m1 - m2) g t^2 / 2.
ModelDef Atwood(double m1, double m2, double stiffness, double stretch) {
  ModelDef def;
  def.bodies.push_back(PointMass("one", m1, {-0.1, 0, -0.7}));
  def.bodies.push_back(PointMass("two", m2, {0.1, 0, -0.9}));
  // Eyelets straight above the masses keep the motion vertical.
  def.cables.push_back(CableAlong(
      {{0, {-0.1, 0, -0.7}}, {kWorld, {-0.1, 0, 0}}, {kWorld, {0.1, 0, 0}}, {1, {0.1, 0, -0.9}}},
      stiffness, 1.8 - stretch));
  return def;
}

TEST(RoutedCable, BothSidesOfAnEyeletPullEquallyHoweverTheCableSwings) {
  const double m1 = 0.3, m2 = 0.5, g = 9.81;
  WorldBatch world = MakeBatch(Atwood(m1, m2, 500, 0.02));
  for (int n = 1; n <= 400; ++n) {
    world.Step(1e-3);
    const double t = n * 1e-3;
    const double difference =
        m1 * (world.Body(0, 0).position_m.z + 0.7) - m2 * (world.Body(0, 1).position_m.z + 0.9);
    ASSERT_NEAR(difference, (m2 - m1) * g * t * t / 2, RoundOff(n, 2));
  }
}

TEST(RoutedCable, AtwoodsMachineAcceleratesAtItsClosedFormForAnyStiffness) {
  // Started with the tension 2 m1 m2 g / (m1 + m2), the length stays constant and the masses move
  // as on a rigid rope, exactly on parabolas.
  const double m1 = 0.3, m2 = 0.5, g = 9.81;
  const double tension = 2 * m1 * m2 / (m1 + m2) * g, a = (m2 - m1) / (m1 + m2) * g;
  for (const double stiffness : {500.0, 2e4, 1e6}) {
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(Atwood(m1, m2, stiffness, tension / stiffness));
      const int steps = StepsIn(0.4, h);
      world.Step(h, steps);
      // The solver's residual continues as an oscillation at the frequency w of the two masses on
      // the cable.
      const double solved = SolverError(steps), w = std::sqrt(stiffness * (1 / m1 + 1 / m2));
      const double allowed = RoundOff(steps, 2) + solved * 0.4;
      EXPECT_NEAR(world.Body(0, 0).position_m.z + 0.7, a * 0.08, allowed) << stiffness << " " << h;
      EXPECT_NEAR(world.Body(0, 1).position_m.z + 0.9, -a * 0.08, allowed) << stiffness << " " << h;
      EXPECT_NEAR(world.Cable(0, 0).tension_n, tension,
                  RoundOff(steps, stiffness) + stiffness * solved / w);
    }
  }
}

TEST(RoutedCable, ABeadOnATautCableSlidesFreely) {
  // On a straight cable the forces on the bead cancel; a fixed attachment would hold it.
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  def.bodies.push_back(PointMass("bead", 0.1, {0.3, 0, 0}));
  def.bodies[0].velocity_m_per_s = {0.5, 0, 0};
  def.cables.push_back(
      CableAlong({{kWorld, {0, 0, 0}}, {0, {0.3, 0, 0}}, {kWorld, {1, 0, 0}}}, 1000, 0.9));
  WorldBatch world = MakeBatch(def);
  for (int n = 1; n <= 1000; ++n) {
    world.Step(1e-3);
    // Rounding of unit vectors changes T h / m = 1 m/s per step by the same share.
    ASSERT_NEAR(world.Body(0, 0).velocity_m_per_s.x, 0.5, RoundOff(n, 1));
    ASSERT_NEAR(world.Cable(0, 0).tension_n, 100, RoundOff(n, 1000));
  }
  EXPECT_NEAR(world.Body(0, 0).position_m.x, 0.8, RoundOff(1000, 1));
}

TEST(RoutedCable, AnEyeletBesideTheCentreOfMassTurnsItsBody) {
  // T (u2 - u1) acts at the eyelet: with parts of the cable that leave upwards and to the right, T
  // (1, 0, 1).
  const double tension = 12, h = 1e-6;
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  def.bodies.push_back(PointMass("block", 2, {0, 0, 0}));
  def.bodies[0].inertia_kg_m2 = {0.01, 0.02, 0.03, 0, 0, 0};
  const Vec3 eyelet{0.1, 0.05, 0.02};
  def.cables.push_back(
      CableAlong({{kWorld, eyelet + Vec3{0, 0, 1}}, {0, eyelet}, {kWorld, eyelet + Vec3{1, 0, 0}}},
                 1200, 1.99));
  WorldBatch world = MakeBatch(def);
  world.Step(h);
  const Vec3 force{tension, 0, tension}, torque = Cross(eyelet, force);
  const BodyState body = world.Body(0, 0);
  EXPECT_LE(Distance((1 / h) * body.velocity_m_per_s, 0.5 * force), RoundOff(1, 1200));
  // Rates of w, torque / I, are below 120 rad/s^2. In the second half of the step the body rotates
  // by up to 120 h^2 / 2, which rotates w and redistributes L among moments of inertia with a ratio
  // of 3.
  EXPECT_LE(Distance((1 / h) * body.angular_velocity_rad_per_s,
                     {torque.x / 0.01, torque.y / 0.02, torque.z / 0.03}),
            120 * 3 * (120 * h * h / 2));
}

}  // namespace
}  // namespace taut::test
