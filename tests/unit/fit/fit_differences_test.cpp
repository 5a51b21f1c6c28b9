/// Derivatives by differences of two step sizes, and their checks
#include <gtest/gtest.h>

#include <cmath>

#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::MakeProblem;
using test::Parameter;

FitDerivatives Of(const FitParameter& p, double value, const std::function<double(double)>& f) {
  return Differentiate(MakeProblem({p}, 1,
                                   [f](const std::vector<double>& v) -> Residuals {
                                     return {{f(v[0])}, ""};
                                   }),
                       {value});
}

TEST(FitDifferences, ASlopeIsOfFourthOrder) {
  const auto error = [](double step) {
    FitParameter p = Parameter("x", 0);
    p.step = step;
    const auto of = Of(p, 0.4, [](double x) { return std::sin(x); });
    EXPECT_FALSE(of.columns[0].kink);
    return std::fabs(of.columns[0].slope[0] - std::cos(0.4));
  };
  // h^4 / 480 of the fifth derivative, from the series of both central differences
  EXPECT_NEAR(error(0.2), 0.2 * 0.2 * 0.2 * 0.2 / 480 * std::cos(0.4), 2e-8);
  EXPECT_NEAR(error(0.2) / error(0.1), 16, 0.2);
}

TEST(FitDifferences, ASlopeIsInTheParametersUnitWhateverItsScale) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const auto of = Of(Parameter("x", 0, scale), 5, [](double x) { return 3 * x; });
    EXPECT_NEAR(of.columns[0].slope[0], 3, 1e-9);
    EXPECT_NEAR(of.columns[0].error, 0, 1e-9 * scale);
  }
}

TEST(FitDifferences, NextToABoundOneSideServes) {
  FitParameter p = Parameter("x", 0);
  p.low = 0;
  p.high = 10;
  const auto cubic = [](double x) { return x * x * x + x * x - 2 * x; };
  // One-sided of second order, extrapolated: exact for the slope of a cubic.
  EXPECT_NEAR(Of(p, 0, cubic).columns[0].slope[0], -2, 1e-10);
  EXPECT_NEAR(Of(p, 10, cubic).columns[0].slope[0], 318, 1e-9);
  EXPECT_FALSE(Of(p, 10, cubic).columns[0].kink);
  p.high = 0.01;  // narrower than the step
  EXPECT_NEAR(Of(p, 0, cubic).columns[0].slope[0], -2, 1e-10);
  EXPECT_NEAR(Of(p, 0.005, cubic).columns[0].slope[0], 3 * 0.005 * 0.005 + 0.01 - 2, 1e-9);
}

TEST(FitDifferences, AKinkIsSeenWhereverItLiesInTheStep) {
  const auto kinked = [](double x) { return 20 * std::fabs(x) + 3 * x; };
  EXPECT_TRUE(Of(Parameter("x", 0), 0, kinked)
                  .columns[0]
                  .kink);  // symmetric: detected by second differences
  EXPECT_TRUE(Of(Parameter("x", 0), 0.02, kinked).columns[0].kink);
  EXPECT_TRUE(Of(Parameter("x", 0), 0.08, kinked).columns[0].kink);
  EXPECT_FALSE(Of(Parameter("x", 0), 0.2, kinked).columns[0].kink);  // beyond the step
  // A jump, as if another contact slipped.
  EXPECT_TRUE(
      Of(Parameter("x", 0), 0.03, [](double x) { return x > 0 ? 1 + x : x; }).columns[0].kink);
}

TEST(FitDifferences, AKinkOfNoConsequenceIsNone) {
  EXPECT_FALSE(
      Of(Parameter("x", 0), 0, [](double x) { return 0.01 * std::fabs(x); }).columns[0].kink);
}

TEST(FitDifferences, WhatBeginsWithTheSquareIsCurvedNotSteep) {
  const FitColumn column =
      Of(Parameter("bow", 0), 0, [](double x) { return 5 * x * x; }).columns[0];
  EXPECT_EQ(column.slope[0], 0);
  EXPECT_NEAR(column.curved, 10 * 0.1, 1e-12);  // f'' h
  EXPECT_FALSE(column.kink);
}

TEST(FitDifferences, AFailedPointIsNamedAndItsOtherSideServes) {
  const auto problem = MakeProblem({Parameter("x", 0)}, 1, [](const std::vector<double>& v) {
    return v[0] > 0.01 ? Residuals{{}, "slack"} : Residuals{{4 * v[0]}, ""};
  });
  const FitDerivatives of = Differentiate(problem, {0});
  ASSERT_TRUE(of.done);
  EXPECT_EQ(of.columns[0].failed, "slack");
  EXPECT_NEAR(of.columns[0].slope[0], 4, 1e-12);
  EXPECT_FALSE(Differentiate(problem, {1}).done);
  EXPECT_EQ(Differentiate(problem, {1}).why, "slack");
}

TEST(FitDifferences, AStepThatIsTooLongIsShortened) {
  // An oscillation of 20 periods whose frequency is x: over a step of 0.1 its phase changes by 2
  // pi.
  const auto swing = [](double x) { return 1e4 * std::sin(62.8 * x); };
  const FitColumn column = Of(Parameter("x", 0), 0.4, swing).columns[0];
  EXPECT_FALSE(column.kink);
  EXPECT_LT(column.step_share, 1);
  EXPECT_NEAR(column.slope[0], 1e4 * 62.8 * std::cos(62.8 * 0.4), 1e4 * 62.8 * 1e-3);
  // If the data determine so little that the standard error exceeds that step, the warning remains.
  const auto faint = [](double x) { return std::sin(62.8 * x); };
  EXPECT_TRUE(Of(Parameter("x", 0), 0.4, faint).columns[0].kink);
}

TEST(FitDifferences, AStepThatResolvesIsLeftAlone) {
  const FitColumn column =
      Of(Parameter("x", 0), 0.4, [](double x) { return std::sin(x); }).columns[0];
  EXPECT_EQ(column.step_share, 1);
  EXPECT_NEAR(column.step, 0.1, 1e-15);
}

TEST(FitDifferences, AllPointsAreOneCall) {
  auto problem = MakeProblem({Parameter("x", 0), Parameter("y", 0)}, 1, {});
  int calls = 0;
  std::size_t asked = 0;
  problem.forward = [&](std::span<const std::vector<double>> points) {
    ++calls;
    asked = points.size();
    return std::vector<Residuals>(points.size(), Residuals{{0.0}, ""});
  };
  EXPECT_TRUE(Differentiate(problem, {0, 0}).done);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(asked, 9u);
}

}  // namespace
}  // namespace taut
