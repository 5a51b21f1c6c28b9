// Warnings: inputs that are allowed but probably unintended, and distances beyond the precision of
// numbers
#include <gtest/gtest.h>

#include "unit/description/experiment_fixture.h"
#include "unit/description/model_fixture.h"

namespace taut {
namespace {

/// Returns the errors and warnings of a model.
std::string Found(const std::string& yaml, const Overrides& overrides = {}) {
  return ReadModel(yaml, overrides).found;
}

TEST(Diagnostics, WarningsStandBetweenErrorsAndAreNoErrors) {
  Diagnostics out;
  out.Warning("test.odd", {"a.yaml", 2, 1}, "odd");
  EXPECT_TRUE(out.ok());
  EXPECT_TRUE(out.items().empty());
  EXPECT_EQ(out.warnings().size(), 1u);
  out.Error("test.wrong", {"a.yaml", 3, 1}, "wrong");
  out.Error("test.wrong", {"a.yaml", 1, 1}, "wrong", "do right");
  EXPECT_EQ(out.Format(),
            "a.yaml:1:1: error: wrong (do right)\na.yaml:2:1: warning: odd\na.yaml:3:1: error: "
            "wrong\n");
  out.WarningsToErrors();
  EXPECT_EQ(out.items().size(), 3u);
  EXPECT_TRUE(out.warnings().empty());
}

TEST(ModelWarnings, AParameterThatNothingReads) {
  const std::string rod = OneRod("{radius_m: r_m, mass_kg: 1}");
  EXPECT_EQ(Found(rod + "parameters: {r_m: d_m / 2, d_m: 0.02}\n"), "");
  const std::string odd = rod + "parameters: {r_m: 0.01, b: c, c: 2}\n";
  EXPECT_EQ(Found(odd),
            "robot.yaml:7:28: warning: the parameter \"b\" is not used (remove it, or use it in an "
            "expression)\n"
            "robot.yaml:7:34: warning: the parameter \"c\" is not used (remove it, or use it in an "
            "expression)\n");
  EXPECT_EQ(Found(rod + "parameters: {r_m: 0.01, b: 1}\n", {{"b", "3"}}),
            "--set b=3: warning: the parameter \"b\" is not used (remove it, or use it in an "
            "expression)\n");
  // Parameter names in a description do not count as uses.
  EXPECT_NE(Found(rod + "parameters: {r_m: 0.01, b: 1}\ndescription: r_m and b\n"), "");
}

TEST(ModelWarnings, ARodThickerThanItIsLong) {
  EXPECT_EQ(Found(OneRod("{radius_m: 1.5, density_kg_per_m3: 1000}")),
            "robot.yaml:5:9: warning: the rod \"a-b\" has a radius of 1.5 m and a length of 1 m "
            "(use a box or a sphere for a disc: a rod has round ends)\n");
  EXPECT_EQ(Found(OneRod("{radius_m: 1, density_kg_per_m3: 1000}")), "");
}

TEST(ModelWarnings, ADensityThatNothingHas) {
  // pi r^2 l = 3.142e-4 m^3
  EXPECT_EQ(Found(OneRod("{radius_m: 0.01, mass_kg: 3e-5}")),
            "robot.yaml:5:9: warning: the body \"robot\" has a mass of 3e-05 kg in a volume of "
            "0.0003142 m^3: its density is 0.09549 kg/m^3 (check the units: air has 1.2 kg/m^3)\n");
  EXPECT_EQ(
      Found(OneRod("{radius_m: 0.01, mass_kg: 315}")),
      "robot.yaml:5:9: warning: the body \"robot\" has a mass of 315 kg in a volume of 0.0003142 "
      "m^3: its density is 1.003e+06 kg/m^3 (check the units: osmium has 22600 kg/m^3)\n");
  EXPECT_EQ(Found(OneRod("{radius_m: 0.01, mass_kg: 314}")), "");
  EXPECT_EQ(Found(OneRod("{radius_m: 0.01, mass_kg: 3.2e-5}")), "");
}

/// Three unconnected rods with the given builders
std::string ThreeRods(const std::string& a, const std::string& b) {
  return "nodes: {a: [0, 0, 0], b: [9, 0, 0], c: [0, 1, 0], d: [9, 1, 0]}\n"
         "pairs:\n"
         "  - {name: x, nodes: [a, b], tags: [one]}\n"  // line 6
         "  - {name: y, nodes: [c, d], tags: [two]}\n"
         "allow_disconnected: true\n"
         "builders:\n"
         "  - {match: one, rod: {" +
         a + "}}\n  - {match: two, rod: {" + b + "}}\n";
}

TEST(ModelWarnings, SizesMassesAndStiffnessesFarApart) {
  const std::string right = ", density_kg_per_m3: 1000";
  EXPECT_EQ(Found(ThreeRods("radius_m: 0.001" + right, "radius_m: 1" + right)), "");
  EXPECT_EQ(
      Found(ThreeRods("radius_m: 0.001" + right, "radius_m: 1.1, mass_kg: 100")),
      "robot.yaml:7:5: warning: the half thickness of the rod \"y\" (1.1 m) is 1100 times the half "
      "thickness of the rod \"x\" (0.001 m) (check the units: the ratio is above 1000)\n");
  EXPECT_EQ(Found(ThreeRods("radius_m: 0.1, mass_kg: 0.1", "radius_m: 0.1, mass_kg: 100001")),
            "robot.yaml:7:5: warning: the mass of the body \"y\" (1e+05 kg) is 1e+06 times the "
            "mass of the body \"x\" (0.1 kg) (check the units: the ratio is above 1e+06)\n");
  const std::string cables =
      TwoRods("rest_length_m: 0.05",
              "  - {match: far, cable: {stiffness_n_per_m: 2e8, rest_length_m: "
              "0.1}}\n");
  std::string far = cables;
  far.replace(far.find("builders:"), 9, "  - {nodes: [b, d], tags: [far]}\nbuilders:");
  EXPECT_EQ(
      Found(far),
      "robot.yaml:9:5: warning: the stiffness of the cable \"b-d\" (2e+08 N/m) is 2e+06 times the "
      "stiffness of the cable \"a-c\" (100 N/m) (check the units: the ratio is above 1e+06)\n");
}

TEST(ModelWarnings, CopiesOfOneMistakeAreOneWarning) {
  const std::string found = Found(
      "parts: {bar: {nodes: {a: [0, 0, 0], b: [1, 0, 0]}, pairs: [{nodes: [a, b], tags: [rod]}]}}\n"
      "builders: [{match: rod, rod: {radius_m: 2, mass_kg: 1e4}}]\n"
      "structure: [{part: bar, copies: 50, step_m: [0, 5, 0]}]\n"
      "allow_disconnected: true\n");
  EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 1) << found;
}

TEST(FarAway, PositionsThatAreRoundedCoarserThanAMillionthOfTheRadius) {
  const auto rod_at = [](const std::string& x) {
    return "nodes: {a: [" + x + ", 0, 0], b: [" + x +
           " + 1, 0, 0]}\npairs: [{nodes: [a, b], tags: [rod]}]\n"
           "builders: [{match: rod, rod: {radius_m: 0.01, mass_kg: 1}}]\n";
  };
  // From 2^26 m on the next number is 1.5e-8 m away; below, half of that.
  EXPECT_EQ(Found(rod_at("6.7e7")), "");
  EXPECT_NE(Found(rod_at("6.8e7")), "");
  EXPECT_EQ(Found(rod_at("1e10")),
            "robot.yaml:4:9: error: the node \"a\" is 1e+10 m from the origin, where positions are "
            "rounded to 1.907e-06 m (the rounding may be at most a millionth of the smallest size, "
            "0.01 m of the rod \"a-b\")\n");
  EXPECT_NE(Found(rod_at("-1e12")), "");
}

using FarAwayExperiment = test::ExperimentErrors;

TEST_F(FarAwayExperiment, PlaceAndTerrain) {
  const std::string end =
      " (the rounding may be at most a millionth of the smallest size, 0.01 m of the rod \"a\")";
  const std::string record = "record: {rate_hz: 50}";
  Expect(record, "place: {at_m: [0, 0, 1e300]}",
         "21:8: error: the node \"a0\" is 1e+300 m from the origin, where positions are rounded to "
         "1.487e+284 m" +
             end);
  Expect(record, "place: {at_m: [1e10, 0, 0]}",
         "21:8: error: the node \"a0\" is 1e+10 m from the origin, where positions are rounded to "
         "1.907e-06 m" +
             end);
  Expect(
      "height_m: 0,", "height_m: -1e10,",
      "7:5: error: the plane \"ground\" is 1e+10 m from the origin, where positions are rounded to "
      "1.907e-06 m" +
          end);
  // A displacement along the surface has no effect.
  Change("height_m: 0,", "normal: [0, 0, 1], point_m: [1e10, 0, 0],");
  EXPECT_EQ(Complaints(), "");
  Expect(
      "plane: {height_m: 0, friction: 0.5}", "box: {center_m: [0, 0, 0], size_m: [1e11, 1, 1]}",
      "7:5: error: the box \"ground\" is 5e+10 m from the origin, where positions are rounded to "
      "7.629e-06 m" +
          end);
}

TEST_F(FarAwayExperiment, ParametersOfAnExperimentAreReadToo) {
  Change("{push_n: 10}", "{push_n: 10, idle: 2}");
  Diagnostics out;
  EXPECT_TRUE(LoadExperiment(Path("trial.yaml"), {}, out));
  EXPECT_EQ(Without(Path(""), out.Format()),
            "trial.yaml:5:32: warning: the parameter \"idle\" is not used (remove it, or use it in "
            "an expression)\n");
}

}  // namespace
}  // namespace taut
