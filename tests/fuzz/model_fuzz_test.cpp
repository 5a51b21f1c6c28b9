// Model files with random damage: whatever stands in a file, reading it ends, throws nothing and
// gives either a robot or at least one error.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "fuzz/damage.h"
#include "taut/spec.h"

namespace taut {
namespace {

using test::Damage;
using test::Text;

void ReadDamaged(const std::string& model, unsigned count) {
  const std::string good = Text(TAUT_SOURCE_DIR "/models/" + model + ".yaml");
  const std::string path = ::testing::TempDir() + "taut_damaged_" + model + ".yaml";
  unsigned robots = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    std::ofstream(path, std::ios::binary) << Damage(seed).To(good);
    Diagnostics out;
    const auto robot = LoadRobot(path, {}, out);
    ASSERT_EQ(robot.has_value(), out.ok()) << model << " seed " << seed;
    robots += robot.has_value();
    if (!robot) continue;
    for (const BodyDef& body : robot->def.bodies) {
      ASSERT_TRUE(body.fixed || (body.mass_kg > 0 && std::isfinite(body.mass_kg)))
          << model << " seed " << seed;
      ASSERT_TRUE(std::isfinite(body.com_m.x + body.com_m.y + body.com_m.z))
          << model << " seed " << seed;
    }
    for (const CableDef& cable : robot->def.cables) {
      ASSERT_TRUE(cable.rest_length_m > 0 && std::isfinite(cable.rest_length_m))
          << model << " seed " << seed;
    }
  }
  std::remove(path.c_str());
  EXPECT_GT(robots, 0u);         // some damage is harmless: a comment, a number
  EXPECT_LT(robots, count / 2);  // most is not
}

TEST(ModelFuzz, ADamagedSpineIsReadOrRefused) { ReadDamaged("tetraspine3", 800); }
TEST(ModelFuzz, ADamagedPrismIsReadOrRefused) { ReadDamaged("prism3", 800); }
TEST(ModelFuzz, ADamagedPendulumIsReadOrRefused) { ReadDamaged("hanging_mass", 800); }

}  // namespace
}  // namespace taut
