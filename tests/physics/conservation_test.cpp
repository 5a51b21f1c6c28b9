/// Conservation in closed systems: momentum to rounding, energy within bounds and without drift.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/world.h"
#include "tests/scenes/prism3.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::test {
namespace {

/// Returns the model without ground, gravity, dampers and shapes.
ModelDef Closed(ModelDef def) {
  def.gravity_m_per_s2 = {0, 0, 0};
  def.planes.clear();
  def.spheres.clear();
  def.capsules.clear();
  for (CableDef& cable : def.cables) cable.damping_n_s_per_m = 0;
  return def;
}

double TotalOfWorld(const WorldBatch& world) {
  const Energy e = world.TotalEnergy(0);
  return e.kinetic_j + e.elastic_j;
}

/// Runs for 60 s at 1 kHz and checks that momenta are kept and that the energy changes by less than
/// `share` of its initial value.
void KeepsEverything(const ModelDef& def, double share) {
  WorldBatch world = MakeBatch(def);
  const Vec3 p0 = world.Momentum(0), l0 = world.AngularMomentum(0);
  const double start = TotalOfWorld(world), kinetic = world.TotalEnergy(0).kinetic_j;
  ASSERT_GT(kinetic, 0);
  double largest = 0;
  for (int n = 1; n <= 60000; ++n) {
    world.Step(1e-3);
    largest = std::max(largest, std::fabs(TotalOfWorld(world) - start));
  }
  EXPECT_LT(largest, share * start);
  EXPECT_LE(Distance(world.Momentum(0), p0), RoundOff(60000, 1));
  EXPECT_LE(Distance(world.AngularMomentum(0), l0), RoundOff(60000, 1));
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(Conservation, APrismIsInEquilibriumWithItsSelfStress) {
  // The scene's shape and force densities equal the closed form: nothing moves, and there is no
  // other equilibrium nearby to which it could move.
  WorldBatch world = MakeBatch(Closed(scenes::Prism3().Def()));
  for (int c = 0; c < 9; ++c) {
    const CableState cable = world.Cable(0, c);
    const double density = c < 6 ? 100 / std::sqrt(3.0) : 100;
    EXPECT_NEAR(cable.tension_n, density * cable.length_m, RoundOff(1, 1000)) << c;
  }
  world.Step(1e-3, 1000);
  for (int node = 0; node < 6; ++node) {
    EXPECT_LE(Norm(world.NodeVelocity(0, node)), RoundOff(1000, 1)) << node;
  }
}

TEST(Conservation, AFreePrismKeepsMomentumAndEnergyForAMinute) {
  ModelDef def = Closed(scenes::Prism3().Def());
  def.bodies[0].velocity_m_per_s = {0.1, 0.02, -0.03};
  def.bodies[1].angular_velocity_rad_per_s = {1, -2, 0.5};
  KeepsEverything(def, 1e-3);
}

TEST(Conservation, AFreeTetraspineKeepsMomentumAndEnergyForAMinute) {
  ModelDef def = Closed(scenes::Tetraspine().Def());
  def.bodies[0].velocity_m_per_s = {0.05, 0.02, -0.03};
  def.bodies[2].angular_velocity_rad_per_s = {0.3, -0.2, 0.5};
  KeepsEverything(def, 1e-3);
}

TEST(Conservation, ACableThroughEyeletsOnFreeBodiesKeepsMomentum) {
  // Ends and an eyelet off the centers of mass, so that every body rotates.
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const Vec3 centers[3] = {{-0.5, 0, 0}, {0, 0.2, 0.1}, {0.6, -0.1, 0}};
  for (int i = 0; i < 3; ++i) {
    BodyDef body;
    body.name = "body_" + std::to_string(i);
    body.mass_kg = 0.2 + 0.1 * i;
    body.com_m = centers[i];
    body.inertia_kg_m2 = {0.001, 0.002, 0.0025, 0, 0, 0};
    body.velocity_m_per_s = {0.1 * i, 0.2, -0.1 * i};
    def.bodies.push_back(body);
  }
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{0, centers[0] + Vec3{0.05, 0.02, 0}},
                       {1, centers[1] + Vec3{0, 0.03, 0.04}},
                       {2, centers[2] + Vec3{-0.02, 0, 0.05}}};
  cable.stiffness_n_per_m = 200;
  cable.rest_length_m = 1.1;
  def.cables.push_back(cable);
  cable.name = "stiff";
  cable.attachments = {{0, centers[0] + Vec3{0, 0, 0.05}}, {2, centers[2] + Vec3{0, 0, -0.05}}};
  cable.stiffness_n_per_m = 1e6;
  cable.damping_n_s_per_m = 10;
  cable.rest_length_m = 1.09;
  def.cables.push_back(cable);
  WorldBatch world = MakeBatch(def);
  const Vec3 p0 = world.Momentum(0), l0 = world.AngularMomentum(0);
  bool turned = false;
  for (int n = 1; n <= 5000; ++n) {
    world.Step(1e-3);
    // Impulses of k (l - L) h are at most a hundred times the momenta that remain.
    ASSERT_LE(Distance(world.Momentum(0), p0), RoundOff(n, 10));
    ASSERT_LE(Distance(world.AngularMomentum(0), l0), RoundOff(n, 10));
    turned = turned || Norm(world.Body(0, 1).angular_velocity_rad_per_s) > 1;
  }
  EXPECT_TRUE(turned);
}

}  // namespace
}  // namespace taut::test
