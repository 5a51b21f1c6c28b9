/// Force readings of stiff cables: means over the last step, checked against the change of
/// momentum; before the first step, instantaneous values.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/constants.h"
#include "tests/instruction_sets.h"
#include "tests/physics/world.h"
#include "tests/scenes/hanging_mass.h"

namespace taut::test {
namespace {

constexpr double kMeanStepS = 1e-3;

/// Returns a mass that hangs on a damped cable of 1 m, initially unstretched.
scenes::HangingMass LightMass(double mass_kg, double stiffness_n_per_m, double damping_ratio) {
  scenes::HangingMass scene;
  scene.mass_kg = mass_kg;
  scene.stiffness_n_per_m = stiffness_n_per_m;
  scene.damping_n_s_per_m = 2 * damping_ratio * std::sqrt(stiffness_n_per_m * mass_kg);
  scene.length_m = scene.rest_length_m;
  return scene;
}

double LengthOf(const WorldBatch& world) { return Norm(world.Body(0, 0).position_m); }

/// Returns the instantaneous tension [N] by the law (cables.md, eq. 1).
double AtOnce(const WorldBatch& world, double rest_length_m) {
  const CableState cable = world.Cable(0, 0);
  const double stretch = cable.length_m - rest_length_m;
  if (!(stretch > 0)) return 0;
  return std::max(cable.stiffness_n_per_m * stretch +
                      world.GetParameter(0, Parameter::kCableDamping, 0) * cable.rate_m_per_s,
                  0.0);
}

TEST(MeanTension, IsWhatTheStepGaveToTheMass) {
  for (const double mass : {1e-3, 0.1}) {
    for (const double stiffness : {1e6, 1e7, 1e9}) {
      for (const double ratio : {0.0, 0.05, 0.5, 2.0}) {
        WorldBatch world = MakeBatch(LightMass(mass, stiffness, ratio).Def());
        for (int n = 0; n < 200; ++n) {
          const double before = world.Body(0, 0).velocity_m_per_s.z;
          const double stretch_before = LengthOf(world) - 1;
          world.Step(kMeanStepS);
          const double change = world.Body(0, 0).velocity_m_per_s.z - before;
          const CableState cable = world.Cable(0, 0);
          const double tension = mass * (kG + change / kMeanStepS);
          // The stiffness multiplies the rounding error of the length.
          ASSERT_NEAR(cable.tension_n, tension,
                      SolverError(1) * mass / kMeanStepS + stiffness * RoundOff(1, 1))
              << mass << ' ' << stiffness << ' ' << ratio << ' ' << n;
          // Spring part: stored energy over the displacement of the cable's end. The two stages of
          // damped cables that the step does not resolve (cables.md, 12e) differ from it.
          if (ratio > 0 && stiffness / mass * kMeanStepS * kMeanStepS > 4) continue;
          const double stretch = LengthOf(world) - 1;
          const double a = std::max(stretch_before, 0.0), b = std::max(stretch, 0.0);
          if (std::fabs(stretch - stretch_before) < 1e-12) continue;
          const double elastic = 0.5 * stiffness * (b + a) * ((b - a) / (stretch - stretch_before));
          ASSERT_NEAR(cable.elastic_n, elastic, stiffness * RoundOff(1, 1))
              << mass << ' ' << stiffness << ' ' << ratio << ' ' << n;
        }
      }
    }
  }
}

/// 1 g on 1e7 N/m, half of the critical damping: at rest after 0.06 ms, a sixteenth of a step. The
/// initial vibration in the means decays within forty steps.
TEST(MeanTension, OfALightMassOnAStiffCableIsItsWeightFromTheFirstStepOn) {
  WorldBatch world = MakeBatch(LightMass(1e-3, 1e7, 0.5).Def());
  for (int n = 0; n < 300; ++n) {
    world.Step(kMeanStepS);
    ASSERT_NEAR(world.Cable(0, 0).tension_n, 1e-3 * kG, (n < 50 ? 0.02 : 0.01) * 1e-3 * kG) << n;
  }
}

TEST(MeanTension, BeforeAStepAndAfterAChangeByHandItIsThatOfTheMoment) {
  scenes::HangingMass scene = LightMass(1e-3, 1e7, 0);  // the tension oscillates from step to step
  scene.length_m = scene.rest_length_m + 5e-10;
  const auto change = [&](const char* what, double rest_length_m, const auto& by_hand) {
    WorldBatch world = MakeBatch(scene.Def());
    EXPECT_NEAR(world.Cable(0, 0).tension_n, 5e-3, 1e7 * RoundOff(1, 1)) << "before the first step";
    world.Step(kMeanStepS, 7);
    EXPECT_GT(std::fabs(world.Cable(0, 0).tension_n - AtOnce(world, 1)), 1e-3)
        << "or this tests nothing";
    by_hand(world);
    EXPECT_EQ(world.Cable(0, 0).tension_n, AtOnce(world, rest_length_m)) << what;
    world.Step(kMeanStepS);
    EXPECT_NE(world.Cable(0, 0).tension_n, AtOnce(world, rest_length_m)) << what;
  };
  change("state", 1, [](WorldBatch& world) { world.SetBodyState(0, 0, world.Body(0, 0)); });
  change("rest length", 0.99, [](WorldBatch& world) { world.SetRestLength(0, 0, 0.99); });
  change("stiffness", 1,
         [](WorldBatch& world) { world.SetParameter(0, Parameter::kCableStiffness, 0, 2e7); });
  change("damping", 1,
         [](WorldBatch& world) { world.SetParameter(0, Parameter::kCableDamping, 0, 1); });
  change("mass", 1,
         [](WorldBatch& world) { world.SetParameter(0, Parameter::kBodyMass, 0, 2e-3); });
}

TEST(MeanTension, IsThatOfTheMomentAfterAStepInWhichTheCableIsSoft) {
  WorldBatch world = MakeBatch(LightMass(1e-3, 1e4, 0.05).Def());
  world.Step(kMeanStepS, 5);
  EXPECT_NE(world.Cable(0, 0).tension_n, AtOnce(world, 1));
  world.Step(1e-5, 3);
  EXPECT_EQ(world.Cable(0, 0).tension_n, AtOnce(world, 1));
}

TEST(MeanTension, ComesAlongInASnapshot) {
  const ModelDef def = LightMass(1e-3, 1e7, 0.05).Def();
  for (const auto& [name, simd] : kInstructionSets) {
    WorldBatchOptions options;
    options.worlds = 5;
    options.simd = simd;
    WorldBatch world = MakeBatch(def), other = MakeBatch(def, options);
    world.Step(kMeanStepS, 7);
    other.Step(kMeanStepS, 3);
    const CableState cable = world.Cable(0, 0), neighbour = other.Cable(1, 0);
    ASSERT_TRUE(other.Restore(2, world.Save(0)));
    EXPECT_EQ(other.Cable(2, 0).tension_n, cable.tension_n) << name;
    EXPECT_EQ(other.Cable(2, 0).elastic_n, cable.elastic_n) << name;
    EXPECT_EQ(other.Cable(1, 0).tension_n, neighbour.tension_n) << name;
    world.SetRestLength(0, 0, 0.99);
    ASSERT_TRUE(other.Restore(2, world.Save(0)));
    EXPECT_EQ(other.Cable(2, 0).tension_n, world.Cable(0, 0).tension_n) << name;
    world.Step(kMeanStepS);
    other.Step(kMeanStepS);
    EXPECT_EQ(other.Cable(2, 0).tension_n, world.Cable(0, 0).tension_n) << name;
  }
}

/// A world that is no longer finite returns the values of its last finite state.
TEST(MeanTension, OfAWorldThatIsHaltedIsThatOfTheMoment) {
  WorldBatch world = MakeBatch(LightMass(1e-3, 1e7, 0.05).Def());
  world.Step(kMeanStepS, 7);
  world.SetNodeForce(0, 0, {0, 0, HUGE_VAL});
  world.Step(kMeanStepS);
  ASSERT_NE(world.Status(0).bits & kStatusNonFinite, 0u);
  EXPECT_EQ(world.Cable(0, 0).tension_n, AtOnce(world, 1));
}

}  // namespace
}  // namespace taut::test
