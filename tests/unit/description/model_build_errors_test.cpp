// Errors of models that can be read but not built: every message with its line and column
#include <gtest/gtest.h>

#include "unit/description/model_fixture.h"

namespace taut {
namespace {

TEST(ModelBuildErrors, BuildersThatMatchNothing) {
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05",
                           "  - {match: cabel, sphere: {radius_m: 1, mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: no node matches [cabel] (tag cabel: one of: a, b, c, d)\n");
  EXPECT_EQ(Errors(TwoRods(
                "rest_length_m: 0.05",
                "  - {match: [[rod, x], [rd]], box: {width_m: 1, height_m: 1, mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: no pair matches [rd] (tag rd: did you mean \"rod\"?)\n"
            "robot.yaml:12:13: error: no pair matches [rod, x] (tag x: one of: cable, rod)\n");
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05",
                           "  - {match: rod, sphere: {radius_m: 1, mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: no node matches [rod] (a sphere is made from nodes, but "
            "these tags are on pairs)\n");
  EXPECT_EQ(
      Errors(TwoRods("rest_length_m: 0.05",
                     "  - {match: [rod, cable], sphere: {radius_m: 1, mass_kg: 1}}\n")),
      "robot.yaml:12:13: error: no node matches [rod, cable] (tag rod: did you mean \"d\"?)\n");
}

// A spine of two segments has no middle segment; its file is valid nevertheless.
TEST(ModelBuildErrors, ABuilderForCopiesThatAreNotThereIsNone) {
  Good(std::string(kBars) +
       "  - {match: [far, middle], sphere: {radius_m: 0.1, mass_kg: 1}}\n  - {match: [far, 7], "
       "sphere: {radius_m: 0.1, mass_kg: 1}}\n"
       "structure: [{part: bar, copies: 2, step_m: [0, 1, 0]}]\nallow_disconnected: true\n");
}

TEST(ModelBuildErrors, BuildersAreWellFormed) {
  EXPECT_EQ(
      Errors(TwoRods(
          "rest_length_m: 0.05",
          "  - {rod: {radius_m: 1, mass_kg: 1}}\n  - {match: rod}\n  - {match: rod, rods: {}}\n"
          "  - {match: rod, rod: {radius_m: 1, mass_kg: 1}, cable: {}}\n  - {match: a, anchor: "
          "{at: 1}}\n")),
      "robot.yaml:12:5: error: builder needs the key \"match\"\n"
      "robot.yaml:13:5: error: builder needs one of rod, sphere, point_mass, box, convex, cable, "
      "bar, anchor, joint, support\n"
      "robot.yaml:14:5: error: builder needs one of rod, sphere, point_mass, box, convex, cable, "
      "bar, anchor, joint, support\n"
      "robot.yaml:14:18: error: unknown key \"rods\" in builder (did you mean \"rod\"?)\n"
      "robot.yaml:15:50: error: builder has both rod and cable (give only one of them)\n"
      "robot.yaml:16:25: error: unknown key \"at\" in anchor\n");
}

TEST(ModelBuildErrors, BoxesAreAlongPairsOrAtNodes) {
  EXPECT_EQ(Errors(TwoRods(
                "rest_length_m: 0.05",
                "  - {match: a, box: {width_m: 1, height_m: 1, size_m: [1, 1, 1], mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: no pair matches [a] (a box is made from pairs, but these "
            "tags are on nodes)\n"
            "robot.yaml:12:47: error: box has both width_m and size_m (give width_m and height_m "
            "along a pair, size_m or half_extents_m at a node)\n");
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05",
                           "  - {match: a, box: {size_m: [1, -1, 1], mass_kg_per_m: 1}}\n")),
            "robot.yaml:12:21: error: box needs one of mass_kg, density_kg_per_m3\n"
            "robot.yaml:12:30: error: box.size_m must be three positive numbers\n"
            "robot.yaml:12:42: error: a box at a node cannot have a mass per length (give mass_kg "
            "or density_kg_per_m3)\n");
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05", "  - {match: a, box: {mass_kg: 1}}\n")),
            "robot.yaml:12:21: error: box needs one of size_m, half_extents_m, width_m\n");
}

TEST(ModelBuildErrors, NothingIsBuiltTwice) {
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05",
                           "  - {match: a-b, rod: {radius_m: 0.01, mass_kg: 1}}\n"
                           "  - {match: a, point_mass: {mass_kg: 1}}\n  - {match: [[a], [b]], "
                           "point_mass: {mass_kg: 1}}\n")),
            "robot.yaml:12:5: error: \"a-b\" is already a rod, made by the builder in line 10 "
            "(change the tags so that only one of the two builders matches)\n"
            "robot.yaml:14:5: error: \"a\" is already a point_mass, made by the builder in line 13 "
            "(change the tags so that only one of the two builders matches)\n");
}

TEST(ModelBuildErrors, EveryPairHasABuilder) {
  std::string yaml = TwoRods();
  yaml.replace(yaml.find("tags: [cable]"), 13, "tags: [cabel]");
  EXPECT_EQ(
      Errors(yaml),
      "robot.yaml:8:5: error: no builder matches the pair \"a-c\" (its tags are [cabel, a-c])\n"
      "robot.yaml:11:13: error: no pair matches [cable] (tag cable: did you mean \"cabel\"?)\n");
}

TEST(ModelBuildErrors, PairsAreThereOnce) {
  std::string yaml = TwoRods();
  yaml.insert(
      yaml.find("builders"),
      "  - {nodes: [c, a], tags: [cable]}\n  - {name: a-c, nodes: [b, d], tags: [cable]}\n");
  EXPECT_EQ(Errors(yaml),
            "robot.yaml:9:5: error: duplicate pair \"c-a\" (the first is in line 8; to keep both, "
            "give each a `name:`)\n"
            "robot.yaml:10:5: error: duplicate pair \"a-c\" (the first is in line 8; to keep both, "
            "give each a `name:`)\n");
}

TEST(ModelBuildErrors, RodsAndCablesHaveALength) {
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [0, 0, 0]}\npairs: [{nodes: [a, b], tags: [rod]}]\n"
                   "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}, {match: a, "
                   "point_mass: {mass_kg: 1, radius_m: 0.1}}]\n"),
            "robot.yaml:5:9: error: the rod \"a-b\" has no length (its nodes are at the same "
            "position)\n");
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [0, 0, 0]}\npairs: [{nodes: [a, b], tags: [c]}]\n"
                   "builders: [{match: c, cable: {stiffness_n_per_m: 1, rest_length_m: 1}}, "
                   "{match: [[a], [b]], point_mass: {mass_kg: 1}}]\n"),
            "robot.yaml:5:9: error: the cable \"a-b\" has no length between \"a\" and \"b\" (move "
            "one of these nodes: they are at the same position)\n");
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [2, 0, 0]}\npairs: [{nodes: [a, b, c], "
                   "tags: [rod]}]\n"
                   "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}, {match: a, "
                   "point_mass: {mass_kg: 1, radius_m: 0.1}}]\n"),
            "robot.yaml:5:9: error: a rod needs two nodes, but \"a-b-c\" has 3\n");
}

TEST(ModelBuildErrors, ACableOnOneBodyDoesNothing) {
  std::string yaml = TwoRods();
  yaml.replace(yaml.find("[a, c]"), 6, "[b, a]");
  yaml.replace(yaml.find("[a, b]"), 6, "[c, a]");
  EXPECT_NE(Errors(yaml), "");
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{nodes: [a, b], tags: [rod]}, "
                   "{name: string, nodes: [b, a]}]\n"
                   "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}, {match: string, "
                   "cable: {stiffness_n_per_m: 1, rest_length_m: 1}}]\n"),
            "robot.yaml:5:39: error: both ends of the cable \"string\" are on the body \"robot\", "
            "so it has no effect (leave it out, or end it on another body)\n");
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{name: string, nodes: [b, a]}]\n"
                   "builders: [{match: [[a], [b]], anchor: {}}, {match: string, cable: "
                   "{stiffness_n_per_m: 1, rest_length_m: 1}}]\n"),
            "robot.yaml:5:9: error: both ends of the cable \"string\" are on the world, so it has "
            "no effect (leave it out, or end it on another body)\n");
}

TEST(ModelBuildErrors, ACableWhoseNodesHaveNoBodyIsNoSecondError) {
  // Without its rod, the nodes belong to no body, and the cable would count as fixed to the world.
  const std::string errors = Errors(
      "nodes: {a: [0, 0, 0], b: [1, 0, 0]}\n"
      "pairs: [{name: string, nodes: [b, a]}]\n"
      "builders: [{match: string, cable: {stiffness_n_per_m: 1, rest_length_m: 1}}]\n");
  EXPECT_NE(errors.find("no body"), std::string::npos) << errors;
  EXPECT_EQ(errors.find("no effect"), std::string::npos) << errors;
}

TEST(ModelBuildErrors, SurfacesAreThereAndDoNotOverlap) {
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 1, 0]}\n"
                   "pairs: [{nodes: [a, b], tags: [rod]}, {nodes: [a, c], tags: [cable]}]\n"
                   "builders:\n"
                   "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
                   "  - {match: c, point_mass: {mass_kg: 1}}\n"
                   "  - {match: cable, cable: {stiffness_n_per_m: 1, prestress_n: 0.1, ends: "
                   "surface}}\n"),
            "robot.yaml:9:74: error: cable.ends: the node \"c\" of the cable \"a-c\" has no "
            "sphere, and no rod ends there (give the node a sphere, or write `ends: node`)\n");
  EXPECT_EQ(
      Errors(TwoRods("rest_length_m: 0.05, ends: surface",
                     "  - {match: [[a], [c]], sphere: {radius_m: 0.06, mass_kg: 1}}\n")),
      "robot.yaml:8:5: error: the solids at the ends of the cable \"a-c\" overlap, so it has no "
      "length between their surfaces (move the nodes apart, or make the solids smaller)\n");
  std::string thick = TwoRods("rest_length_m: 0.05, ends: surface");
  thick.replace(thick.find("radius_m: 0.01"), 14, "radius_m: 0.06");
  EXPECT_NE(Errors(thick).find("the solids at the ends of the cable \"a-c\" overlap"),
            std::string::npos);
}

TEST(ModelBuildErrors, BodiesHaveInertia) {
  EXPECT_EQ(
      Errors("nodes: {a: [0, 0, 0], b: {at_m: [1, 0, 0], fixed_to: a}}\nbuilders: [{match: "
             "[[a], [b]], point_mass: {mass_kg: 1}}]\n"),
      "robot.yaml:4:9: error: the body \"robot\" has no inertia about a principal axis (give the "
      "point_mass a radius_m: all mass is on one line)\n");
}

TEST(ModelBuildErrors, NumbersThatOverflow) {
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [2, 0, 0]}\n"
                   "pairs: [{each: [[a, b], [b, c]], tags: [rod]}]\n"
                   "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1e308}}]\n"),
            "robot.yaml:5:17: error: the mass or inertia of the body \"robot\" is too large for a "
            "floating-point number\n");
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [1e100, 0, 0]}\npairs: [{nodes: [a, b], tags: [c]}]\n"
                   "builders: [{match: [[a], [b]], point_mass: {mass_kg: 1}}, {match: c, cable: "
                   "{stiffness_n_per_m: 1, rest_length_ratio: 1e300}}]\n"),
            "robot.yaml:5:9: error: the cable \"a-b\" has a rest length that is not finite\n");
}

TEST(ModelBuildErrors, EveryNodeBelongsToABody) {
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{nodes: [a, b], tags: [c]}]\n"
                   "builders: [{match: a, point_mass: {mass_kg: 1}}, {match: c, cable: "
                   "{stiffness_n_per_m: 1, rest_length_m: 1}}]\n"),
            "robot.yaml:4:23: error: node \"b\" belongs to no body (give it a rod, box, sphere or "
            "point_mass, attach it to the body of another node with fixed_to, or fix it in the "
            "world with an anchor)\n");
}

TEST(ModelBuildErrors, BodiesAreConnected) {
  EXPECT_EQ(Errors(std::string(kBars) + "structure: [{part: bar, copies: 3, step_m: [0, 1, 0]}]\n"),
            "robot.yaml:7:13: error: no cable or joint connects the body \"bar_1\" to \"bar_0\" "
            "(if this is intended, write `allow_disconnected: true`)\n"
            "robot.yaml:7:13: error: no cable or joint connects the body \"bar_2\" to \"bar_0\" "
            "(if this is intended, write `allow_disconnected: true`)\n");
}

TEST(ModelBuildErrors, VelocitiesOfJoinedPlacements) {
  EXPECT_EQ(
      Errors(std::string(kBars) +
             "structure: [{part: bar, copies: 2, step_m: [0, 0, 1], velocity_m_per_s: [1, 0, 0]}]\n"
             "pairs: [{name: post, nodes: [bar_0.a, bar_1.a], tags: [rod]}]\n"),
      "robot.yaml:7:13: error: the body \"bar_0.a-b\" joins several placements, so none of them "
      "can have a velocity\n");
}

}  // namespace
}  // namespace taut
