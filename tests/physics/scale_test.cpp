/// Scale invariance: a robot and a scale model by Froude's rules behave alike. Hence no constant of
/// the step has the dimension of a length or a speed.

#include <gtest/gtest.h>

#include "tests/physics/world.h"
#include "tests/scenes/prism3.h"

namespace taut::test {
namespace {

/// Returns the model with lengths scaled by s, masses by s^3, times by sqrt(s): gravity and strains
/// stay the same.
ModelDef Scaled(ModelDef def, double s) {
  const double area = s * s, volume = s * s * s;
  for (BodyDef& body : def.bodies) {
    body.com_m = s * body.com_m;
    body.mass_kg *= volume;
    Inertia& j = body.inertia_kg_m2;
    for (double* x : {&j.xx, &j.yy, &j.zz, &j.xy, &j.xz, &j.yz}) *x *= volume * area;
  }
  for (SphereDef& sphere : def.spheres) {
    sphere.center_m = s * sphere.center_m;
    sphere.radius_m *= s;
  }
  for (CapsuleDef& capsule : def.capsules) {
    capsule.from_m = s * capsule.from_m;
    capsule.to_m = s * capsule.to_m;
    capsule.radius_m *= s;
  }
  for (NodeDef& node : def.nodes) node.position_m = s * node.position_m;
  for (CableDef& cable : def.cables) {
    for (AttachmentDef& at : cable.attachments) at.position_m = s * at.position_m;
    cable.rest_length_m *= s;
    cable.stiffness_n_per_m *= area;
    cable.damping_n_s_per_m *= area * std::sqrt(s);
  }
  for (PlaneDef& plane : def.planes) plane.point_m = s * plane.point_m;
  return def;
}

TEST(Scale, APrismDropsBouncesAndComesToRestAlikeFromATenthOfAMillimetreToAHundredMetres) {
  scenes::Prism3 scene;
  scene.damping_n_s_per_m = 10;
  ModelDef def = scene.Def();
  for (BodyDef& body : def.bodies) body.velocity_m_per_s = {0.2, -0.1, -1};
  PlaneDef ground;
  ground.name = "ground";
  ground.material = {0.5, 0.5, 0.3};
  ground.point_m = {0, 0, -0.3};
  def.planes = {ground};
  Vec3 expected;
  for (const double s : {1.0, 1e-4, 1e-3, 1e-2, 100.0}) {
    ModelDef scaled = Scaled(def, s);
    for (BodyDef& body : scaled.bodies)
      body.velocity_m_per_s = std::sqrt(s) * body.velocity_m_per_s;
    WorldBatch world = MakeBatch(scaled);
    world.Step(1e-3 * std::sqrt(s), 1500);
    const Vec3 place = (1 / s) * world.Body(0, 0).position_m;
    if (s == 1) expected = place;
    EXPECT_LE(Distance(place, expected), 1e-8) << s;
    EXPECT_EQ(world.Status(0).bits, kStatusOk) << s;
  }
}

}  // namespace
}  // namespace taut::test
