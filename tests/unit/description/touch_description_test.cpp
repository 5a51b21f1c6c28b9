/// Cables that contact obstacles, in model files (docs/formats/model.md)

#include <gtest/gtest.h>

#include "unit/description/model_fixture.h"

namespace taut {
namespace {

/// A rope from a post to a ball next to a rod; the pair is in line 6.
std::string Rope(const std::string& cable, const std::string& nodes = "a, b") {
  return "nodes: {a: [0, 0, 1], b: [1, 0, 1], c: [0.5, -1, 1.2], d: [0.5, 1, 1.2]}\n"  // line 4
         "pairs:\n"
         "  - {name: rope, nodes: [" +
         nodes +
         "]}\n"
         "  - {name: rod, nodes: [c, d]}\n"
         "builders:\n"
         "  - {match: a, anchor: {}}\n"
         "  - {match: b, sphere: {radius_m: 0.01, mass_kg: 1}}\n"
         "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
         "  - {match: rope, cable: {stiffness_n_per_m: 100, prestress_n: 1" +
         cable + "}}\nallow_disconnected: true\n";
}

TEST(TouchingCable, IsAsItSays) {
  EXPECT_EQ(Good(Rope("")).def.cables[0].touches, CableTouches::kNone);
  const CableDef terrain = Good(Rope(", touches: terrain, radius_m: 0.001")).def.cables[0];
  EXPECT_EQ(terrain.touches, CableTouches::kTerrain);
  EXPECT_EQ(terrain.radius_m, 0.001);
  EXPECT_EQ(terrain.touch_friction, 0);
  const std::string rough = Rope(", touches: all, radius_m: 0.001, touch_friction: 0.3");
  EXPECT_EQ(Good(rough).def.cables[0].touch_friction, 0.3);
  EXPECT_EQ(Good(Rope(", touches: rods, radius_m: 0.001")).def.cables[0].touches,
            CableTouches::kRods);
  EXPECT_EQ(Good(Rope(", touches: all, radius_m: 0.001")).def.cables[0].touches,
            CableTouches::kAll);
}

TEST(TouchingCable, WhatCannotBeIsSaidWithItsLine) {
  EXPECT_EQ(Errors(Rope(", touches: ground")),
            "robot.yaml:12:76: error: cable.touches cannot be \"ground\" (one of: none, terrain, "
            "rods, all)\n");
  EXPECT_EQ(Errors(Rope(", touches: all")),
            "robot.yaml:12:67: error: cable.touches needs a `radius_m` above 0 (half the cable's "
            "thickness, such as 0.001)\n");
  EXPECT_EQ(Errors(Rope(", radius_m: 0.001")),
            "robot.yaml:12:67: error: cable.radius_m has no effect without `touches` (write "
            "`touches: terrain`, `touches: rods` or `touches: all`)\n");
  EXPECT_EQ(Errors(Rope(", touch_friction: 0.3")),
            "robot.yaml:12:67: error: cable.touch_friction has no effect without `touches` (write "
            "`touches: terrain`, `touches: rods` or `touches: all`; eyelets and pulleys have "
            "`friction` in the route)\n");
  EXPECT_EQ(Errors(Rope(", touches: terrain, radius_m: 0.001, touch_friction: -1")),
            "robot.yaml:12:118: error: cable.touch_friction must not be negative, got -1\n");
  EXPECT_EQ(
      Errors(Rope(", touches: terrain, radius_m: 0.001, touch_friction: 0.1, "
                  "actuator: {dc_motor: {}}")),
      "robot.yaml:12:102: error: cable.touch_friction: a cable with friction on obstacles cannot "
      "have a `dc_motor` (use `ideal: true` or an actuator with limits, or leave "
      "out `touch_friction`)\n");
  EXPECT_EQ(Errors(Rope(", touches: terrain, radius_m: -1")),
            "robot.yaml:12:95: error: cable.radius_m must not be negative, got -1\n");
  EXPECT_EQ(Errors(Rope(", touches: terrain, radius_m: 0.001", "a, c, b")),
            "robot.yaml:6:5: error: the cable \"rope\" has `touches`, so it must have exactly two "
            "nodes (leave out `touches`, or split the cable at the nodes between its ends)\n");
  std::string anchored = Rope(", touches: rods, radius_m: 0.001");
  anchored.replace(anchored.find("a: [0, 0, 1]"), 12, "a: [0.5, 0, 1.195]");
  EXPECT_EQ(Errors(anchored),
            "robot.yaml:6:5: error: the cable \"rope\" touches rods, but ends 5 mm inside the rod "
            "\"rod\" of another body (move the end of the cable, or the rod)\n");
  std::string inside = Rope(", touches: rods, radius_m: 0.001");
  inside.replace(inside.find("b: [1, 0, 1]"), 12, "b: [0.5, 0, 1.195]");
  EXPECT_EQ(Errors(inside),
            "robot.yaml:6:5: error: the cable \"rope\" touches rods, but ends 5 mm inside the rod "
            "\"rod\" of another body (move the end of the cable, or the rod)\n");
}

}  // namespace
}  // namespace taut
