// Friction by speed and direction in files: values, rotation with its part, errors, resolved
// experiments, and written models
#include <cmath>
#include <numbers>

#include "math/vec.h"
#include "taut/world_batch.h"
#include "unit/description/experiment_fixture.h"
#include "unit/description/model_fixture.h"

namespace taut::test {
namespace {

std::string OneRod(const std::string& surface) {
  return "nodes: {a: [0, 0, 0], b: [1, 0, 0]}\n"  // line 4
         "pairs: [{nodes: [a, b], tags: [rod]}]\n"
         "builders:\n"
         "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1, " +
         surface + "}}\n";
}

TEST(FrictionText, ARodSaysHowItRubs) {
  const RobotSpec robot =
      Good(OneRod("static_friction: 0.5, kinetic_friction: 0.2, stribeck: {speed_m_per_s: 0.05, "
                  "viscous_friction_s_per_m: 0.1}, friction_directions: {forward: 0.5, backward: "
                  "1.5, sideways: 2}"));
  ASSERT_EQ(robot.def.capsules.size(), 1u);
  const Material& m = robot.def.capsules[0].material;
  ASSERT_TRUE(m.stribeck && m.directions);
  EXPECT_EQ(m.stribeck->speed_m_per_s, 0.05);
  EXPECT_EQ(m.stribeck->viscous_friction_s_per_m, 0.1);
  EXPECT_EQ(m.directions->forward, 0.5);
  EXPECT_EQ(m.directions->backward, 1.5);
  EXPECT_EQ(m.directions->sideways, 2);
  EXPECT_EQ(Dot(m.directions->axis, m.directions->axis), 0);
}

TEST(FrictionText, AnAxisTurnsWithItsPart) {
  const RobotSpec robot = Good(
      "parts: {block: {nodes: {a: [0, 0, 0]}}}\n"
      "structure: [{part: block, rotate: {axis: [0, 0, 1], angle_rad: pi / 2}}]\n"
      "builders:\n"
      "  - {match: a, box: {size_m: [1, 1, 1], mass_kg: 1, friction_directions: {axis: [3, 0, "
      "0]}}}\n"
      "  - {match: a, sphere: {radius_m: 1, mass_kg: 1, friction_directions: {axis: [0, 2, "
      "0]}}}\n");
  ASSERT_EQ(robot.def.boxes.size(), 1u);
  ASSERT_EQ(robot.def.spheres.size(), 1u);
  const Vec3 of_box = robot.def.boxes[0].material.directions->axis;
  const Vec3 of_sphere = robot.def.spheres[0].material.directions->axis;
  EXPECT_NEAR(of_box.y, 1, 1e-15);
  EXPECT_NEAR(of_box.x, 0, 1e-15);
  EXPECT_NEAR(of_sphere.x, -1, 1e-15);
}

TEST(FrictionText, WhatIsWrongIsNamedWithItsPlace) {
  EXPECT_EQ(Errors(OneRod("friction: 0.5, stribeck: {speed_m_per_s: 0.1}")),
            "robot.yaml:7:67: error: rod.stribeck has no effect (give static_friction above "
            "kinetic_friction, or viscous_friction_s_per_m)\n");
  EXPECT_EQ(Errors(OneRod("stribeck: {viscous_friction_s_per_m: -1}, "
                          "friction_directions: {forward: -1, axis: [0, 0, 0]}")),
            "robot.yaml:7:62: error: stribeck needs the key \"speed_m_per_s\"\n"
            "robot.yaml:7:89: error: stribeck.viscous_friction_s_per_m must not be negative, got "
            "-1\n"
            "robot.yaml:7:125: error: friction_directions.forward must not be negative, got -1\n"
            "robot.yaml:7:135: error: friction_directions.axis must not be zero (it is a "
            "direction)\n");
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0]}\n"
                   "builders:\n"
                   "  - {match: a, sphere: {radius_m: 1, mass_kg: 1, friction_directions: "
                   "{forward: 2}}}\n"),
            "robot.yaml:6:50: error: sphere.friction_directions needs an axis (add one, such as "
            "`axis: [1, 0, 0]`: only rods have a default)\n");
}

class FrictionFile : public ExperimentFolder {};

TEST_F(FrictionFile, GoesThroughAResolvedExperimentAndTurnsWithAPlacedRobot) {
  Write("model.yaml",
        "taut: 1\nkind: model\nname: sled\n"
        "nodes: {a: [0, 0, 0.1]}\n"
        "builders:\n"
        "  - {match: a, box: {size_m: [0.1, 0.1, 0.1], mass_kg: 1, static_friction: 0.5, "
        "kinetic_friction: 0.2, stribeck: {speed_m_per_s: 0.05}, friction_directions: {forward: "
        "0.5, axis: [1, 0, 0]}}}\n");
  Write("trial.yaml",
        "taut: 1\nkind: experiment\nname: trial\nmodel: model.yaml\nduration_s: 1\n"
        "start: as_described\n"
        "place: {rotate: {axis: [0, 0, 1], angle_rad: pi / 2}}\n"
        "terrain: [{name: ground, plane: {height_m: 0, friction: 0.5, friction_directions: "
        "{backward: 3, axis: [0, -2, 0]}}}]\n");
  Diagnostics out;
  const auto experiment = LoadExperiment(Path("trial.yaml"), {}, out);
  ASSERT_TRUE(experiment) << out.Format();
  const Material& material = experiment->robot.def.boxes[0].material;
  EXPECT_NEAR(material.directions->axis.y, 1, 1e-15);
  Write("resolved.yaml", ResolvedYaml(*experiment));
  const auto again = LoadExperiment(Path("resolved.yaml"), {}, out);
  ASSERT_TRUE(again) << out.Format();
  const Material& box = again->robot.def.boxes[0].material;
  const Material& plane = again->robot.def.planes[0].material;
  ASSERT_TRUE(box.stribeck && box.directions && plane.directions && !plane.stribeck);
  EXPECT_EQ(box.stribeck->speed_m_per_s, 0.05);
  EXPECT_EQ(box.directions->forward, 0.5);
  EXPECT_EQ(box.directions->axis.y, material.directions->axis.y);
  EXPECT_EQ(plane.directions->backward, 3);
  EXPECT_EQ(plane.directions->axis.y, -1);
}

}  // namespace
}  // namespace taut::test
