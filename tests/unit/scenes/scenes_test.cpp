/// Scenes shared by tests and benchmarks: properties

#include <gtest/gtest.h>

#include <limits>

#include "math/vec.h"
#include "taut/spec.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::test {
namespace {

double Distance(const Vec3& a, const Vec3& b) { return std::sqrt(Dot(a - b, a - b)); }

TEST(Scenes, TheirTetraspineIsThatOfTheModelFile) {
  Diagnostics complaints;
  const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml", {}, complaints);
  ASSERT_TRUE(robot) << complaints.Format();
  const ModelDef &file = robot->def, scene = scenes::Tetraspine().Def();
  // The same sums in two forms differ by the rounding of numbers of about 1.
  const double rounding = 64 * std::numeric_limits<double>::epsilon();
  ASSERT_EQ(file.bodies.size(), scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    EXPECT_EQ(file.bodies[b].name, scene.bodies[b].name);
    EXPECT_NEAR(file.bodies[b].mass_kg, scene.bodies[b].mass_kg, rounding);
    EXPECT_LE(Distance(file.bodies[b].com_m, scene.bodies[b].com_m), rounding);
    const Inertia &i = file.bodies[b].inertia_kg_m2, &j = scene.bodies[b].inertia_kg_m2;
    EXPECT_NEAR(i.xx, j.xx, rounding);
    EXPECT_NEAR(i.yy, j.yy, rounding);
    EXPECT_NEAR(i.zz, j.zz, rounding);
    EXPECT_NEAR(i.xy, j.xy, rounding);
    EXPECT_NEAR(i.xz, j.xz, rounding);
    EXPECT_NEAR(i.yz, j.yz, rounding);
  }
  ASSERT_EQ(file.nodes.size(), scene.nodes.size());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    EXPECT_EQ(file.nodes[n].body, scene.nodes[n].body);
    EXPECT_LE(Distance(file.nodes[n].position_m, scene.nodes[n].position_m), rounding)
        << file.nodes[n].name << ", " << scene.nodes[n].name;
  }
  EXPECT_EQ(file.spheres.size(), scene.spheres.size());
  EXPECT_EQ(file.capsules.size(), scene.capsules.size());
  ASSERT_EQ(file.cables.size(), scene.cables.size());
  for (const CableDef& cable : scene.cables) {
    std::size_t i = 0;
    while (i < file.cables.size() && file.cables[i].name != cable.name) ++i;
    ASSERT_LT(i, file.cables.size()) << cable.name;
    const CableDef& other = file.cables[i];
    EXPECT_NEAR(other.rest_length_m, cable.rest_length_m, rounding) << cable.name;
    EXPECT_EQ(other.stiffness_n_per_m, cable.stiffness_n_per_m);
    EXPECT_EQ(other.damping_n_s_per_m, cable.damping_n_s_per_m);
    EXPECT_EQ(other.actuator.max_speed_m_per_s, cable.actuator.max_speed_m_per_s);
    EXPECT_EQ(other.actuator.max_force_n, cable.actuator.max_force_n);
    ASSERT_EQ(other.attachments.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(other.attachments[k].body, cable.attachments[k].body) << cable.name;
      EXPECT_LE(Distance(other.attachments[k].position_m, cable.attachments[k].position_m),
                rounding)
          << cable.name;
    }
  }
}

}  // namespace
}  // namespace taut::test
