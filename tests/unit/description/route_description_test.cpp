/// Cables over wheels and through eyelets with friction in model files (docs/formats/model.md)

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "math/described_path.h"
#include "unit/description/model_fixture.h"

namespace taut {
namespace {

/// Two anchored posts and a wheel between them; the route is in line 7.
std::string Posts(const std::string& route, const std::string& cable = "prestress_n: 1") {
  return "nodes:\n"  // line 4
         "  {a: [-0.5, 0, -0.1], b: [-0.1, 0, -0.4], w: [0, 0, 0], c: [0.3, 0, 0.1]}\n"
         "pairs:\n"
         "  - {name: rope, route: " +
         route +
         "}\n"
         "builders:\n"
         "  - {match: [[a], [b], [c]], anchor: {}}\n"
         "  - {match: w, sphere: {radius_m: 0.1, mass_kg: 1, collides: false}}\n"
         "  - {match: rope, cable: {stiffness_n_per_m: 1e4, " +
         cable + "}}\n";
}
const char* const kWheel = "axis: [0, 1, 0], radius_m: 0.1";

std::string Pulley(const std::string& more) {
  return std::string("{pulley: w, ") + kWheel + ", " + more + "}";
}
std::string Drum(const std::string& more) {
  return std::string("{drum: w, ") + kWheel + ", " + more + "}";
}

TEST(Route, AnEyeletAloneIsThatOfNodes) {
  const RobotSpec route = Good(Posts("[a, w, b]"));
  std::string nodes = Posts("[a, w, b]");
  nodes.replace(nodes.find("route"), 5, "nodes");
  const RobotSpec same = Good(nodes);
  ASSERT_EQ(route.def.cables[0].attachments.size(), 3u);
  EXPECT_EQ(route.def.cables[0].rest_length_m, same.def.cables[0].rest_length_m);
  EXPECT_EQ(route.def.cables[0].attachments[1].friction, 0.0);
}

TEST(Route, APulleyIsOnTheSideThatItSays) {
  const RobotSpec right =
      Good(Posts("[a, " + Pulley("side: right, turns: 1, friction: 0.3") + ", b]"));
  const CableDef& cable = right.def.cables[0];
  ASSERT_TRUE(cable.attachments[1].wheel);
  EXPECT_FALSE(cable.attachments[1].wheel->counterclockwise);
  EXPECT_EQ(cable.attachments[1].friction, 0.3);
  EXPECT_NEAR(math::DescribedPath(cable).length_m(), 1.371238898, 5e-10);
  EXPECT_NEAR(cable.rest_length_m, 1.371238898 - 1e-4, 5e-10);
}

TEST(Route, WhatIsWoundUpIsNotShorterThanItsRestLength) {
  // 0.5 m to b, 0.4 m to the drum, and two and a half turns of 0.2 pi
  EXPECT_EQ(Errors(Posts("[a, b, " + Drum("side: left, turns: 2.5") + "]", "rest_length_m: 1.57")),
            "robot.yaml:11:66: error: the cable \"rope\" starts with a rest length of 1.57 m, "
            "below the 1.5708 m wound around its pulleys and drums (increase the rest length: the "
            "whole cable path is 2.4708 m long)\n");
  Good(Posts("[a, b, " + Drum("side: left, turns: 2.5") + "]", "rest_length_m: 1.58"));
}

TEST(Route, ADrumHasWhatIsWoundUpAtEitherEnd) {
  // Left and right are relative to the direction along the cable.
  const double straight = std::sqrt(0.5 * 0.5), wound = 2 * std::numbers::pi * 2.25 * 0.1;
  for (const std::string& route : {"[a, " + Drum("side: left, turns: 2.25") + "]",
                                   "[" + Drum("side: right, turns: 2.25") + ", a]"}) {
    const RobotSpec robot = Good(Posts(route));
    EXPECT_EQ(robot.def.cables[0].attachments.size(), 3u);
    EXPECT_NEAR(math::DescribedPath(robot.def.cables[0]).length_m(), straight + wound, 1e-12);
  }
}

TEST(Route, TheAxisIsInThePartsFrame) {
  const std::string model =
      "parts:\n"
      "  p:\n"
      "    nodes: {a: [-0.5, 0, -0.1], b: [-0.1, 0, -0.4], w: [0, 0, 0]}\n"
      "    pairs:\n"
      "      - {name: rope, route: [a, " +
      Pulley("side: right, turns: 1") +
      ", b]}\n"
      "structure: [{part: p, rotate: {axis: [1, 0, 0], angle_rad: pi / 2}}]\n"
      "builders:\n"
      "  - {match: [[a], [b]], anchor: {}}\n"
      "  - {match: w, sphere: {radius_m: 0.1, mass_kg: 1, collides: false}}\n"
      "  - {match: rope, cable: {stiffness_n_per_m: 1e4, prestress_n: 1}}\n";
  const CableDef cable = Good(model).def.cables[0];
  EXPECT_NEAR(cable.attachments[1].wheel->axis.z, 1.0, 1e-15);
  EXPECT_NEAR(math::DescribedPath(cable).length_m(), 1.371238898, 5e-10);
}

TEST(Route, WhatCannotBeIsSaidWithItsLine) {
  const auto error = [](const std::string& route) { return Errors(Posts(route)); };
  EXPECT_EQ(error("[a, {eyelet: w, friction: 0.1, radius_m: 0.1}, b]"),
            "robot.yaml:7:56: error: pairs.route.radius_m is a key of pulleys and drums, not of "
            "eyelets\n");
  EXPECT_EQ(error("[{eyelet: a, friction: 0.1}, w, b]"),
            "robot.yaml:7:26: error: pairs.route has friction at an end, where the cable is fixed "
            "(leave out `friction` there)\n");
  EXPECT_EQ(
      error("[a, {pulley: w}, b]"),
      "robot.yaml:7:29: error: a pulley needs pairs.route.axis\nrobot.yaml:7:29: error: a pulley "
      "needs pairs.route.radius_m\nrobot.yaml:7:29: error: a pulley needs pairs.route.side\n");
  EXPECT_EQ(error("[" + Pulley("side: left") + ", b]"),
            "robot.yaml:7:26: error: pairs.route ends at a pulley (end the cable at a node or on a "
            "drum)\n");
  EXPECT_EQ(error("[a, " + Drum("side: left") + ", b]"),
            "robot.yaml:7:29: error: pairs.route has a drum between its ends (use a `pulley` "
            "there: drums are allowed only at the ends of a cable)\n");
  EXPECT_EQ(error("[a, " + Pulley("side: left, turns: 0.5") + ", b]"),
            "robot.yaml:7:85: error: pairs.route.turns of a pulley must be a whole number (give "
            "whole turns only: the shortest way around is added to them)\n");
  EXPECT_EQ(error("[a, " + Drum("side: left, turns: -1") + "]"),
            "robot.yaml:7:90: error: pairs.route.turns must not be negative, got -1\n");
  EXPECT_EQ(error("[a, " + Pulley("side: up") + ", b]"),
            "robot.yaml:7:79: error: pairs.route.side cannot be \"up\" (one of: left, right)\n");
  EXPECT_EQ(
      error("[a, {pulley: w, drum: w}, b]"),
      "robot.yaml:7:41: error: pairs.route has both pulley and drum (give only one of them)\n");
  EXPECT_EQ(error("[a, {friction: 0.1}, b]"),
            "robot.yaml:7:29: error: pairs.route needs one of eyelet, pulley, drum\n");
  EXPECT_EQ(error("[a, nobody, b]"),
            "robot.yaml:7:29: error: there is no node \"nobody\" (one of: a, b, w, c)\n");
  EXPECT_EQ(error("[a]"), "robot.yaml:7:18: error: pairs.route must name 2 or more nodes, got 1\n");
  EXPECT_EQ(error("[a, 3, b]"),
            "robot.yaml:7:29: error: there is no node \"3\" (did you mean \"a\"?)\n");
  EXPECT_EQ(error("a"), "robot.yaml:7:25: error: pairs.route must be a list, got a text\n");
  EXPECT_EQ(error("[a, {pulley: w, axis: [0, 1, 0], radius_m: 0.45, side: left}, b]"),
            "robot.yaml:7:29: error: the node \"b\" is inside the pulley of the cable \"rope\" (it "
            "is 0.412311 m from the axis: choose a smaller radius_m)\n");
  EXPECT_EQ(error("[a, {pulley: w, axis: [5, 0, 1], radius_m: 0.1, side: left}, b]"),
            "robot.yaml:7:29: error: the node \"a\" is on the axis of the pulley of the cable "
            "\"rope\" (choose an axis across the cable)\n");
  EXPECT_EQ(error("[a, {pulley: w, axis: [0, 0, 0], radius_m: 0, side: left}, b]"),
            "robot.yaml:7:47: error: pairs.route.axis must not be zero (it is a "
            "direction)\nrobot.yaml:7:68: error: pairs.route.radius_m must be positive, got 0\n");
  EXPECT_EQ(error("[a, {eyelet: w, friction: -0.1}, b]"),
            "robot.yaml:7:51: error: pairs.route.friction must not be negative, got -0.1\n");
  EXPECT_EQ(error("[a, w, b], nodes: [a, b]"),
            "robot.yaml:7:18: error: pairs has both nodes and route (give only one of them)\n");
}

/// The vector from a to b is (0.4, 0, -0.3).
TEST(Route, AnAxisAlongTheWayHasNoSide) {
  const auto pulley = [](const std::string& axis, const std::string& more = "") {
    return Posts("[a, {pulley: w, axis: " + axis + ", radius_m: 0.1, side: left" + more + "}, b]");
  };
  EXPECT_EQ(Errors(pulley("[-4, 0, 3]")),
            "robot.yaml:7:29: error: the axis of the pulley of the cable \"rope\" is parallel to "
            "the line from \"a\" to \"b\", so the wheel is on neither side of the cable (choose an "
            "axis across the cable, or add whole `turns`)\n");
  Good(pulley("[-4, 0.001, 3]"));
  const CableDef wound = Good(pulley("[-4, 0, 3]", ", turns: 1")).def.cables[0];
  // Both ends are 0.38 m from the axis, and 0.5 m apart along it.
  const double from_axis = 0.38, tangent = std::sqrt(from_axis * from_axis - 0.01);
  const double across = 2 * tangent + 0.1 * (2 * std::numbers::pi - 2 * std::acos(0.1 / from_axis));
  EXPECT_NEAR(math::DescribedPath(wound).length_m(), std::hypot(across, 0.5), 1e-12);
}

TEST(Route, FrictionIsAt15PlacesOfACableAtMost) {
  const auto route = [](int eyelets) {
    std::string text = "[a";
    for (int i = 0; i < eyelets; ++i) {
      text += std::string(", {eyelet: ") + (i % 2 == 0 ? "w" : "c") + ", friction: 0.1}";
    }
    return Posts(text + ", b]");
  };
  EXPECT_EQ(Good(route(15)).def.cables[0].attachments.size(), 17u);
  EXPECT_EQ(Errors(route(16)),
            "robot.yaml:7:5: error: the cable \"rope\" has friction at more than 15 elements of "
            "its route\n");
}

TEST(Route, WithFrictionADirectCurrentMotorDoesNotWindIt) {
  const std::string motor = "prestress_n: 1, actuator: {dc_motor: {}}";
  for (const std::string& element :
       {Pulley("side: left, friction: 0.3"), std::string("{eyelet: w, friction: 0.3}")}) {
    EXPECT_EQ(Errors(Posts("[a, " + element + ", b]", motor)),
              "robot.yaml:7:29: error: the cable \"rope\" has friction at this element, but a "
              "direct-current motor cannot wind a cable with friction (use `ideal: true` or an "
              "actuator with limits)\n");
  }
  Good(Posts("[a, w, b]", motor));
}

}  // namespace
}  // namespace taut
