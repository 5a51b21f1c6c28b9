// Kinematic bodies against closed forms (docs/theory/motion.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/box.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

int Box(ModelDef& def, const std::string& name, double mass_kg, const Vec3& center_m,
        const Vec3& half_m, const Material& material) {
  return scenes::AddBox(def, name, mass_kg, half_m, center_m, {}, material);
}

/// Returns a slab whose upper face is at z = 0, with a motion.
ModelDef Slab(double friction, MotionDef motion) {
  ModelDef def;
  def.friction_combine = CombineRule::kMinimum;
  Box(def, "slab", 1.0, {0, 0, -0.05}, {5, 5, 0.05}, {friction, friction});
  def.bodies[0].fixed = true;
  motion.name = "program", motion.body = 0;
  def.motions.push_back(std::move(motion));
  return def;
}
MotionDef Sliding(const Vec3& direction, TimeLaw law) {
  MotionDef motion;
  motion.direction = direction, motion.slide = std::move(law);
  return motion;
}
MotionDef Turning(TimeLaw law) {
  MotionDef motion;
  motion.turn = std::move(law);
  return motion;
}
TimeLaw Speeds(std::vector<std::pair<double, double>> points) {
  return {std::move(points), 0, 0, 0};
}

TEST(Motion, ATurntableThrowsABlockOffAtTheSpeedWhereFrictionEnds) {
  // mu g = w^2 r: at 7.0036 rad/s, 0.1 m from the axis with a coefficient of 0.5.
  const double limit = std::sqrt(0.5 * kG / 0.1);
  EXPECT_NEAR(limit, 7.0036, 1e-4);
  for (const double share : {0.9995, 1.0005}) {
    ModelDef def = Slab(0.5, Turning(Speeds({{0, 0}, {4, share * limit}})));
    const int block = Box(def, "block", 0.3, {0.1, 0, 0.01}, {0.01, 0.01, 0.01}, {1, 1});
    WorldBatch world = MakeBatch(def);
    double worst = 0;
    for (int n = 0; n < 12000; ++n) {
      world.Step(1e-3);
      ASSERT_EQ(world.Status(0).bits, kStatusOk);
      const double angle = world.Motion(0, 0).turn_rad;
      const Vec3 there{0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.01};
      worst = std::max(worst, Distance(world.Body(0, block).position_m, there));
    }
    if (share < 1) {
      EXPECT_LT(worst, 1e-5);
    } else {
      EXPECT_GT(worst, 0.05);
    }
  }
}

TEST(Motion, ABeltTakesABlockAlong) {
  // From rest to 1 m/s at mu g: the block slips by v^2 / (2 mu g), and friction turns equal parts
  // of the belt's work into heat and into motion.
  ModelDef def = Slab(0.5, Sliding({1, 0, 0}, Speeds({{0, 1}})));
  const int block = Box(def, "block", 0.3, {0, 0, 0.01}, {0.05, 0.05, 0.01}, {1, 1});
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 500; ++n) world.Step(1e-3);
  const BodyState b = world.Body(0, block);
  EXPECT_NEAR(b.velocity_m_per_s.x, 1.0, 1e-9);
  EXPECT_NEAR(world.Motion(0, 0).slide_m - b.position_m.x, 0.101937, 2e-5);
  EXPECT_NEAR(world.Motion(0, 0).work_j, 0.3 * 1.0, 2e-4);
  EXPECT_NEAR(world.Motion(0, 0).force_n.z, 0.3 * kG, 1e-6);
}

TEST(Motion, APlatformLiftsAndItsWorkIsThatOfTheWeight) {
  ModelDef def = Slab(0.5, Sliding({0, 0, 1}, Speeds({{0.2, 0}, {0.7, 1}, {1.2, 1}, {1.7, 0}})));
  const int block = Box(def, "block", 0.3, {0, 0, 0.05}, {0.05, 0.05, 0.05}, {1, 1});
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 450; ++n) world.Step(1e-3);
  EXPECT_NEAR(world.Motion(0, 0).force_n.z, 0.3 * (kG + 2), 1e-5);  // on its way up, 2 m/s^2
  for (int n = 0; n < 1550; ++n) world.Step(1e-3);
  EXPECT_NEAR(world.Motion(0, 0).slide_m, 1.0, 1e-12);
  EXPECT_NEAR(world.Body(0, block).position_m.z, 1.05, 1e-6);
  EXPECT_NEAR(world.Motion(0, 0).work_j, 0.3 * kG, 1e-4);
}

TEST(Motion, AShakerDrivesASpringLikeTheClosedForm) {
  // x'' = w0^2 (y - x), y = A sin(w t), from rest: x = A / (1 - r^2) (sin w t - r sin w0 t), r = w
  // / w0. The shaker's work is the energy of the mass and its spring.
  double error[2] = {}, lost[2] = {};
  for (int k = 0; k < 2; ++k) {
    const double h = k == 0 ? 1e-3 : 0.5e-3, w0 = 20, f = 2, A = 0.01,
                 r = 2 * std::numbers::pi * f / w0;
    ModelDef def = Slab(0.5, Sliding({1, 0, 0}, {{}, A, f, 0}));
    def.boxes[0].collides = false;
    def.gravity_m_per_s2 = {};
    Box(def, "mass", 0.5, {1, 0, 0}, {0.05, 0.05, 0.05}, {});
    JointDef slide;
    slide.name = "slide", slide.kind = JointKind::kPrismatic, slide.axis = {1, 0, 0};
    slide.body_a = 0, slide.body_b = 1, slide.from_m = {0.9, 0, 0}, slide.to_m = {1, 0, 0};
    slide.stiffness = 0.5 * w0 * w0, slide.rest = 0.1;
    def.joints.push_back(slide);
    WorldBatch world = MakeBatch(def);
    for (int n = 1; n <= StepsIn(2, h); ++n) {
      world.Step(h);
      const double t = n * h;
      const double x =
          A / (1 - r * r) * (std::sin(2 * std::numbers::pi * f * t) - r * std::sin(w0 * t));
      error[k] = std::max(error[k], std::fabs(world.Body(0, 1).position_m.x - 1 - x));
      ASSERT_LT(world.Joint(0, 0).gap_m, 1e-10);
      lost[k] = std::max(lost[k], std::fabs(EnergyOf(world) - world.Motion(0, 0).work_j));
    }
  }
  EXPECT_LT(error[0], 2e-5);
  EXPECT_LT(error[1], 0.3 * error[0]);
  EXPECT_LT(lost[0], 2e-5);
  EXPECT_LT(lost[1], 0.3 * lost[0]);
}

TEST(Motion, CablesThatItPullsHaveTheTensionOfTheAcceleration) {
  // Stiff cables are solved implicitly, soft ones are not.
  for (const double stiffness : {200.0, 2e6}) {
    ModelDef def = Slab(0.5, Sliding({0, 0, 1}, Speeds({{1, 0}, {3, 4}})));
    Box(def, "mass", 0.5, {0, 0, -1.1}, {0.05, 0.05, 0.05}, {});
    CableDef cable;
    cable.name = "rope";
    cable.attachments = {{0, {0, 0, -0.1}}, {1, {0, 0, -1.05}}};
    cable.stiffness_n_per_m = stiffness, cable.damping_n_s_per_m = stiffness < 1e3 ? 20 : 100;
    cable.rest_length_m = 0.95 - 0.5 * kG / stiffness;
    def.cables.push_back(cable);
    WorldBatch world = MakeBatch(def);
    for (int n = 0; n < 3000; ++n) {
      world.Step(1e-3);
      ASSERT_EQ(world.Status(0).bits, kStatusOk);
    }
    EXPECT_NEAR(world.Cable(0, 0).tension_n, 0.5 * (kG + 2), 1e-3) << stiffness;
    EXPECT_NEAR(world.Motion(0, 0).force_n.z, 0.5 * (kG + 2), 1e-3) << stiffness;
    const Energy e = world.TotalEnergy(0);
    const double weight = 0.5 * kG * (world.Body(0, 1).position_m.z + 1.1);
    EXPECT_NEAR(world.Motion(0, 0).work_j, e.kinetic_j + weight, 0.03) << stiffness;
  }
}

TEST(Motion, ARodWeldedToATurntableIsHeldByTheForceOfItsCircle) {
  ModelDef def = Slab(0.5, Turning(Speeds({{0, 3}})));
  def.boxes[0].collides = false;
  scenes::AddRod(def, "rod", 0.4, 0.01, {0.2, 0, 0.1}, {0.6, 0, 0.1}, {});
  def.bodies[1].velocity_m_per_s = {0, 0.4 * 3, 0};
  def.bodies[1].angular_velocity_rad_per_s = {0, 0, 3};
  JointDef weld;
  weld.name = "weld", weld.kind = JointKind::kWeld, weld.body_a = 0, weld.body_b = 1;
  weld.from_m = weld.to_m = {0.2, 0, 0.1};
  def.joints.push_back(weld);
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  for (int n = 0; n < 5000; ++n) {
    world.Step(1e-3);
    ASSERT_LT(world.Joint(0, 0).gap_m, 1e-10);
    ASSERT_LE(world.Status(0).linear_solves, 5);
  }
  const Vec3 at = world.Body(0, 1).position_m, force = world.Joint(0, 0).force_n;
  EXPECT_NEAR(std::hypot(at.x, at.y), 0.4, 1e-10);
  EXPECT_NEAR(std::hypot(force.x, force.y), 0.4 * 9 * 0.4, 1e-4);
  EXPECT_NEAR(force.z, 0.4 * kG, 1e-6);
  EXPECT_NEAR(world.Motion(0, 0).work_j, EnergyOf(world) - start, 1e-6);
  EXPECT_NEAR(world.Motion(0, 0).work_j, 0, 1e-5);
  EXPECT_NEAR(world.Motion(0, 0).turn_rad, 15, 1e-12);
}

/// Returns a table that rotates and rises, a heap on it, a rod that hangs from it on a hinge, and a
/// cable.
ModelDef Busy() {
  MotionDef motion = Turning(Speeds({{0, 0}, {0.5, 4}}));
  motion.slide = {{}, 0.01, 3, 0.5};
  ModelDef def = Slab(0.4, motion);
  for (int i = 0; i < 4; ++i) {
    const double x = 0.1 * i;
    Box(def, "box" + std::to_string(i), 0.1, {x, 0.02 * i, 0.03 + 0.05 * i}, {0.03, 0.04, 0.02},
        {0.5, 0.4, 0.2});
  }
  const int rod = scenes::AddRod(def, "rod", 0.2, 0.01, {1, 0, -0.2}, {1, 0, -0.5}, {});
  JointDef hinge;
  hinge.name = "hinge", hinge.kind = JointKind::kHinge, hinge.axis = {0, 1, 0};
  hinge.body_a = 0, hinge.body_b = rod, hinge.from_m = hinge.to_m = {1, 0, -0.2};
  def.joints.push_back(hinge);
  CableDef cable;
  cable.name = "rope";
  cable.attachments = {{0, {0.5, 0, -0.1}}, {rod, {1, 0, -0.5}}};
  cable.stiffness_n_per_m = 3e5, cable.rest_length_m = 0.7;
  def.cables.push_back(cable);
  return def;
}

TEST(Motion, LanesHaveTheBitsOfAWorldAlone) {
  const ModelDef def = Busy();
  for (const int worlds : {2, 4, 8, 11}) {
    WorldBatchOptions options;
    options.worlds = worlds, options.simd = BestSimd();
    WorldBatch together = MakeBatch(def, options);
    for (int w = 0; w < worlds; ++w)
      together.SetParameter(w, Parameter::kBodyMass, 2, 0.1 + 0.02 * w);
    for (int w = 0; w < worlds; ++w) together.SetTime(w, 0.05 * w);
    together.Step(1e-3, 600);
    for (int w = 0; w < worlds; ++w) {
      WorldBatchOptions one;
      one.simd = Simd::kScalar;
      WorldBatch alone = MakeBatch(def, one);
      alone.SetParameter(0, Parameter::kBodyMass, 2, 0.1 + 0.02 * w);
      alone.SetTime(0, 0.05 * w);
      alone.Step(1e-3, 600);
      EXPECT_EQ(alone.Hash(0), together.Hash(w)) << worlds << " " << w;
    }
  }
}

TEST(Motion, ASnapshotGoesOnWithTheSameBits) {
  WorldBatch world = MakeBatch(Busy());
  world.Step(1e-3, 300);
  const auto snapshot = world.Save(0);
  world.Step(1e-3, 300);
  const auto there = world.Hash(0);
  EXPECT_GT(world.Contacts(0).size(), 3u);
  EXPECT_NE(world.Motion(0, 0).work_j, 0);
  ASSERT_TRUE(world.Restore(0, snapshot));
  world.Step(1e-3, 300);
  EXPECT_EQ(world.Hash(0), there);
}

TEST(Motion, BeforeTimeZeroItStandsStill) {
  ModelDef def = Slab(0.5, Sliding({1, 0, 0}, {{{0, 2}}, 0.1, 3, 1}));
  WorldBatch world = MakeBatch(def);
  world.SetTime(0, -0.5);
  world.Step(1e-3, 499);
  EXPECT_EQ(world.Body(0, 0).position_m.x, 0);
  EXPECT_EQ(world.Body(0, 0).velocity_m_per_s.x, 0);
  EXPECT_EQ(world.Motion(0, 0).work_j, 0);
  world.Step(1e-3, 101);
  EXPECT_NEAR(world.Motion(0, 0).slide_m,
              0.2 + 0.1 * (std::sin(0.6 * std::numbers::pi + 1) - std::sin(1.0)), 1e-12);
}

TEST(Motion, WrongOnesAreAllNamed) {
  using testing::AllOf;
  using testing::HasSubstr;
  ModelDef def = Slab(0.5, Sliding({1, 0, 0}, Speeds({{1, 0}, {0.5, 1}})));
  def.motions[0].axis = {0, 0, 2};
  def.motions.push_back(def.motions[0]);
  def.motions[1].slide = {{}, 1, -1, 0};
  def.motions.push_back(def.motions[0]);
  def.motions[2].body = 7;
  Diagnostics out;
  EXPECT_EQ(Model::Compile(def, out), nullptr);
  EXPECT_THAT(out.Format(), AllOf(HasSubstr("times must increase"), HasSubstr("unit vector"),
                                  HasSubstr("already has a motion"), HasSubstr("frequency"),
                                  HasSubstr("does not exist")));
  def = Slab(0.5, {});
  def.bodies[0].fixed = false;
  EXPECT_EQ(Model::Compile(def, out), nullptr);
  EXPECT_THAT(out.Format(), HasSubstr("must be fixed"));
}

}  // namespace
}  // namespace taut::test
