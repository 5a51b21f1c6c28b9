// Terrain of many boxes: placement and errors
#include <cmath>
#include <numbers>

#include "math/random.h"
#include "math/vec.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

const std::string kBoxlessGround = "- {name: ground, plane: {height_m: 0, friction: 0.5}}";

class TerrainBoxes : public ExperimentFolder {
 protected:
  RobotSpec With(const std::string& terrain) {
    Change(kBoxlessGround, terrain);
    Diagnostics out;
    const auto experiment = LoadExperiment(Path("trial.yaml"), {}, out);
    EXPECT_TRUE(experiment) << out.Format();
    return experiment ? experiment->robot : RobotSpec{};
  }
};

/// Returns number `which` of block i: 53 bits of Philox, as defined in docs/formats/experiment.md.
double Drawn(std::uint32_t seed, std::uint32_t i, std::uint32_t which) {
  const auto r = math::Philox({i, 0, 100, which / 2}, {seed, 0});
  const std::size_t first = 2 * (which % 2);
  const std::uint64_t bits = (std::uint64_t{r[first + 1]} << 32) | r[first];
  return std::ldexp(static_cast<double>(bits >> 11), -53);
}

TEST_F(TerrainBoxes, ScatteredBlocksLieWhereTheirNumbersSay) {
  const RobotSpec robot = With(
      "- {name: field, scatter: {count: 40, seed: 7, within_m: [[-1, 2, 0.5], [3, 2.5, 0.5]], "
      "box_m: "
      "[0.2, 0.1, 0.06], static_friction: 0.7, kinetic_friction: 0.6, restitution: 0.2}}");
  const auto& boxes = robot.def.terrain_boxes;
  ASSERT_EQ(boxes.size(), 40u);
  ASSERT_EQ(robot.terrain_box_sources.size(), 40u);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const TerrainBoxDef& box = boxes[i];
    EXPECT_EQ(box.name, "field_" + std::to_string(i));
    EXPECT_EQ(box.center_m.x, -1 + Drawn(7, i, 0) * 4);
    EXPECT_EQ(box.center_m.y, 2 + Drawn(7, i, 1) * 0.5);
    EXPECT_EQ(box.center_m.z, 0.5);
    // Upright, rotated by its heading.
    const double heading = std::numbers::pi * (2 * Drawn(7, i, 3) - 1);
    const Vec3 along = Rotate(box.orientation, {1, 0, 0});
    EXPECT_NEAR(along.x, std::cos(heading), 1e-14);
    EXPECT_NEAR(along.y, std::sin(heading), 1e-14);
    EXPECT_EQ(Rotate(box.orientation, {0, 0, 1}).z, 1);
    EXPECT_EQ(box.half_extents_m.x, 0.1);
    EXPECT_EQ(box.half_extents_m.y, 0.05);
    EXPECT_EQ(box.half_extents_m.z, 0.03);
    EXPECT_EQ(box.material.static_friction, 0.7);
    EXPECT_EQ(box.material.kinetic_friction, 0.6);
    EXPECT_EQ(box.material.restitution, 0.2);
    EXPECT_EQ(robot.terrain_box_sources[i].line, 7);
  }
}

TEST_F(TerrainBoxes, ScatteredBlocksFillTheirRegionEvenly) {
  const RobotSpec robot = With(
      "- {name: field, scatter: {count: 5000, within_m: [[-1, -1, 0], [1, 1, 0.1]], box_m: [0.1, "
      "0.1, "
      "0.1]}}");
  double quarters[4] = {}, x = 0, y = 0, z = 0;
  for (const TerrainBoxDef& box : robot.def.terrain_boxes) {
    const Vec3& at = box.center_m;
    ASSERT_TRUE(std::fabs(at.x) <= 1 && std::fabs(at.y) <= 1 && 0 <= at.z && at.z <= 0.1);
    x += at.x / 5000, y += at.y / 5000, z += at.z / 5000;
    quarters[2 * (at.x > 0) + (at.y > 0)] += 1;
  }
  // Five standard deviations of a mean of 5000, and of a count with probability 1/4.
  const double five = 5 / std::sqrt(12.0 * 5000);
  EXPECT_NEAR(x, 0, 2 * five);
  EXPECT_NEAR(y, 0, 2 * five);
  EXPECT_NEAR(z, 0.05, 0.1 * five);
  for (const double count : quarters) EXPECT_NEAR(count, 1250, 5 * std::sqrt(5000 * 3.0 / 16));
}

TEST_F(TerrainBoxes, MoreBlocksMoveNoneAndAnotherSeedMovesAll) {
  const auto boxes = [&](const std::string& how) {
    return With("- {name: f, scatter: {" + how +
                ", within_m: [[0, 0, 0], [1, 1, 1]], box_m: [1, 1, 1]}}")
        .def.terrain_boxes;
  };
  const auto few = boxes("count: 5"), more = boxes("count: 9"), others = boxes("count: 5, seed: 2");
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(few[i].center_m.x, more[i].center_m.x);
    EXPECT_EQ(few[i].orientation.z, more[i].orientation.z);
    EXPECT_NE(few[i].center_m.x, others[i].center_m.x);
  }
}

TEST_F(TerrainBoxes, StairsRiseFromTheirFoot) {
  // Rotated by 90 degrees about z they rise along y; x is -side.
  const RobotSpec robot = With(
      "- {name: up, stairs: {steps: 10, width_m: 2, tread_m: 0.3, rise_m: 0.2, at_m: [5, 1, 0.5], "
      "rotate: {axis: z, angle_rad: pi / 2}, friction: 0.9}}");
  const auto& steps = robot.def.terrain_boxes;
  ASSERT_EQ(steps.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    const TerrainBoxDef& step = steps[i];
    EXPECT_EQ(step.name, "up_" + std::to_string(i));
    // From the foot to the tread, adjacent to the previous step; the box's local x is the world's
    // y.
    const double n = static_cast<double>(i);
    EXPECT_NEAR(step.center_m.z - step.half_extents_m.z, 0.5, 1e-15);
    EXPECT_NEAR(step.center_m.z + step.half_extents_m.z, 0.5 + 0.2 * (n + 1), 1e-14);
    EXPECT_NEAR(step.center_m.y - step.half_extents_m.x, 1 + 0.3 * n, 1e-14);
    EXPECT_NEAR(step.center_m.y + step.half_extents_m.x, 1 + 0.3 * (n + 1), 1e-14);
    EXPECT_NEAR(step.center_m.x, 5, 1e-14);
    EXPECT_EQ(step.half_extents_m.y, 1);
    EXPECT_NEAR(Rotate(step.orientation, {1, 0, 0}).y, 1, 1e-15);
    EXPECT_EQ(step.material.static_friction, 0.9);
  }
}

class TerrainBoxErrors : public ExperimentErrors {
 protected:
  void ExpectGood(const std::string& terrain) {
    Change(kBoxlessGround, terrain);
    EXPECT_EQ(Complaints(), "");
  }
};

TEST_F(TerrainBoxErrors, OfScatteredBlocks) {
  const auto good = [&](const std::string& scatter) {
    ExpectGood("- {name: f, scatter: {" + scatter + "}}");
  };
  const auto expect = [&](const std::string& scatter, const std::string& message) {
    Expect(kBoxlessGround, "- {name: f, scatter: {" + scatter + "}}", message);
  };
  const std::string within = "within_m: [[0, 0, 0], [1, 1, 1]]", box = "box_m: [1, 1, 1]";
  good("count: 3, " + within + ", " + box);
  expect("seed: 1",
         "7:24: error: scatter needs the key \"box_m\"\n7:24: error: scatter needs the key "
         "\"count\"\n7:24: error: scatter needs the key \"within_m\"");
  expect("count: 0, " + within + ", " + box,
         "7:32: error: scatter.count must be a whole number within 1..5000, got 0");
  expect("count: 2.5, seed: -1, " + within + ", " + box,
         "7:32: error: scatter.count must be a whole number within 1..5000, got 2.5\n7:43: error: "
         "scatter.seed must be a whole number within 0..2147483647, got -1");
  expect("count: 3, within_m: [0, 1], " + box,
         "7:46: error: scatter.within_m must be a list of 3 numbers, got a text\n7:49: error: "
         "scatter.within_m must be a list of 3 numbers, got a text");
  expect("count: 3, within_m: 1, " + box,
         "7:45: error: scatter.within_m must be a list, got a text");
  expect("count: 3, within_m: [[0, 0, 0]], " + box,
         "7:35: error: scatter.within_m must be two points, got 1 ([[x, y, z], [x, y, z]], the "
         "lower numbers first)");
  expect("count: 3, within_m: [[0, 0, 0.1], [1, 1, 0]], " + box,
         "7:35: error: scatter.within_m has a first point with a larger coordinate than the second "
         "([[x, y, "
         "z], [x, y, z]], the lower numbers first)");
  expect("count: 3, box_m: [1, 0, 1], within_m: [[0, 0], [1, 1, 0]], friction: -1",
         "7:42: error: scatter.box_m must be three positive numbers\n7:64: error: scatter.within_m "
         "must have 3 numbers, got 2\n7:94: error: scatter.friction must not be negative, got -1");
  expect("count: 3, static_friction: 0.1, kinetic_friction: 0.2, " + within + ", " + box,
         "7:35: error: scatter.static_friction is below kinetic_friction (static friction must be "
         "at least the kinetic friction)");
}

TEST_F(TerrainBoxErrors, OfStairs) {
  const auto good = [&](const std::string& stairs) {
    ExpectGood("- {name: f, stairs: {" + stairs + "}}");
  };
  const auto expect = [&](const std::string& stairs, const std::string& message) {
    Expect(kBoxlessGround, "- {name: f, stairs: {" + stairs + "}}", message);
  };
  const std::string sizes = "width_m: 1, tread_m: 1, rise_m: 1";
  good("steps: 3, " + sizes);
  expect("at_m: [0, 0, 0]",
         "7:23: error: stairs needs the key \"rise_m\"\n7:23: error: stairs needs the key "
         "\"steps\"\n7:23: error: stairs needs the key \"tread_m\"\n7:23: error: stairs needs the "
         "key \"width_m\"");
  expect("steps: 5001, " + sizes,
         "7:31: error: stairs.steps must be a whole number within 1..5000, got 5001");
  expect("steps: 3, width_m: 0, tread_m: -1, rise_m: x, at_m: 3, restitution: 2",
         "7:43: error: stairs.width_m must be positive, got 0\n7:55: error: stairs.tread_m must be "
         "positive, got -1\n7:67: error: stairs.rise_m: unknown name \"x\" (one of: push_n)\n7:76: "
         "error: stairs.at_m must be a list of 3 numbers, got a text\n7:92: error: "
         "stairs.restitution must be within 0..1, got 2");
  expect("steps: 3, heading_rad: 1, " + sizes,
         "7:34: error: unknown key \"heading_rad\" in stairs (one of: steps, width_m, tread_m, "
         "rise_m, at_m, rotate, friction, static_friction, kinetic_friction, restitution, "
         "stribeck, friction_directions)");
  expect("steps: 3, static_friction: 0.1, kinetic_friction: 0.2, " + sizes,
         "7:34: error: stairs.static_friction is below kinetic_friction (static friction must be "
         "at least the kinetic friction)");
}

TEST_F(TerrainBoxErrors, OfNamesAndNumbers) {
  const std::string sizes = ", width_m: 1, tread_m: 1, rise_m: 1}}";
  const auto stairs = [&](const std::string& name, int steps) {
    return "- {name: " + name + ", stairs: {steps: " + std::to_string(steps) + sizes;
  };
  Expect(kBoxlessGround, stairs("a", 3) + "\n  " + stairs("a", 3),
         "8:6: error: two terrain elements are called a (the first is in line 7)");
  Expect(kBoxlessGround, stairs("a", 3) + "\n  - {name: a_2, plane: {}}",
         "8:6: error: two terrain elements are called a_2 (the first is in line 7)\n"
         "8:24: error: plane needs one of height_m, normal, slope_rad");
  Expect(kBoxlessGround, "- {name: a_2, plane: {height_m: 0}}\n  " + stairs("a", 5),
         "8:6: error: two terrain elements are called a_2 (the first is in line 7)");
  ExpectGood(stairs("a", 3000) + "\n  " + stairs("b", 2000));
  Expect(kBoxlessGround, stairs("a", 3000) + "\n  " + stairs("b", 2001),
         "8:5: error: the terrain has 5001 boxes up to this element, more than 5000 (use a height "
         "field or a mesh)");
  Expect(kBoxlessGround, stairs(std::string(199, 'n'), 3),
         "7:12: error: terrain.name and the appended number of a box have more than 200 characters "
         "(use a "
         "shorter name)");
  ExpectGood(stairs(std::string(198, 'n'), 3));
}

TEST_F(TerrainBoxErrors, ThousandsOfEntriesAreRefusedBeforeTheyAreMade) {
  // 10 million boxes would need 2 GB if each entry were built before the error.
  std::string many;
  for (int i = 0; i < 2'000; ++i) {
    many += (i == 0 ? "" : "\n  ") + ("- {name: a" + std::to_string(i)) +
            ", stairs: {steps: 5000, width_m: 1, tread_m: 1, rise_m: 1}}";
  }
  Expect(kBoxlessGround, many,
         "8:5: error: the terrain has 10000 boxes up to this element, more than 5000 (use a height "
         "field or a mesh)");
}

}  // namespace
}  // namespace taut::test
