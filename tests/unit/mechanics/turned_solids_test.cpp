// Masses with given inertia, and boxes rotated in their part: read, moved, written
#include <cmath>

#include "math/vec.h"
#include "mechanics/mass_properties.h"
#include "taut/statics.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

class TurnedSolids : public ExperimentFolder {
 protected:
  std::optional<RobotSpec> Read(const std::string& yaml, Diagnostics& out) const {
    Write("robot.yaml", "taut: 1\nkind: model\nname: robot\n" + yaml);
    return LoadRobot(Path("robot.yaml"), {}, out);
  }
  RobotSpec Good(const std::string& yaml) const {
    Diagnostics out;
    const auto robot = Read(yaml, out);
    EXPECT_TRUE(robot) << out.Format();
    return robot.value_or(RobotSpec{});
  }
  std::string Bad(const std::string& yaml) const {
    Diagnostics out;
    EXPECT_FALSE(Read(yaml, out));
    return out.Format();
  }
  /// Writes the robot and reads it back; ModelYaml compares the two.
  std::string Written(const RobotSpec& robot) const {
    Diagnostics out;
    const auto text = ModelYaml(robot, "", out);
    EXPECT_TRUE(text) << out.Format();
    return text.value_or("");
  }
};

void ExpectSame(const Inertia& a, const Inertia& b) {
  const double t = 1e-14 * (a.xx + a.yy + a.zz);
  EXPECT_NEAR(a.xx, b.xx, t);
  EXPECT_NEAR(a.yy, b.yy, t);
  EXPECT_NEAR(a.zz, b.zz, t);
  EXPECT_NEAR(a.xy, b.xy, t);
  EXPECT_NEAR(a.xz, b.xz, t);
  EXPECT_NEAR(a.yz, b.yz, t);
}

constexpr const char* kPart = R"(
parts:
  foot:
    nodes: {a: [0, 0, 0], b: [0.4, 0, 0]}
    pairs: [{nodes: [a, b], tags: [rod]}]
structure: [{part: foot, rotate: {axis: x, angle_rad: pi / 2}}]
)";

/// A quarter turn about x maps z to y: yy and zz are exchanged, xy becomes xz, xz minus xy.
TEST_F(TurnedSolids, AnInertiaIsInItsPartsAxes) {
  const RobotSpec robot =
      Good(std::string(kPart) +
           "builders: [{match: rod, rod: {radius_m: 0.01, mass_kg: 0}}, {match: a, "
           "point_mass: {mass_kg: 2, inertia_kg_m2: [0.2, 0.3, 0.4, 0.01, 0.02, 0.03]}}]\n");
  ASSERT_EQ(robot.def.bodies.size(), 1u);
  EXPECT_EQ(robot.def.bodies[0].mass_kg, 2);
  ExpectSame(robot.def.bodies[0].inertia_kg_m2, {0.2, 0.4, 0.3, -0.02, 0.01, -0.03});
  EXPECT_NE(Written(robot).find("inertia_kg_m2: ["), std::string::npos);
}

TEST_F(TurnedSolids, APlacedRobotIsWrittenAsItIs) {
  Good(std::string(kPart) +
       "builders: [{match: rod, rod: {radius_m: 0.01, mass_kg: 0}}, {match: a, "
       "point_mass: {mass_kg: 2, inertia_kg_m2: [0.2, 0.3, 0.4]}}]\n");
  Write("placed.yaml",
        "taut: 1\nkind: experiment\nname: placed\nmodel: robot.yaml\nduration_s: 1\nplace: {at_m: "
        "[1, 2, "
        "3], rotate: {axis: [1, 2, 3], angle_rad: 0.7}}\n");
  Written(Load("placed.yaml").robot);
}

TEST_F(TurnedSolids, ABoxMayBeTurned) {
  const std::string box =
      "nodes: {a: [0, 0, 1], b: [1, 0, 1]}\npairs: [{nodes: [a, b]}]\nbuilders:\n  - {match: a, "
      "box: "
      "{half_extents_m: [0.1, 0.2, 0.3], rotate: {axis: [1, 1, 0], angle_rad: 0.8}, mass_kg: 1}}\n "
      " - "
      "{match: b, box: {size_m: [0.1, 0.2, 0.3], mass_kg: 1}}\n  - {match: [a-b], cable: "
      "{stiffness_n_per_m: 100, prestress_n: 1}}\n";
  const RobotSpec robot = Good(box);
  const BoxDef& turned = robot.def.boxes[0];
  const double s = std::sin(0.4) / std::sqrt(2.0);
  const Quat want{std::cos(0.4), s, s, 0};
  EXPECT_NEAR(turned.orientation.w, want.w, 1e-15);
  EXPECT_NEAR(turned.orientation.x, want.x, 1e-15);
  EXPECT_NEAR(turned.orientation.y, want.y, 1e-15);
  ExpectSame(robot.def.bodies[0].inertia_kg_m2,
             SolidBox({0, 0, 1}, want, {0.1, 0.2, 0.3}, 1).inertia_kg_m2);
  EXPECT_NE(Written(robot).find("rotate: {quaternion: ["), std::string::npos);
}

TEST_F(TurnedSolids, MistakesAreNamed) {
  const auto with = [&](const std::string& keys) {
    return Bad("nodes: {a: [0, 0, 1]}\nbuilders: [{match: a, point_mass: {mass_kg: 1, " + keys +
               "}}]\n");
  };
  EXPECT_NE(with("inertia_kg_m2: [1, 2]")
                .find("point_mass.inertia_kg_m2 must have three or six numbers, got 2"),
            std::string::npos);
  EXPECT_NE(with("inertia_kg_m2: [1, 1, 1], radius_m: 0.1")
                .find("point_mass has both inertia_kg_m2 and radius_m"),
            std::string::npos);
  EXPECT_NE(Bad("nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{name: p, nodes: [a, b]}]\nbuilders: "
                "[{match: p, box: {width_m: 0.1, height_m: 0.1, mass_kg: 1, rotate: {axis: x, "
                "angle_rad: 1}}}]\n")
                .find("a box along a pair cannot be rotated"),
            std::string::npos);
}

}  // namespace
}  // namespace taut::test
