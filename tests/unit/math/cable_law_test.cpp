// Elastic law of a cable: its members belong to one law, and its callers use it
#include "math/cable_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "taut/statics.h"
#include "taut/world_batch.h"

namespace taut::math {
namespace {

/// A law for this test alone: a hardening spring, F = k s (1 + s / s0).
struct Hardening {
  double stiffness, scale_m;
  double Force(double s) const { return stiffness * s * (1 + s / scale_m); }
  double Slope(double s) const { return stiffness * (1 + 2 * s / scale_m); }
  double Energy(double s) const { return stiffness * s * s * (0.5 + s / (3 * scale_m)); }
  double Stretch(double f) const {
    return 2 * f / (stiffness * (1 + std::sqrt(1 + 4 * f / (stiffness * scale_m))));
  }
};

/// Slope is the derivative of the force, the force that of the energy, and the stretch its inverse.
template <class Law>
void ExpectOneLaw(const Law& law) {
  for (const double s : {1e-6, 0.003, 0.05, 0.4}) {
    const double d = 1e-5 * s;
    const double scale = law.Force(s);
    EXPECT_NEAR((law.Energy(s + d) - law.Energy(s - d)) / (2 * d), scale, 1e-7 * scale);
    EXPECT_NEAR((law.Force(s + d) - law.Force(s - d)) / (2 * d), law.Slope(s), 1e-7 * law.Slope(s));
    EXPECT_NEAR(law.Stretch(law.Force(s)), s, 1e-12 * s);
  }
}

TEST(ElasticLaw, MembersBelongTogether) {
  ExpectOneLaw(CableLaw{740.0});
  ExpectOneLaw(Hardening{740.0, 0.1});
}

TEST(ElasticLaw, StepStaticsAndEnergyUseIt) {
  ModelDef def;
  def.bodies.push_back({});
  BodyDef& ball = def.bodies.back();
  ball.name = "ball";
  ball.mass_kg = 1;
  ball.inertia_kg_m2 = {1, 1, 1};
  ball.com_m = {0, 0, 0};
  def.gravity_m_per_s2 = {};
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{kWorld, {0, 0, 1.25}}, {0, {0, 0, 0}}};
  cable.stiffness_n_per_m = 740;
  cable.rest_length_m = 1;
  def.cables.push_back(cable);
  Diagnostics out;
  const auto model = Model::Compile(def, out);
  ASSERT_TRUE(model) << out.Format();
  const CableLaw law{740.0};
  const WorldBatch batch(model, {});
  EXPECT_EQ(batch.Cable(0, 0).elastic_n, law.Force(0.25));
  EXPECT_EQ(batch.TotalEnergy(0).elastic_j, law.Energy(0.25));
}

}  // namespace
}  // namespace taut::math
