/// Fixed bodies, node forces, and parameters of a world.

#include <gtest/gtest.h>

#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/hanging_mass.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

TEST(Loads, AFixedBodyHoldsACableAsTheWorldDoes) {
  scenes::HangingMass scene;
  scene.length_m = 1.02;
  ModelDef def = scene.Def();
  WorldBatch by_world = MakeBatch(def);
  BodyDef post;
  post.name = "post";
  post.fixed = true;
  post.com_m = {0.3, -0.2, 0.5};
  post.velocity_m_per_s = {1, 2, 3};  // ignored on a fixed body
  def.bodies.push_back(post);
  def.cables[0].attachments[0].body = 1;
  WorldBatch by_post = MakeBatch(def);
  for (int n = 1; n <= 500; ++n) {
    by_world.Step(1e-3);
    by_post.Step(1e-3);
    // The attachment is 0.5 m from the post's center: that sum is rounded.
    ASSERT_NEAR(by_world.Body(0, 0).position_m.z, by_post.Body(0, 0).position_m.z, RoundOff(n, 1));
  }
  const BodyState still = by_post.Body(0, 1);
  EXPECT_EQ(Distance(still.position_m, post.com_m), 0);
  EXPECT_EQ(Norm(still.velocity_m_per_s), 0);
  EXPECT_EQ(Norm(still.angular_velocity_rad_per_s), 0);
  EXPECT_EQ(still.orientation.w, 1);
  EXPECT_EQ(by_post.TotalEnergy(0).kinetic_j,
            0.25 * by_post.Body(0, 0).velocity_m_per_s.z * by_post.Body(0, 0).velocity_m_per_s.z);
}

TEST(Loads, AFixedBodyDoesNotYieldToForcesAndContacts) {
  ModelDef def;
  const int ball = scenes::AddBall(def, "ball", 0.2, 0.1, {0, 0, 0.2}, {0.5, 0.5, 0});
  const int post = scenes::AddBall(def, "post", 1.0, 0.1, {0, 0, 0}, {0.5, 0.5, 0});
  def.bodies[static_cast<std::size_t>(post)].fixed = true;
  WorldBatch world = MakeBatch(def);
  world.SetNodeForce(0, post, {5, 6, 7});
  world.Step(1e-3, 500);
  EXPECT_EQ(Norm(world.Body(0, post).position_m), 0);
  EXPECT_EQ(Norm(world.Body(0, post).velocity_m_per_s), 0);
  EXPECT_NEAR(world.Body(0, ball).position_m.z, 0.2, 1e-9);  // balanced on top of the post
}

TEST(Loads, AForceOnANodePushesAndTurnsItsBody) {
  // From rest, one step: v = h F / m, w = h I^-1 (r x F), in the axes of an oblique body.
  const Quat askew = scenes::Turn({2.0 / 7, 3.0 / 7, 6.0 / 7}, 0.7);
  const Inertia principal{0.01, 0.02, 0.025, 0, 0, 0};
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  BodyDef body;
  body.name = "body";
  body.mass_kg = 0.8;
  body.com_m = {1, 2, 3};
  body.inertia_kg_m2 = scenes::TurnedInertia(principal, askew);
  def.bodies.push_back(body);
  const Vec3 arm{0.1, -0.2, 0.05};
  def.nodes.push_back({"middle", 0, body.com_m});
  def.nodes.push_back({"end", 0, body.com_m + arm});
  const Vec3 f{3, -1, 2};
  const double h = 1e-3;
  WorldBatch world = MakeBatch(def);
  world.SetNodeForce(0, 1, f);
  world.Step(h);
  const Vec3 torque = Rotate(Conjugate(askew), Cross(arm, f));
  const Vec3 spin = Rotate(askew, {h * torque.x / principal.xx, h * torque.y / principal.yy,
                                   h * torque.z / principal.zz});
  const BodyState state = world.Body(0, 0);
  EXPECT_LE(Distance(state.velocity_m_per_s, (h / 0.8) * f), RoundOff(1, 0.01));
  EXPECT_LE(Distance(world.AngularMomentum(0),
                     h * Cross(arm, f) + Cross(state.position_m, world.Momentum(0))),
            RoundOff(4, 0.1));
  // In the second half of the step the body rotates by h w / 2, which rotates w and redistributes L
  // among moments of inertia with a ratio of 2.5.
  EXPECT_LE(Distance(state.angular_velocity_rad_per_s, spin),
            2.5 * Norm(spin) * (h * Norm(spin) / 2));
  EXPECT_LE(Distance(world.NodeVelocity(0, 1), state.velocity_m_per_s + Cross(spin, arm)),
            2 * h * Norm(spin) * Norm(spin));  // the arm has turned by h w / 2

  // The same force on the center as well, and then none.
  world.SetNodeForce(0, 0, f);
  world.Step(h);
  EXPECT_LE(Distance(world.Momentum(0), (3 * h) * f), RoundOff(2, 0.01));
  world.SetNodeForce(0, 0, {});
  world.SetNodeForce(0, 1, {});
  const Vec3 p = world.Momentum(0), l = world.AngularMomentum(0);
  world.Step(h, 100);
  EXPECT_LE(Distance(world.Momentum(0), p), RoundOff(100, 0.01));
  EXPECT_LE(Distance(world.AngularMomentum(0), l), RoundOff(100, 0.1));
}

TEST(Loads, AForceOnARodsEndDoesTheWorkThatTheRodGains) {
  // The force stays on its node while the rod rotates; its work is F . d, to second order.
  scenes::FreeRod rod;
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    const double h = i == 0 ? 1e-3 : 5e-4;
    WorldBatch world = MakeBatch(rod.Def());
    const Vec3 f{0.01, 0, 0.04}, start = world.NodePosition(0, 1);
    world.SetNodeForce(0, 1, f);
    world.Step(h, StepsIn(0.5, h));
    const double work = Dot(f, world.NodePosition(0, 1) - start);
    errors[i] = world.TotalEnergy(0).kinetic_j / work - 1;
  }
  EXPECT_LT(std::fabs(errors[0]), 1e-4);  // (h w)^2, with w = 10 rad/s
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.2);
}

TEST(Loads, ParametersAreThoseOfOneWorld) {
  scenes::HangingMass scene;
  scene.length_m = 1.02;
  ModelDef def = scene.Def();
  WorldBatchOptions options;
  options.worlds = 3;
  WorldBatch worlds = MakeBatch(def, options);
  worlds.SetParameter(1, Parameter::kBodyMass, 0, 2.0);
  worlds.SetParameter(1, Parameter::kCableStiffness, 0, 700);
  worlds.SetParameter(1, Parameter::kCableDamping, 0, 3);
  worlds.SetParameter(1, Parameter::kGravityX, 0, 0.5);
  worlds.SetParameter(1, Parameter::kGravityY, 0, -0.25);
  worlds.SetParameter(1, Parameter::kGravityZ, 0, -1.62);
  worlds.SetParameter(1, Parameter::kFrictionScale, 0, 0.5);
  EXPECT_EQ(worlds.GetParameter(1, Parameter::kBodyMass, 0), 2);
  EXPECT_EQ(worlds.GetParameter(1, Parameter::kCableStiffness, 0), 700);
  EXPECT_EQ(worlds.GetParameter(1, Parameter::kCableDamping, 0), 3);
  EXPECT_EQ(worlds.GetParameter(1, Parameter::kGravityX, 0), 0.5);
  EXPECT_EQ(worlds.GetParameter(1, Parameter::kGravityY, 0), -0.25);
  EXPECT_EQ(worlds.GetParameter(1, Parameter::kGravityZ, 0), -1.62);
  EXPECT_EQ(worlds.GetParameter(1, Parameter::kFrictionScale, 0), 0.5);
  worlds.Step(1e-3, 200);

  scene.mass_kg = 2;
  scene.stiffness_n_per_m = 700;
  scene.damping_n_s_per_m = 3;
  ModelDef other = scene.Def();
  other.gravity_m_per_s2 = {0.5, -0.25, -1.62};
  WorldBatch alone = MakeBatch(other);
  alone.Step(1e-3, 200);
  EXPECT_EQ(Distance(worlds.Body(1, 0).position_m, alone.Body(0, 0).position_m), 0);
  EXPECT_EQ(Distance(worlds.Body(1, 0).velocity_m_per_s, alone.Body(0, 0).velocity_m_per_s), 0);
  WorldBatch untouched = MakeBatch(def);
  untouched.Step(1e-3, 200);
  EXPECT_EQ(worlds.Hash(0), untouched.Hash(0));
  EXPECT_EQ(worlds.Hash(2), untouched.Hash(0));
  EXPECT_NE(worlds.Hash(1), worlds.Hash(0));
}

TEST(Loads, AnInertiaScalesWithItsMassAndTheSpinStays) {
  scenes::FreeRod rod;
  rod.angular_velocity_rad_per_s = {5, 1, -2};
  // A rounding error of the momentum along the rod is amplified by across / own in its angular
  // velocity.
  const Vec3 along = rod.to_m - rod.from_m;
  const double own = rod.radius_m * rod.radius_m / 2;
  const double across = Dot(along, along) / 12 + own / 2;
  WorldBatch world = MakeBatch(rod.Def());
  const Vec3 l = world.AngularMomentum(0);
  world.SetParameter(0, Parameter::kBodyMass, 0, 3 * rod.mass_kg);
  EXPECT_LE(Distance(world.AngularMomentum(0), 3.0 * l), RoundOff(2, Norm(l)));
  EXPECT_LE(Distance(world.Body(0, 0).angular_velocity_rad_per_s, rod.angular_velocity_rad_per_s),
            RoundOff(2, 10 * across / own));
}

}  // namespace
}  // namespace taut::test
