// Touching terrain boxes as one surface (docs/theory/ground.md, section 8).
#include <gtest/gtest.h>

#include "tests/constants.h"
#include "tests/physics/lanes_alike.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/box.h"
#include "tests/scenes/rod.h"
#include "tests/scenes/six_strut.h"

namespace taut::test {
namespace {

const Material kMaterial{0.5, 0.4, 0};

/// Adds a floor of boxes with its top at z = 0.
void AddTiles(ModelDef& def, int columns, int rows, double x_m, double y_m) {
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      def.terrain_boxes.push_back(
          {"tile_" + std::to_string(i * rows + j),
           {(i - 0.5 * (columns - 1)) * x_m, (j - 0.5 * (rows - 1)) * y_m, -0.05},
           {},
           {0.5 * x_m, 0.5 * y_m, 0.05},
           kMaterial});
    }
  }
}

struct Thing {
  const char* name;
  void (*add)(ModelDef&);
};
void PrintTo(const Thing& thing, std::ostream* out) { *out << thing.name; }

const Thing kThings[] = {
    {"rolling_ball",
     [](ModelDef& def) {
       scenes::AddBall(def, "ball", 0.1, 0.05, {-0.3, 0.01, 0.05}, kMaterial);
       def.bodies[0].velocity_m_per_s = {1, 0.3, 0};
     }},
    {"falling_ball",
     [](ModelDef& def) {
       scenes::AddBall(def, "ball", 0.1, 0.05, {-0.3, 0.01, 0.15}, kMaterial);
       def.bodies[0].velocity_m_per_s = {1, 0.3, 0};
     }},
    {"sliding_rod",
     [](ModelDef& def) {
       scenes::AddRod(def, "rod", 0.1, 0.01, {-0.4, 0.013, 0.01}, {-0.1, 0.113, 0.01}, kMaterial);
       def.bodies[0].velocity_m_per_s = {1, 0.2, 0};
       def.bodies[0].angular_velocity_rad_per_s = {0, 0, 3};
     }},
    {"falling_rod",
     [](ModelDef& def) {
       scenes::AddRod(def, "rod", 0.1, 0.01, {-0.4, 0.013, 0.1}, {-0.1, 0.113, 0.15}, kMaterial);
       def.bodies[0].velocity_m_per_s = {0.5, 0.2, 0};
     }},
    {"six_struts",
     [](ModelDef& def) {
       scenes::SixStrut robot;
       robot.material = kMaterial;
       robot.orientation = scenes::Turn({0.6, 0, 0.8}, 0.3);
       robot.center_m = {0.01, 0.02, 0.6};
       def = robot.Def();
       for (BodyDef& body : def.bodies) body.velocity_m_per_s = {0.4, 0.2, 0};
     }},
};

class OnTiles : public testing::TestWithParam<Thing> {};

TEST_P(OnTiles, ItMovesAsOnThePlane) {
  ModelDef plane;
  GetParam().add(plane);
  ModelDef many = plane, few = plane;
  plane.planes = {{"plane", {0, 0, 1}, {}, kMaterial}};
  many.planes.clear(), few.planes.clear();
  AddTiles(many, 25, 20, 0.09, 0.11);
  AddTiles(few, 1, 2, 2, 1.5);
  WorldBatchOptions options;
  options.tolerance_m_per_s = 1e-12;
  WorldBatch a = MakeBatch(plane, options), b = MakeBatch(many, options),
             c = MakeBatch(few, options);
  for (int i = 0; i < 1500; ++i) {
    a.Step(1e-3), b.Step(1e-3), c.Step(1e-3);
    for (int k = 0; k < static_cast<int>(plane.bodies.size()); ++k) {
      const Vec3 at = a.Body(0, k).position_m;
      ASSERT_LE(Distance(at, b.Body(0, k).position_m), 1e-9) << k << " after " << a.Time(0);
      ASSERT_LE(Distance(at, c.Body(0, k).position_m), 1e-9) << k << " after " << a.Time(0);
    }
    ASSERT_EQ(a.Contacts(0).size(), b.Contacts(0).size()) << a.Time(0);
  }
}

INSTANTIATE_TEST_SUITE_P(Things, OnTiles, testing::ValuesIn(kThings));

TEST(JoinedBoxes, ABoxHasItsFourCornersOnTiles) {
  // Statics does not determine the loads of the four corners; their distribution depends on warm
  // starts. Hence larger tolerances than for bodies with fewer contacts.
  ModelDef plane;
  scenes::AddBox(plane, "box", 0.3, {0.05, 0.07, 0.03}, {-0.1, 0, 0.03}, {}, kMaterial);
  plane.bodies[0].velocity_m_per_s = {0.5, 0.2, 0};
  plane.bodies[0].angular_velocity_rad_per_s = {0, 0, 3};
  ModelDef tiles = plane;
  plane.planes = {{"plane", {0, 0, 1}, {}, kMaterial}};
  AddTiles(tiles, 25, 20, 0.09, 0.11);
  WorldBatch a = MakeBatch(plane), b = MakeBatch(tiles);
  for (int i = 0; i < 300; ++i) {
    a.Step(1e-3), b.Step(1e-3);
    EXPECT_LE(Distance(a.Body(0, 0).position_m, b.Body(0, 0).position_m), 2e-4) << i;
    EXPECT_NEAR(b.Body(0, 0).position_m.z, 0.03, 1e-9) << i;
  }
}

TEST(JoinedBoxes, AStepIsAStep) {
  // Two treads and a riser between them: a rolling ball is stopped by the riser and then touches
  // both; so is a sliding box.
  for (const bool ball : {true, false}) {
    ModelDef def;
    if (ball) {
      scenes::AddBall(def, "thing", 0.1, 0.05, {-0.2, 0.01, 0.05}, kMaterial);
    } else {
      scenes::AddBox(def, "thing", 0.1, {0.05, 0.05, 0.05}, {-0.2, 0.01, 0.05}, {}, {0, 0, 0});
    }
    def.bodies[0].velocity_m_per_s = {1, 0, 0};
    def.terrain_boxes.push_back({"low", {-0.5, 0, -0.1}, {}, {0.5, 1, 0.1}, kMaterial});
    def.terrain_boxes.push_back({"high", {0.5, 0, 0}, {}, {0.5, 1, 0.2}, kMaterial});
    WorldBatch world = MakeBatch(def);
    double farthest = -1;
    for (int i = 0; i < 500; ++i) {
      world.Step(1e-3);
      farthest = std::max(farthest, world.Body(0, 0).position_m.x);
      EXPECT_NEAR(world.Body(0, 0).position_m.z, 0.05, ball ? 0.02 : 1e-6) << i;
    }
    EXPECT_NEAR(farthest, -0.05, 1e-6) << ball;
  }
}

TEST(JoinedBoxes, ARodThatHangsOverIsHeldByTheBorder) {
  // 8 of 18 parts of the rod overhang, on the line between two rows of tiles. Both tiles end there,
  // though they continue on the other side, where they support the rod's end.
  for (const double side : {-1.0, 1.0}) {
    ModelDef def;
    AddTiles(def, 4, 2, 0.1, 0.1);
    scenes::AddRod(def, "rod", 0.1, 0.01, {0.1 * side, 0, 0.01}, {0.28 * side, 0, 0.01}, kMaterial);
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3, 300);
    EXPECT_NEAR(world.Body(0, 0).position_m.z, 0.01, 1e-6);
    // Statics: the rod's end is at 0.1, the border at 0.2, the center of mass at 0.19.
    double at_border = 0, at_end = 0;
    for (const ContactState& c : world.Contacts(0)) {
      (c.point_m.x * side > 0.15 ? at_border : at_end) += c.force_n.z;
    }
    EXPECT_NEAR(at_border, 0.1 * kG * 0.9, 1e-6) << side;
    EXPECT_NEAR(at_end, 0.1 * kG * 0.1, 1e-6) << side;
  }
}

TEST(JoinedBoxes, ABoxThatIsALittleInTwoTilesIsPushedUpByBoth) {
  // The box is 0.1 mm deep, and 0.01 mm across the border of the second tile, whose side would be
  // the shortest way out.
  ModelDef def;
  scenes::AddBox(def, "box", 0.3, {0.05, 0.04, 0.03}, {-0.05 + 1e-5, 0.01, 0.03 - 1e-4}, {},
                 kMaterial);
  AddTiles(def, 2, 1, 0.2, 0.2);
  WorldBatch world = MakeBatch(def);
  for (int i = 0; i < 100; ++i) {
    world.Step(1e-3);
    for (const ContactState& c : world.Contacts(0)) EXPECT_GT(c.normal.z, 0.999) << i;
    EXPECT_NEAR(world.Body(0, 0).position_m.x, -0.05 + 1e-5, 3e-6) << i;
  }
}

TEST(JoinedBoxes, LanesHaveTheBitsOfAWorldAlone) {
  ModelDef def;
  kThings[4].add(def);
  def.planes.clear();
  AddTiles(def, 25, 20, 0.09, 0.11);
  ExpectLanesLikeWorldsAlone(def, {0.03, -0.02, 0}, 500);
}

}  // namespace
}  // namespace taut::test
