// Errors of models that can be read but not built: every message with its line and column
#include <gtest/gtest.h>

#include "unit/description/model_fixture.h"

namespace taut {
namespace {

TEST(ModelBuildErrors, BuildersThatMatchNothing) {
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0.05",
                                "  - {match: cabel, sphere: {radius_m: 1, mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: builder.matches_nothing\n");
  EXPECT_EQ(CodedErrors(TwoRods(
                "rest_length_m: 0.05",
                "  - {match: [[rod, x], [rd]], box: {width_m: 1, height_m: 1, mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: builder.matches_nothing\n"
            "robot.yaml:12:13: error: builder.matches_nothing\n");
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0.05",
                                "  - {match: rod, sphere: {radius_m: 1, mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: builder.matches_nothing\n");
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0.05",
                                "  - {match: [rod, cable], sphere: {radius_m: 1, mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: builder.matches_nothing\n");
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
      CodedErrors(TwoRods(
          "rest_length_m: 0.05",
          "  - {rod: {radius_m: 1, mass_kg: 1}}\n  - {match: rod}\n  - {match: rod, rods: {}}\n"
          "  - {match: rod, rod: {radius_m: 1, mass_kg: 1}, cable: {}}\n  - {match: a, anchor: "
          "{at: 1}}\n")),
      "robot.yaml:12:5: error: key.missing \"match\"\n"
      "robot.yaml:13:5: error: key.one_of_missing point_mass\n"
      "robot.yaml:14:18: error: key.unknown \"rods\"\n"
      "robot.yaml:15:50: error: key.both_given\n"
      "robot.yaml:16:25: error: key.unknown \"at\"\n");
}

TEST(ModelBuildErrors, BoxesAreAlongPairsOrAtNodes) {
  EXPECT_EQ(CodedErrors(TwoRods(
                "rest_length_m: 0.05",
                "  - {match: a, box: {width_m: 1, height_m: 1, size_m: [1, 1, 1], mass_kg: 1}}\n")),
            "robot.yaml:12:13: error: builder.matches_nothing\n"
            "robot.yaml:12:47: error: box.width_given_twice width_m size_m\n");
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0.05",
                                "  - {match: a, box: {size_m: [1, -1, 1], mass_kg_per_m: 1}}\n")),
            "robot.yaml:12:21: error: key.one_of_missing mass_kg density_kg_per_m3\n"
            "robot.yaml:12:30: error: value.not_three_positive box.size_m\n"
            "robot.yaml:12:42: error: box.no_length\n");
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0.05", "  - {match: a, box: {mass_kg: 1}}\n")),
            "robot.yaml:12:21: error: key.one_of_missing size_m half_extents_m width_m\n");
}

TEST(ModelBuildErrors, NothingIsBuiltTwice) {
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0.05",
                                "  - {match: a-b, rod: {radius_m: 0.01, mass_kg: 1}}\n"
                                "  - {match: a, point_mass: {mass_kg: 1}}\n  - {match: [[a], [b]], "
                                "point_mass: {mass_kg: 1}}\n")),
            "robot.yaml:12:5: error: builder.second_builder \"a-b\" 10\n"
            "robot.yaml:14:5: error: builder.second_builder \"a\" point_mass 13\n");
}

TEST(ModelBuildErrors, EveryPairHasABuilder) {
  std::string yaml = TwoRods();
  yaml.replace(yaml.find("tags: [cable]"), 13, "tags: [cabel]");
  EXPECT_EQ(CodedErrors(yaml),
            "robot.yaml:8:5: error: pair.no_builder \"a-c\"\n"
            "robot.yaml:11:13: error: builder.matches_nothing\n");
}

TEST(ModelBuildErrors, PairsAreThereOnce) {
  std::string yaml = TwoRods();
  yaml.insert(
      yaml.find("builders"),
      "  - {nodes: [c, a], tags: [cable]}\n  - {name: a-c, nodes: [b, d], tags: [cable]}\n");
  EXPECT_EQ(CodedErrors(yaml),
            "robot.yaml:9:5: error: pair.duplicate_name \"c-a\"\n"
            "robot.yaml:10:5: error: pair.duplicate_name \"a-c\"\n");
}

TEST(ModelBuildErrors, RodsAndCablesHaveALength) {
  EXPECT_EQ(
      CodedErrors("nodes: {a: [0, 0, 0], b: [0, 0, 0]}\npairs: [{nodes: [a, b], tags: [rod]}]\n"
                  "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}, {match: a, "
                  "point_mass: {mass_kg: 1, radius_m: 0.1}}]\n"),
      "robot.yaml:5:9: error: rod.no_length \"a-b\"\n");
  EXPECT_EQ(CodedErrors("nodes: {a: [0, 0, 0], b: [0, 0, 0]}\npairs: [{nodes: [a, b], tags: [c]}]\n"
                        "builders: [{match: c, cable: {stiffness_n_per_m: 1, rest_length_m: 1}}, "
                        "{match: [[a], [b]], point_mass: {mass_kg: 1}}]\n"),
            "robot.yaml:5:9: error: cable.no_length \"a-b\" \"a\" \"b\"\n");
  EXPECT_EQ(
      CodedErrors("nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [2, 0, 0]}\npairs: [{nodes: [a, b, c], "
                  "tags: [rod]}]\n"
                  "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}, {match: a, "
                  "point_mass: {mass_kg: 1, radius_m: 0.1}}]\n"),
      "robot.yaml:5:9: error: builder.two_nodes_needed \"a-b-c\" 3\n");
}

TEST(ModelBuildErrors, ACableOnOneBodyDoesNothing) {
  std::string yaml = TwoRods();
  yaml.replace(yaml.find("[a, c]"), 6, "[b, a]");
  yaml.replace(yaml.find("[a, b]"), 6, "[c, a]");
  EXPECT_NE(Errors(yaml), "");
  EXPECT_EQ(
      CodedErrors("nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{nodes: [a, b], tags: [rod]}, "
                  "{name: string, nodes: [b, a]}]\n"
                  "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}, {match: string, "
                  "cable: {stiffness_n_per_m: 1, rest_length_m: 1}}]\n"),
      "robot.yaml:5:39: error: cable.both_ends_on_one_body \"string\" \"robot\"\n");
  EXPECT_EQ(
      CodedErrors("nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{name: string, nodes: [b, a]}]\n"
                  "builders: [{match: [[a], [b]], anchor: {}}, {match: string, cable: "
                  "{stiffness_n_per_m: 1, rest_length_m: 1}}]\n"),
      "robot.yaml:5:9: error: cable.both_ends_on_one_body \"string\"\n");
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
  EXPECT_EQ(CodedErrors("nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 1, 0]}\n"
                        "pairs: [{nodes: [a, b], tags: [rod]}, {nodes: [a, c], tags: [cable]}]\n"
                        "builders:\n"
                        "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
                        "  - {match: c, point_mass: {mass_kg: 1}}\n"
                        "  - {match: cable, cable: {stiffness_n_per_m: 1, prestress_n: 0.1, ends: "
                        "surface}}\n"),
            "robot.yaml:9:74: error: cable.end_without_solid cable.ends \"c\" \"a-c\"\n");
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0.05, ends: surface",
                                "  - {match: [[a], [c]], sphere: {radius_m: 0.06, mass_kg: 1}}\n")),
            "robot.yaml:8:5: error: cable.no_length \"a-c\"\n");
  std::string thick = TwoRods("rest_length_m: 0.05, ends: surface");
  thick.replace(thick.find("radius_m: 0.01"), 14, "radius_m: 0.06");
  EXPECT_NE(Errors(thick).find("the solids at the ends of the cable \"a-c\" overlap"),
            std::string::npos);
}

TEST(ModelBuildErrors, BodiesHaveInertia) {
  EXPECT_EQ(
      CodedErrors("nodes: {a: [0, 0, 0], b: {at_m: [1, 0, 0], fixed_to: a}}\nbuilders: [{match: "
                  "[[a], [b]], point_mass: {mass_kg: 1}}]\n"),
      "robot.yaml:4:9: error: body.no_inertia \"robot\"\n");
}

TEST(ModelBuildErrors, NumbersThatOverflow) {
  EXPECT_EQ(CodedErrors("nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [2, 0, 0]}\n"
                        "pairs: [{each: [[a, b], [b, c]], tags: [rod]}]\n"
                        "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1e308}}]\n"),
            "robot.yaml:5:17: error: body.too_large \"robot\"\n");
  EXPECT_EQ(
      CodedErrors("nodes: {a: [0, 0, 0], b: [1e100, 0, 0]}\npairs: [{nodes: [a, b], tags: [c]}]\n"
                  "builders: [{match: [[a], [b]], point_mass: {mass_kg: 1}}, {match: c, cable: "
                  "{stiffness_n_per_m: 1, rest_length_ratio: 1e300}}]\n"),
      "robot.yaml:5:9: error: cable.rest_length_not_finite \"a-b\"\n");
}

TEST(ModelBuildErrors, EveryNodeBelongsToABody) {
  EXPECT_EQ(CodedErrors("nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{nodes: [a, b], tags: [c]}]\n"
                        "builders: [{match: a, point_mass: {mass_kg: 1}}, {match: c, cable: "
                        "{stiffness_n_per_m: 1, rest_length_m: 1}}]\n"),
            "robot.yaml:4:23: error: node.no_body \"b\"\n");
}

TEST(ModelBuildErrors, BodiesAreConnected) {
  EXPECT_EQ(
      CodedErrors(std::string(kBars) + "structure: [{part: bar, copies: 3, step_m: [0, 1, 0]}]\n"),
      "robot.yaml:7:13: error: body.not_connected \"bar_1\" \"bar_0\"\n"
      "robot.yaml:7:13: error: body.not_connected \"bar_2\" \"bar_0\"\n");
}

TEST(ModelBuildErrors, VelocitiesOfJoinedPlacements) {
  EXPECT_EQ(
      CodedErrors(
          std::string(kBars) +
          "structure: [{part: bar, copies: 2, step_m: [0, 0, 1], velocity_m_per_s: [1, 0, 0]}]\n"
          "pairs: [{name: post, nodes: [bar_0.a, bar_1.a], tags: [rod]}]\n"),
      "robot.yaml:7:13: error: body.velocity_of_several_parts \"bar_0.a-b\"\n");
}

}  // namespace
}  // namespace taut
