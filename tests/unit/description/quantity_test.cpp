// Numbers with units in model and experiment files
#include "description/yaml/quantity.h"

#include <gtest/gtest.h>

#include "tests/unit/description/errors_of.h"

namespace taut::description {
namespace {

double Value(const char* text, const char* path) {
  const Evaluated result = EvaluateQuantity(text, {{"edge", 3.0}, {"mm", 0.001}}, path);
  EXPECT_EQ(result.error, "") << text;
  return result.value;
}

std::string Error(const char* text, const char* path) {
  const Evaluated result = EvaluateQuantity(text, {{"edge", 1.0}}, path);
  return result.error + (result.hint.empty() ? "" : " (" + result.hint + ")");
}

TEST(Quantity, HasTheBitsOfTheNumberInSi) {
  EXPECT_EQ(Value("4 mm", "rod.radius_m"), 0.004);
  EXPECT_EQ(Value("300mm", "rod.radius_m"), 0.3);
  EXPECT_EQ(Value("1.7 mm", "rod.radius_m"), 0.0017);
  EXPECT_EQ(Value("0.4 N/mm", "cable.stiffness_n_per_m"), 400.0);
  EXPECT_EQ(Value("0.02 N s/mm", "damping_n_s_per_m"), 20.0);
  EXPECT_EQ(Value("30 g", "rod.mass_kg"), 0.03);
  EXPECT_EQ(Value("20 mm^2", "area_m2"), 20e-6);
  EXPECT_EQ(Value("210 GPa", "young_pa"), 210e9);
  EXPECT_EQ(Value("180 deg", "angle_rad"), 3.141592653589793);
  EXPECT_EQ(Value("20 ms", "delay_s"), 0.02);
  EXPECT_EQ(Value("2 N", "force_n"), 2.0);
}

TEST(Quantity, FollowsAnExpression) {
  EXPECT_EQ(Value("(edge + 1) mm", "radius_m"), 0.004);
  EXPECT_EQ(Value("2 * edge mm", "radius_m"), 0.006);
  EXPECT_EQ(Value("1e-1 m", "radius_m"), 0.1);
  EXPECT_EQ(Value("-75 mm", "x_m"), -0.075);
  EXPECT_EQ(Value("1e-3 * 5 mm", "x_m"), 5e-6);
  EXPECT_EQ(Value("2 * -3 mm", "x_m"), -0.006);
}

TEST(Quantity, LeavesExpressionsAsTheyWere) {
  EXPECT_EQ(Value("4 * mm", "radius_m"), 0.004);  // mm is a parameter here
  EXPECT_EQ(Value("edge", "radius_m"), 3.0);
}

TEST(Quantity, RefusesUnitsOfOtherQuantities) {
  EXPECT_EQ(Error("4 N", "rod.radius_m"),
            "\"4 N\" is in N, but this quantity is in m (its units: m, cm, mm, um, in, ft)");
  EXPECT_EQ(Error("4 mm", "rod.friction"),
            "\"4 mm\" has a unit, but this quantity has none (leave out the unit)");
  for (const char* sum :
       {"1 + 300 mm", "1 - 20 mm", "-1 + 2 mm", "pi / 6 - 30 mm", "pi*edge-20mm"}) {
    EXPECT_EQ(Error(sum, "rod.radius_m"),
              "the unit in \"" + std::string(sum) +
                  "\" follows a sum (put the sum in parentheses, or write all numbers in SI "
                  "units)");
  }
  EXPECT_EQ(Error("4 parsec", "rod.radius_m"), "unexpected \"p\" in \"4 parsec\"");
  EXPECT_EQ(Error("mm", "rod.radius_m"), "unknown name \"mm\" (one of: edge)");
}

}  // namespace
}  // namespace taut::description
