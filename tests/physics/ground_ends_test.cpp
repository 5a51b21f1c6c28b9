// Shared ends of a body's shapes, and rods over ridges, on height fields (docs/theory/ground.md,
// section 2; docs/theory/contact.md, eq. 12).
#include <gtest/gtest.h>

#include "tests/physics/world.h"
#include "tests/scenes/rod.h"
#include "tests/scenes/rough_ground.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::test {
namespace {

TEST(GroundEnds, ANodeOfSeveralRodsTouchesAFieldOnceAsItDoesAPlane) {
  scenes::Tetraspine spine;
  spine.segments = 2;
  ModelDef on_plane = spine.Def(), on_field = on_plane;
  for (BodyDef& body : on_plane.bodies) body.velocity_m_per_s = {0.2, 0.1, 0};
  on_field.bodies = on_plane.bodies;
  on_field.planes.clear();
  on_field.height_fields.push_back(
      scenes::Field(60, 40, 0.04, spine.ground, [](double, double) { return 0.0; }));
  WorldBatchOptions options;
  options.tolerance_m_per_s = 1e-12;
  WorldBatch plane = MakeBatch(on_plane, options), field = MakeBatch(on_field, options);
  std::size_t most = 0;
  for (int i = 0; i < 300; ++i) {
    plane.Step(1e-3, 1);
    field.Step(1e-3, 1);
    ASSERT_EQ(plane.Contacts(0).size(), field.Contacts(0).size()) << i;
    ASSERT_LE(Distance(plane.Body(0, 0).position_m, field.Body(0, 0).position_m), 1e-9) << i;
    most = std::max(most, field.Contacts(0).size());
  }
  EXPECT_GE(most, 4u);
}

TEST(GroundEnds, ARodOverThreeRidgesIsNotPushedIn) {
  // The middle ridge is higher: the rod lies on it and on one neighbor, close to the third, so that
  // no motion closes all three gaps.
  const Material material{0.5, 0.5, 0};
  const double r = 0.01, higher = 1e-5;
  ModelDef def;
  scenes::AddRod(def, "rod", 0.1, r, {-0.125, 0, r + higher}, {0.12, 0, r + higher}, material);
  def.height_fields.push_back(scenes::Field(7, 5, 0.05, material, [&](double x, double) {
    const int column = static_cast<int>(std::lround(x / 0.05));
    return column == 0 ? higher : column % 2 == 0 ? 0.0 : -0.02;
  }));
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 500);
  int pressing = 0;
  for (int i = 0; i < 20; ++i) {
    world.Step(1e-3, 1);
    for (const ContactState& c : world.Contacts(0)) {
      if (!(c.force_n.z > 0)) continue;
      ++pressing;
      EXPECT_NEAR(c.gap_m, 0.0, 1e-10);
    }
  }
  EXPECT_EQ(pressing, 40);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

}  // namespace
}  // namespace taut::test
