/// Convergence of the contact solver on heaps, wedged bodies and thrown spines; an unconverged
/// solution at least satisfies Coulomb's cone.

#include <gtest/gtest.h>

#include "tests/determinism/variety.h"

namespace taut::test {
namespace {

/// Returns true for a heap driven apart by a jump of the rest length of a cable that is 10^4 times
/// too stiff. Bodies at such speeds cross a whole scene in one step.
bool ShotApart(const WorldBatch& batch) {
  for (int b = 0; b < static_cast<int>(batch.model().def().bodies.size()); ++b) {
    if (Norm(batch.Body(0, b).velocity_m_per_s) > 300) return true;
  }
  return false;
}

TEST(Convergence, RoughWorldsAreSolvedAtEveryStep) {
  int shot_apart = 0;
  for (const ModelDef& def : VariedModels()) {
    for (int seed = 0; seed < 16; ++seed) {
      WorldBatch batch = MakeBatch(def);
      Scatter(batch, 0, seed);
      for (int i = 0; i < kStretches; ++i) {
        Disturb(batch, 0, seed, i);
        for (int k = 0; k < kStepsAStretch; ++k) {
          batch.Step(kVarietyStepS);
          if (ShotApart(batch)) {
            ++shot_apart;
            i = kStretches;
            break;
          }
          ASSERT_LE(batch.Status(0).residual_m_per_s, WorldBatchOptions{}.tolerance_m_per_s)
              << def.name << ", seed " << seed << ", step " << i * kStepsAStretch + k;
        }
      }
    }
  }
  EXPECT_LE(shot_apart, 1);
}

/// The spine of seed 2 falls on its side and wedges its segments into each other; loads shared by
/// ten contacts took thousands of sweeps when each contact was solved separately.
TEST(Convergence, WedgedSegmentsTakeFewSweeps) {
  WorldBatch batch = MakeBatch(scenes::Tetraspine().Def());
  Scatter(batch, 0, 2);
  int most = 0;
  for (int i = 0; i < kStretches; ++i) {
    Disturb(batch, 0, 2, i);
    for (int k = 0; k < kStepsAStretch; ++k) {
      batch.Step(kVarietyStepS);
      most = std::max(most, batch.Status(0).linear_solves);
    }
  }
  EXPECT_GT(most, 32);  // otherwise the test is void: plain Newton ends within twelve
  EXPECT_LE(most, 128);
}

constexpr double kFriction = 0.4;

TEST(Convergence, FrictionOfAnUnfinishedSolveStaysInItsCone) {
  for (const int most_solves : {1, 2, 16}) {
    WorldBatchOptions options;
    options.max_linear_solves = most_solves;
    int unfinished = 0, contacts = 0;
    for (ModelDef def : VariedModels()) {
      const auto rough = [](auto& shapes) {
        for (auto& shape : shapes)
          shape.material = {.static_friction = kFriction, .kinetic_friction = kFriction};
      };
      rough(def.spheres), rough(def.capsules), rough(def.boxes);
      rough(def.planes), rough(def.terrain_boxes);
      def.friction_combine = CombineRule::kGeometricMean;
      for (int seed = 0; seed < 8; ++seed) {
        WorldBatch batch = MakeBatch(def, options);
        Scatter(batch, 0, seed);
        batch.SetParameter(0, Parameter::kFrictionScale, 0, 1);
        for (int k = 0; k < kStretches * kStepsAStretch; ++k) {
          batch.Step(kVarietyStepS);
          if (batch.Status(0).residual_m_per_s <= options.tolerance_m_per_s) continue;
          ++unfinished;
          for (const ContactState& contact : batch.Contacts(0)) {
            const double normal_n = Dot(contact.force_n, contact.normal);
            const double rub_n = Norm(contact.force_n - normal_n * contact.normal);
            ASSERT_GE(normal_n, -1e-9);
            ASSERT_LE(rub_n, kFriction * normal_n + 1e-9 * (1 + normal_n))
                << def.name << ", seed " << seed << ", step " << k;
            ++contacts;
          }
        }
      }
    }
    EXPECT_GT(unfinished, 100) << most_solves << " linear solves";
    EXPECT_GT(contacts, unfinished);
  }
}

}  // namespace
}  // namespace taut::test
