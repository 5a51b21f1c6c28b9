/// Verdicts on parameters of a fit, against closed forms
#include <gtest/gtest.h>

#include <cmath>

#include "taut/fit_verdict.h"
#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::MakeProblem;
using test::Parameter;

Identifiability At(const FitProblem& problem, const std::vector<double>& values) {
  return Identify(problem, values, Differentiate(problem, values));
}

/// y_i = f(x_i; v), x = 1 .. rows, with this sd
FitProblem Curve(std::vector<FitParameter> parameters, std::size_t rows, double sd,
                 const std::function<double(double, const std::vector<double>&)>& f) {
  return MakeProblem(std::move(parameters), rows, [=](const std::vector<double>& v) {
    Residuals r;
    for (std::size_t i = 1; i <= rows; ++i) r.value.push_back(f(static_cast<double>(i), v) / sd);
    return r;
  });
}

TEST(FitVerdict, StandardErrorsOfALineAreTheTextbooks) {
  // y = a + b x at x = 1 .. 9, sd 0.1: var b = sd^2 / Sxx, var a = sd^2 (1 / n + mean^2 / Sxx)
  const auto problem = Curve({Parameter("a", 0), Parameter("b", 0, 0.1)}, 9, 0.1,
                             [](double x, const auto& v) { return v[0] + v[1] * x; });
  const Identifiability of = At(problem, {0, 0});
  EXPECT_NEAR(of.parameters[1].se, 0.1 / std::sqrt(60), 1e-9);
  EXPECT_NEAR(of.parameters[0].se, 0.1 * std::sqrt(1.0 / 9 + 25.0 / 60), 1e-9);
  EXPECT_NEAR(of.parameters[0].se_alone, 0.1 / 3, 1e-9);
  EXPECT_NEAR(of.correlation[1], -5 / std::sqrt(285.0 / 9), 1e-9);
  EXPECT_NEAR(of.covariance[1], -0.01 * 5 / 60, 1e-10);
  EXPECT_EQ(of.parameters[0].kind, Determined::kEstimated);
  EXPECT_EQ(of.parameters[1].kind, Determined::kEstimated);
  EXPECT_NEAR(of.effective, 2, 1e-9);
  EXPECT_EQ(of.fixed, 2);
}

/// NIST's Statistical Reference Datasets, MGH09: certified standard deviations of the parameters
TEST(FitVerdict, StandardErrorsAreNistsCertifiedOnes) {
  const std::vector<double> u = {4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625};
  const std::vector<double> b = {1.9280693458e-1, 1.9128232873e-1, 1.2305650693e-1,
                                 1.3606233068e-1};
  std::vector<FitParameter> p;
  for (const double x : b) p.push_back(Parameter(std::to_string(p.size()), x));
  for (FitParameter& one : p) one.step = 1e-3;
  const double residual_sd = 6.6279236551e-3;
  const auto problem = MakeProblem(p, u.size(), [&](const std::vector<double>& x) {
    Residuals r;
    for (const double t : u) {
      r.value.push_back(x[0] * (t * t + t * x[1]) / (t * t + t * x[2] + x[3]) / residual_sd);
    }
    return r;
  });
  const std::vector<double> certified = {1.1435312227e-2, 1.9633220911e-1, 8.0842031232e-2,
                                         9.0025542308e-2};
  const Identifiability of = At(problem, b);
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(of.parameters[j].se / certified[j], 1, 1e-6) << j;
  }
}

TEST(FitVerdict, AnAliasIsNamedAndHasNoFiniteError) {
  // y = (a + b) x + c: a pseudo-inverse would give a and b half of their sum's error.
  std::vector<FitParameter> p = {Parameter("a", 1), Parameter("b", 2, 0.5), Parameter("c", 0)};
  p[0].unit = p[1].unit = "N";
  const auto problem =
      Curve(p, 9, 0.1, [](double x, const auto& v) { return (v[0] + v[1]) * x + v[2]; });
  const Identifiability of = At(problem, {1, 2, 0});
  EXPECT_EQ(of.parameters[0].kind, Determined::kConfounded);
  EXPECT_EQ(of.parameters[1].kind, Determined::kConfounded);
  EXPECT_EQ(of.parameters[2].kind, Determined::kEstimated);
  EXPECT_TRUE(std::isinf(of.parameters[0].se));
  EXPECT_TRUE(std::isinf(of.parameters[1].se));
  EXPECT_NEAR(of.parameters[2].se, 0.1 * std::sqrt(1.0 / 9 + 25.0 / 60), 1e-9);
  EXPECT_TRUE(std::isinf(of.condition));
  EXPECT_TRUE(of.directions[2].null);
  EXPECT_EQ(of.endless, 1);
  ASSERT_EQ(of.parameters[0].confounded_with.size(), 2u);
  EXPECT_EQ(of.parameters[0].confounded_with[1].first, 1u);
  EXPECT_NEAR(
      of.parameters[0].confounded_with[1].second / of.parameters[0].confounded_with[0].second, -1,
      1e-9);
  EXPECT_NEAR(of.parameters[0].confounded_residual, 0, 1e-6);
  EXPECT_NE(
      of.parameters[0].sentence.find("a = 1 N +- infinite: confounded with b; +1 N with b -1 N"),
      std::string::npos)
      << of.parameters[0].sentence;
}

TEST(FitVerdict, AnAliasOfAProductIsSeenThroughTheErrorsOfDifferences) {
  const auto problem =
      Curve({Parameter("a", 1, 0.7), Parameter("b", 2, 0.3)}, 9, 0.01,
            [](double x, const auto& v) { return std::sin(0.3 * v[0] * v[1] * x); });
  const Identifiability of = At(problem, {1, 2});
  EXPECT_TRUE(std::isinf(of.parameters[0].se));
  EXPECT_EQ(of.parameters[0].kind, Determined::kConfounded);
  // Along a b = const: da = -a / b db
  EXPECT_NEAR(
      of.parameters[0].confounded_with[1].second / of.parameters[0].confounded_with[0].second, -2,
      1e-3);
}

TEST(FitVerdict, APriorMakesAnAliasFiniteAndItIsStillConfounded) {
  std::vector<FitParameter> p = {Parameter("a", 0, 0), Parameter("b", 0, 0)};
  p[0].prior_sd = 2;
  p[1].prior_sd = 2;
  const auto problem = Curve(p, 4, 1e-3, [](double, const auto& v) { return v[0] + v[1]; });
  const Identifiability of = At(problem, {0, 0});
  // The sum is known, so that each parameter keeps half of its prior variance.
  EXPECT_NEAR(of.parameters[0].se, 2 / std::sqrt(2.0), 1e-6);
  EXPECT_EQ(of.parameters[0].kind, Determined::kConfounded);
  EXPECT_EQ(of.fixed, 1);
  EXPECT_EQ(of.endless, 0);
  EXPECT_NEAR(of.effective, 1, 1e-5);
}

TEST(FitVerdict, WhatAPriorHoldsIsSaid) {
  FitParameter p = Parameter("mass", 1, 0);
  p.prior_sd = 0.1;
  const auto problem = Curve({p}, 4, 1, [](double, const auto& v) { return 3 * v[0]; });
  const Identifiability of = At(problem, {1});
  // 1 / se^2 = 4 * 9 + 100
  EXPECT_NEAR(of.parameters[0].se, 1 / std::sqrt(136.0), 1e-9);
  EXPECT_EQ(of.parameters[0].kind, Determined::kPrior);
  EXPECT_EQ(of.parameters[0].sentence,
            "mass = 1 +- 0.08575: held by its prior; the data leave 85.75 % of its standard "
            "deviation");
  EXPECT_NEAR(of.effective, 36.0 / 136, 1e-9);
}

TEST(FitVerdict, WhatNothingReadsIsDead) {
  const auto problem = Curve({Parameter("k", 3), Parameter("unused", 1)}, 4, 0.1,
                             [](double x, const auto& v) { return v[0] * x; });
  const Identifiability of = At(problem, {3, 1});
  EXPECT_EQ(of.parameters[0].kind, Determined::kEstimated);
  EXPECT_EQ(of.parameters[1].kind, Determined::kDead);
  EXPECT_TRUE(std::isinf(of.parameters[1].se));
  EXPECT_EQ(of.parameters[1].sentence, "unused: without influence; no residual depends on it");
  const auto bow =
      Curve({Parameter("bow", 0)}, 4, 0.1, [](double x, const auto& v) { return v[0] * v[0] * x; });
  EXPECT_EQ(At(bow, {0}).parameters[0].sentence,
            "bow: without influence here; residuals depend on it only to second order");
}

TEST(FitVerdict, WhatIsTooWeakWithoutAPriorIsSaid) {
  const auto problem =
      Curve({Parameter("k", 3)}, 4, 10, [](double, const auto& v) { return v[0]; });
  const Identifiability of = At(problem, {3});
  EXPECT_EQ(of.parameters[0].kind, Determined::kWeak);
  EXPECT_NEAR(of.parameters[0].se, 5, 1e-9);
}

TEST(FitVerdict, AParameterAtItsBoundIsSaidAndOthersAreKnownGivenIt) {
  std::vector<FitParameter> p = {Parameter("a", 1), Parameter("b", 0)};
  p[0].high = 1;
  // The minimum of the data is at a = 2.
  const auto problem =
      Curve(p, 9, 0.1, [](double x, const auto& v) { return v[0] + v[1] * x - 2; });
  const FitResult fit = Fit(problem, {});
  EXPECT_EQ(fit.values[0], 1);
  const Identifiability of = At(problem, fit.values);
  EXPECT_EQ(of.parameters[0].kind, Determined::kAtBound);
  EXPECT_EQ(of.parameters[0].sentence, "a = 1: at its upper bound; the optimum lies beyond it");
  EXPECT_NEAR(of.parameters[1].se, 0.1 / std::sqrt(285.0), 1e-9);
  EXPECT_EQ(of.directions.size(), 1u);
}

TEST(FitVerdict, AKinkIsPartOfTheSentence) {
  const auto problem = Curve({Parameter("yaw", 0)}, 4, 0.01, [](double x, const auto& v) {
    return v[0] > 0 ? 0.67 * v[0] * x : -0.17 * v[0] * x;
  });
  const ParameterVerdict of = At(problem, {0}).parameters[0];
  EXPECT_TRUE(of.kink);
  EXPECT_NE(of.sentence.find("no shorter step resolves it: a kink or noise"), std::string::npos)
      << of.sentence;
}

TEST(FitVerdict, EstimatesThatGoTogetherSaySo) {
  const auto problem = Curve({Parameter("a", 0), Parameter("b", 0)}, 9, 1e-3,
                             [](double x, const auto& v) { return v[0] + v[1] * (x + 50); });
  const std::string sentence = At(problem, {0, 0}).parameters[0].sentence;
  EXPECT_NE(sentence.find("it is correlated with b (-0.99"), std::string::npos) << sentence;
}

// Chi-square

/// Abramowitz and Stegun, table 26.8, and closed forms
TEST(FitVerdict, ChiSquareTailsAreTheTables) {
  EXPECT_NEAR(ChiSquareQuantile(0.05, 1), 3.84146, 5e-6);
  EXPECT_NEAR(ChiSquareQuantile(0.001, 1), 10.828, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.05, 10), 18.3070, 5e-5);
  EXPECT_NEAR(ChiSquareQuantile(0.99, 10), 2.55821, 5e-6);
  EXPECT_NEAR(ChiSquareQuantile(0.001, 30), 59.703, 5e-4);
  EXPECT_NEAR(ChiSquareQuantile(0.05, 100), 124.342, 5e-4);
  for (const double x : {0.1, 1.0, 5.0, 40.0, 300.0}) {
    EXPECT_NEAR(ChiSquareTail(x, 2) / std::exp(-x / 2), 1, 1e-13);
    EXPECT_NEAR(ChiSquareTail(x, 1) / std::erfc(std::sqrt(x / 2)), 1, 1e-12);
    const double h = x / 2;
    EXPECT_NEAR(ChiSquareTail(x, 6) / (std::exp(-h) * (1 + h + h * h / 2)), 1, 1e-12);
    // Q(a + 1, x) = Q(a, x) + x^a e^-x / Gamma(a + 1), at a = 1.35
    EXPECT_NEAR(ChiSquareTail(x, 4.7),
                ChiSquareTail(x, 2.7) + std::pow(h, 1.35) * std::exp(-h) / std::tgamma(2.35),
                1e-13);
  }
  EXPECT_EQ(ChiSquareTail(0, 3), 1);
  // Wilson and Hilferty, three digits at many degrees of freedom
  const double z = (std::cbrt(10300.0 / 10000) - (1 - 2.0 / 90000)) / std::sqrt(2.0 / 90000);
  EXPECT_NEAR(ChiSquareTail(10300, 10000) / (0.5 * std::erfc(z / std::sqrt(2.0))), 1, 1e-3);
}

}  // namespace
}  // namespace taut
