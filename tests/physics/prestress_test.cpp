/// Transverse stiffness T / l of a cable under high tension, which no scheme along the cable covers
/// (docs/theory/cables.md, eq. 12).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/physics/world.h"
#include "tests/scenes/solids.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::test {
namespace {

/// Returns a mass of 0.1 kg in the middle of a cable of 2 m with the tension `tension_n`, displaced
/// from the line by `off_m`. It oscillates transversely with w^2 = 2 T / (m l), l = 1 m.
ModelDef Plucked(double tension_n, double off_m) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  BodyDef body;
  body.name = "mass";
  body.mass_kg = 0.1;
  body.com_m = {0, 0, off_m};
  body.inertia_kg_m2 = scenes::SphereInertia(0.1, 0.05);
  def.bodies.push_back(body);
  for (const double end : {-1.0, 1.0}) {
    CableDef cable;
    cable.name = end < 0 ? "left" : "right";
    cable.attachments = {{kWorld, {end, 0, 0}}, {0, body.com_m}};
    cable.stiffness_n_per_m = 1e7;
    cable.rest_length_m = 1 - tension_n / cable.stiffness_n_per_m;
    def.cables.push_back(cable);
  }
  return def;
}

TEST(Prestress, AcrossAStiffCableAMassSwingsByTheMidpointRuleAtAnyTension) {
  // z_n = A cos(n theta), tan(theta / 2) = w h / 2. The tension grows with z^2 / 2, here by 1e-12
  // of a meter: the angle changes by a share of 1e-5 at most, and A is a micrometer.
  const double h = 1e-3, off = 1e-6;
  for (const double share : {1e-4, 0.01, 0.5, 0.99, 1.01, 10.0, 25.0}) {  // (w h)^2 / 4
    const double tension = share * 2 * 0.1 / (h * h), theta = 2 * std::atan(std::sqrt(share));
    WorldBatch world = MakeBatch(Plucked(tension, off));
    for (int n = 1; n <= 1000; ++n) {
      world.Step(h);
      ASSERT_NEAR(world.Body(0, 0).position_m.z, off * std::cos(n * theta), 1e-3 * off)
          << share << ", step " << n;
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
  }
}

/// Returns the same model with damped cables that end at a kinematic body at rest, so that they use
/// the fixed-direction scheme. The dampers do not act on transverse motion.
ModelDef PluckedOfOtherCables(double tension_n, double off_m) {
  ModelDef def = Plucked(tension_n, off_m);
  BodyDef frame = def.bodies[0];
  frame.name = "frame";
  frame.fixed = true;
  frame.com_m = {0, 0, 0};
  def.bodies.push_back(frame);
  MotionDef rest;
  rest.name = "rest";
  rest.body = 1;
  def.motions.push_back(rest);
  for (CableDef& cable : def.cables) {
    cable.attachments[0].body = 1;
    cable.damping_n_s_per_m = 0.2 * std::sqrt(0.1 * cable.stiffness_n_per_m);
  }
  return def;
}

TEST(Prestress, AcrossAStiffCableWithFixedDirectionsAMassSwingsAsTheLeapfrogsClosedFormSays) {
  // z_n = A cos(n theta), cos(theta) = 1 - (w h)^2 / 2, though along the cable the midpoint rule
  // applies.
  const double h = 1e-3, off = 1e-6;
  for (const double share : {1e-4, 0.01, 0.5, 0.99}) {  // of the limit (w h)^2 = 4
    const double tension = share * 2 * 0.1 / (h * h), theta = std::acos(1 - 2 * share);
    WorldBatch world = MakeBatch(PluckedOfOtherCables(tension, off));
    for (int n = 1; n <= 1000; ++n) {
      world.Step(h);
      ASSERT_NEAR(world.Body(0, 0).position_m.z, off * std::cos(n * theta), 1e-3 * off)
          << share << ", step " << n;
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
  }
}

TEST(Prestress, BeyondTheLimitOfFixedDirectionsAPluckedCableSwingsEverWider) {
  // The limit of eq. (12) is sharp: just beyond it the oscillation grows.
  const double h = 1e-3, off = 1e-6;
  WorldBatch world = MakeBatch(PluckedOfOtherCables(1.01 * 2 * 0.1 / (h * h), off));
  double widest = 0;
  for (int n = 0; n < 100; ++n) {
    world.Step(h);
    widest = std::max(widest, std::fabs(world.Body(0, 0).position_m.z));
  }
  EXPECT_GT(widest, 100 * off);
  EXPECT_EQ(world.Status(0).bits, kStatusStepTooLong);
  EXPECT_EQ(world.Status(0).first_time_s, 0);
  EXPECT_GE(world.Status(0).cable, 0);
}

/// Returns Tetraspine3 with cables 10^4 times as stiff and the same rest lengths, with 200 kN in
/// its top cables. Only the cables act.
ModelDef OverwoundSpine() {
  ModelDef def = scenes::Tetraspine().Def();
  def.gravity_m_per_s2 = {0, 0, 0};
  def.planes.clear();
  def.spheres.clear();
  def.capsules.clear();
  for (CableDef& cable : def.cables) {
    cable.stiffness_n_per_m *= 1e4;
    cable.damping_n_s_per_m = 0;
    cable.actuator = {};
  }
  return def;
}

double EnergyOf(const WorldBatch& world) {
  const Energy e = world.TotalEnergy(0);
  return e.kinetic_j + e.elastic_j;
}

TEST(Prestress, ASpineWoundTo200KilonewtonKeepsItsEnergyAtAStepThatResolvesIt) {
  // Its cables snap apart, go slack and become taut again, at 5000 rad/s: w h = 0.05 here.
  WorldBatch world = MakeBatch(OverwoundSpine());
  const double start = EnergyOf(world), h = 1e-5;
  EXPECT_NEAR(world.Cable(0, 2).tension_n, 2e5, 1);
  double worst = 0;
  for (int n = 0; n < StepsIn(1, h); ++n) {
    world.Step(h);
    worst = std::max(worst, std::fabs(EnergyOf(world) - start));
  }
  EXPECT_LT(worst, 1e-3 * start);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(Prestress, ASpineWoundTo200KilonewtonKeepsItsEnergyAtStepsThatDoNotResolveIt) {
  for (const double h : {1e-3, 4e-3}) {
    WorldBatch world = MakeBatch(OverwoundSpine());
    const double start = EnergyOf(world);
    double most = 0;
    for (int n = 0; n < 1000; ++n) {
      world.Step(h);
      most = std::max(most, std::fabs(EnergyOf(world) - start));
    }
    EXPECT_LT(most, 1e-6 * start) << h;
    EXPECT_EQ(world.Status(0).bits, kStatusOk) << h;
  }
}

}  // namespace
}  // namespace taut::test
