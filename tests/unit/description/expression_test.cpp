// Expressions in files, and named parameters
#include "description/yaml/expression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "description/yaml/file_parameters.h"

namespace taut::description {
namespace {

const NameTable kNames{{"edge_m", 0.38}, {"n", 3.0}, {"bad", NAN}};

double Value(const std::string& text) {
  const Evaluated result = Evaluate(text, kNames);
  EXPECT_EQ(result.error, "") << text;
  return result.value;
}

/// "error (hint)"
std::string Error(const std::string& text) {
  const Evaluated result = Evaluate(text, kNames);
  EXPECT_TRUE(std::isnan(result.value)) << text;
  return result.hint.empty() ? result.error : result.error + " (" + result.hint + ")";
}

TEST(Expression, NumbersReadAsTheNearestDouble) {
  EXPECT_EQ(Value("1"), 1.0);
  EXPECT_EQ(Value(" 0.1 "), 0.1);
  EXPECT_EQ(Value("1e-3"), 1e-3);
  EXPECT_EQ(Value(".5"), 0.5);
  EXPECT_EQ(Value("2."), 2.0);
  EXPECT_EQ(Value("229.16"), 229.16);
  EXPECT_EQ(Value("1E+2"), 100.0);
}

TEST(Expression, OperatorsBindAsInMathematics) {
  EXPECT_EQ(Value("1 + 2 * 3"), 7.0);
  EXPECT_EQ(Value("(1 + 2) * 3"), 9.0);
  EXPECT_EQ(Value("8 - 4 - 2"), 2.0);
  EXPECT_EQ(Value("8 / 4 / 2"), 1.0);
  EXPECT_EQ(Value("2 ^ 3 ^ 2"), 512.0);
  EXPECT_EQ(Value("-2 ^ 2"), -4.0);
  EXPECT_EQ(Value("(-2) ^ 3"), -8.0);
  EXPECT_EQ(Value("2 ^ -1"), 0.5);
  EXPECT_EQ(Value("--3"), 3.0);
  EXPECT_EQ(Value("3 * -2"), -6.0);
  EXPECT_EQ(Value("+3"), 3.0);
}

TEST(Expression, NamesStandForParameters) {
  EXPECT_EQ(Value("edge_m"), 0.38);
  EXPECT_EQ(Value("-edge_m / 2"), -0.19);
  EXPECT_EQ(Value("2*n"), 6.0);
  EXPECT_EQ(Value("pi"), 3.14159265358979323846);
}

TEST(Expression, FunctionsAreWhatTheyAreCalled) {
  EXPECT_EQ(Value("sqrt(9)"), 3.0);
  EXPECT_EQ(Value("abs(-2)"), 2.0);
  EXPECT_EQ(Value("min(3, 1, 2)"), 1.0);
  EXPECT_EQ(Value("max(3, 1, 2)"), 3.0);
  EXPECT_EQ(Value("floor(-1.5)"), -2.0);
  EXPECT_EQ(Value("ceil(-1.5)"), -1.0);
  EXPECT_EQ(Value("round(-1.5)"), -2.0);
  EXPECT_EQ(Value("round(2.4)"), 2.0);
  EXPECT_EQ(Value("exp(0)"), 1.0);
  EXPECT_EQ(Value("log(1)"), 0.0);
  EXPECT_EQ(Value("cos(0)"), 1.0);
  EXPECT_EQ(Value("sin(0)"), 0.0);
  EXPECT_EQ(Value("tan(0)"), 0.0);
  EXPECT_NEAR(Value("asin(0.5)"), std::asin(0.5), 2e-16);
  EXPECT_NEAR(Value("acos(0.5)"), std::acos(0.5), 3e-16);
  EXPECT_NEAR(Value("atan(2)"), std::atan(2.0), 3e-16);
  EXPECT_NEAR(Value("atan2(1, -1)"), 3 * std::atan(1.0), 5e-16);
  EXPECT_NEAR(Value("edge_m / 2 * tan(pi / 6)"), 0.19 / std::sqrt(3.0), 1e-16);
}

TEST(Expression, EveryMistakeHasItsMessage) {
  EXPECT_EQ(Error(""), "the expression is empty");
  EXPECT_EQ(Error("  "), "the expression is empty");
  EXPECT_EQ(Error("1 +"), "the expression is incomplete");
  EXPECT_EQ(Error("(1 + 2"), "\")\" is missing");
  EXPECT_EQ(Error("1 + 2)"), "unexpected \")\" in \"1 + 2)\"");
  EXPECT_EQ(Error("1 2"), "unexpected \"2\" in \"1 2\"");
  EXPECT_EQ(Error("2 ** 3"), "unexpected \"*\" in \"2 ** 3\" (write powers with ^)");
  EXPECT_EQ(Error("5 % 2"), "unexpected \"%\" in \"5 % 2\"");
  EXPECT_EQ(Error("5 µm"), "unexpected \"µ\" in \"5 µm\"");
  EXPECT_EQ(Error("3 m"), "unexpected \"m\" in \"3 m\"");
  EXPECT_EQ(
      Error("3m"),
      "\"m\" directly follows the number 3 (write products with `*`, and values without units)");
  EXPECT_EQ(Error("1e999"), "the number 1e999 is out of range");
  EXPECT_EQ(Error("edge"), "unknown name \"edge\" (did you mean \"edge_m\"?)");
  EXPECT_EQ(Error("sqrt"), "sqrt is a function and needs arguments (write sqrt(...))");
  EXPECT_EQ(Error("sine(1)"), "unknown function \"sine\" (did you mean \"sin\"?)");
  EXPECT_EQ(Error("atan2(1)"), "atan2 takes 2 arguments, got 1");
  EXPECT_EQ(Error("sin(1, 2)"), "sin takes 1 argument, got 2");
  EXPECT_EQ(Error("min(1)"), "min takes 2 or more arguments, got 1");
  EXPECT_EQ(Error("1 / 0"), "division by zero");
  EXPECT_EQ(Error("1 / (n - 3)"), "division by zero");
  EXPECT_EQ(Error("0 ^ -1"), "division by zero (0 is raised to a negative power)");
  EXPECT_EQ(Error("(-8) ^ (1/3)"),
            "a negative number to a fractional power (use a positive base, or a whole number as "
            "exponent)");
  EXPECT_EQ(Error("sqrt(-1)"), "sqrt of a negative number");
  EXPECT_EQ(Error("acos(1.1)"), "acos of a number outside -1..1");
  EXPECT_EQ(Error("log(0)"), "log of a number that is not positive");
  EXPECT_EQ(Error("sin(1e10)"), "sin of an angle beyond 1e9 rad (angles are in rad)");
  EXPECT_EQ(Error("exp(1000)"), "exp is too large for a number");
  EXPECT_EQ(Error("1e300 * 1e300"), "a product is too large for a number");
  EXPECT_EQ(Error("1e308 + 1e308"), "a sum is too large for a number");
  EXPECT_EQ(Error(std::string(500, '(') + "1"), "the expression is nested too deeply");
  EXPECT_EQ(Error(std::string(5000, '-') + "1"), "the expression is nested too deeply");
  EXPECT_EQ(Error("1" + std::string(10'000, ' ')), "the expression is too long");
  EXPECT_EQ(Error(std::string(100, 'x')), "unknown name \"" + std::string(100, 'x') + "\"");
}

TEST(Expression, AnUnknownNameWithoutParametersSaysSo) {
  EXPECT_EQ(Evaluate("edge_m", {}).hint, "no parameters are defined");
}

TEST(Expression, WhatUsesAFaultyParameterStaysSilent) {
  for (const char* text :
       {"bad", "bad + 1", "sqrt(bad)", "max(1, bad)", "max(bad, 1)", "1 / bad", "bad ^ 2"}) {
    EXPECT_EQ(Error(text), "") << text;
  }
}

TEST(Expression, NamesInFindsEachParameterOnce) {
  EXPECT_EQ(NamesIn("a + sqrt(b) * a - pi + 1e3 + 2.5e-3*c2"),
            (std::vector<std::string>{"a", "b", "c2"}));
  EXPECT_TRUE(NamesIn("1e5 + 3").empty());
}

// --- parameters ------------------------------------------------------------------------------

/// Reads `parameters:` from a text in which they start at line 1.
NameTable Resolve(const std::string& yaml, const Overrides& overrides, Diagnostics& out) {
  const ValuePtr block = ParseYaml(yaml, "p.yaml", out);
  std::vector<ParameterText> parameters = ReadParameters(block.get(), out);
  OverrideSet set(overrides);
  set.Apply(parameters);
  std::vector<std::string> known;
  for (const ParameterText& parameter : parameters) known.push_back(parameter.name);
  set.ReportUnused(known, out);
  return ResolveParameters(parameters, out);
}

std::string ErrorsOf(const std::string& yaml, const Overrides& overrides = {}) {
  Diagnostics out;
  Resolve(yaml, overrides, out);
  return out.Format();
}

TEST(Parameters, MayReferToEachOtherInAnyOrder) {
  Diagnostics out;
  const NameTable values = Resolve("a: b + 1\nb: 2 * c\nc: 3\nd: a * b\n", {}, out);
  EXPECT_EQ(out.Format(), "");
  EXPECT_EQ(values, (NameTable{{"a", 7}, {"b", 6}, {"c", 3}, {"d", 42}}));
}

TEST(Parameters, AChainOfThousandsIsFine) {
  std::string yaml;
  for (int i = 0; i < 5000; ++i)
    yaml += "p" + std::to_string(i) + ": p" + std::to_string(i + 1) + " + 1\n";
  Diagnostics out;
  EXPECT_EQ(Resolve(yaml + "p5000: 0\n", {}, out).at("p0"), 5000.0);
  EXPECT_TRUE(out.ok());
}

TEST(Parameters, ACircleIsAnErrorThatShowsIt) {
  EXPECT_EQ(ErrorsOf("a: b\nb: c + 1\nc: a\n"),
            "p.yaml:1:4: error: parameters refer to each other in a circle: a -> b -> c -> a\n");
  EXPECT_EQ(ErrorsOf("a: a + 1\n"),
            "p.yaml:1:4: error: parameters refer to each other in a circle: a -> a\n");
  EXPECT_EQ(ErrorsOf("user: a\na: b\nb: a\n"),
            "p.yaml:2:4: error: parameters refer to each other in a circle: a -> b -> a\n");
}

TEST(Parameters, OverridesReplaceAndMayUseOtherParameters) {
  Diagnostics out;
  const NameTable values = Resolve("edge_m: 0.38\nhalf_m: edge_m / 2\nn: 3\n",
                                   {{"edge_m", "0.1 * n"}, {"n", "4"}, {"n", "5"}}, out);
  EXPECT_EQ(out.Format(), "");
  EXPECT_EQ(values.at("half_m"), 0.25);
}

TEST(Parameters, AnUnknownOverrideIsAnErrorWithAHint) {
  EXPECT_EQ(ErrorsOf("edge_m: 1\n", {{"edge", "2"}}),
            "--set edge=2: error: there is no parameter \"edge\" (did you mean \"edge_m\"?)\n");
  EXPECT_EQ(ErrorsOf("{}\n", {{"edge", "2"}}),
            "--set edge=2: error: there is no parameter \"edge\" (the file has no parameters)\n");
}

TEST(Parameters, AFaultyOverrideNamesItself) {
  EXPECT_EQ(ErrorsOf("edge_m: 1\n", {{"edge_m", "2 q"}}),
            "--set edge_m=2 q: error: parameters.edge_m: unexpected \"q\" in \"2 q\"\n");
}

TEST(Parameters, EachFaultIsReportedOnceAndItsUsersStaySilent) {
  EXPECT_EQ(ErrorsOf("a: 1 / 0\nb: a + 1\nc: [1, 2]\nd: c + b\n"),
            "p.yaml:1:4: error: parameters.a: division by zero\n"
            "p.yaml:3:4: error: parameters.c must be a number or an expression, got a list\n");
}

TEST(Parameters, NamesAreIdentifiersAndNotReserved) {
  EXPECT_EQ(ErrorsOf("2x: 1\na-b: 1\npi: 3\nsin: 1\n"),
            "p.yaml:1:1: error: \"2x\" cannot be the name of a parameter (use letters, digits and "
            "_, and no digit first)\n"
            "p.yaml:2:1: error: \"a-b\" cannot be the name of a parameter (use letters, digits and "
            "_, and no digit first)\n"
            "p.yaml:3:1: error: \"pi\" is the name of a function or constant\n"
            "p.yaml:4:1: error: \"sin\" is the name of a function or constant\n");
  EXPECT_EQ(ErrorsOf("[1]\n"),
            "p.yaml:1:1: error: parameters must be a map, got a list (write "
            "`parameters: {edge_m: 0.4}`)\n");
}

TEST(Parameters, AHintPointsAtTheLikelyName) {
  EXPECT_EQ(
      ErrorsOf("edge_m: 1\nhalf_m: egde_m / 2\n"),
      "p.yaml:2:9: error: parameters.half_m: unknown name \"egde_m\" (did you mean \"edge_m\"?)\n");
}

}  // namespace
}  // namespace taut::description
