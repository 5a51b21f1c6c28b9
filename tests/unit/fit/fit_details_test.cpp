/// Parts of a fit, separately and in closed form: starts, slopes at bounds, priors and scales,
/// folds, groups, parts of chi-square
#include <gtest/gtest.h>

#include <cmath>

#include "taut/fit_verdict.h"
#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::Linear;
using test::MakeProblem;
using test::Parameter;

FitVerdict JudgedInDetail(const FitProblem& problem, const FitProblem* test = nullptr) {
  return JudgeFit(problem, Fit(problem, {}), {}, test);
}

/// Data of one number, each datum a group, sd 1
FitProblem MeanOf(const std::vector<double>& y, double start = 0) {
  FitProblem problem =
      MakeProblem({Parameter("m", start)}, y.size(), [y](const std::vector<double>& v) {
        Residuals r;
        for (const double one : y) r.value.push_back(v[0] - one);
        return r;
      });
  for (std::size_t i = 0; i < y.size(); ++i) problem.rows[i].group = static_cast<int>(i);
  return problem;
}

TEST(FitDetails, StartsAreDrawnFromThePriorCutOffAtItsBounds) {
  FitParameter p = Parameter("x", 1);
  p.prior_mean = 5;
  p.prior_sd = 0.5;
  p.low = 4.75;  // half a deviation below
  FitProblem problem = MakeProblem({p}, 1, [](const std::vector<double>& v) {
    return Residuals{{v[0]}, {}};
  });
  const int draws = 4000;
  double mean = 0, square = 0;
  for (int k = 1; k <= draws; ++k) {
    const double x = DrawFitStart(problem, 3, static_cast<std::uint64_t>(k))[0];
    EXPECT_GT(x, 4.75);
    mean += (x - 5) / 0.5 / draws;
    square += (x - 5) / 0.5 * ((x - 5) / 0.5) / draws;
  }
  // Normal distribution truncated at -1/2: mean phi / Phi = 0.35207 / 0.69146, mean square 1 - mean
  // / 2.
  EXPECT_NEAR(mean, 0.50916, 4 * 0.7 / std::sqrt(draws));
  EXPECT_NEAR(square, 1 - 0.5 * 0.50916, 4 * 1.1 / std::sqrt(draws));
}

TEST(FitDetails, TheGivenStartIsNotDrawnAgain) {
  FitProblem problem = MakeProblem({Parameter("x", -1)}, 1, [](const std::vector<double>& v) {
    return v[0] < 0 ? Residuals{{}, "below zero"} : Residuals{{v[0] - 2}, {}};
  });
  problem.parameters[0].low = -2;
  problem.parameters[0].high = 8;
  FitOptions options;
  options.starts = 4;
  const FitResult fit = Fit(problem, options);
  ASSERT_EQ(fit.state.tracks.size(), 4u);
  EXPECT_EQ(fit.state.tracks[0].end, FitEnd::kFailed);
  EXPECT_EQ(fit.state.tracks[0].start[0], -1);
  for (std::size_t t = 1; t < 4; ++t) EXPECT_NEAR(fit.state.tracks[t].values[0], 2, 1e-6);
}

TEST(FitDetails, NearABoundADifferenceIsShorterOnBothSides) {
  FitParameter p = Parameter("x", 1);
  p.step = 0.5;
  p.low = 0.8;  // nearer than the step, farther than a quarter of it
  const FitProblem problem = MakeProblem({p}, 1, [](const std::vector<double>& v) {
    return Residuals{{v[0] * v[0] * v[0]}, {}};
  });
  const FitDerivatives d = Differentiate(problem, {1});
  EXPECT_NEAR(d.columns[0].slope[0], 3,
              1e-10);  // exact for a cubic, if both sides have the same step
}

TEST(FitDetails, APriorCountsBesideTheScaleAndTheOthers) {
  // Two data, 2 x and 2 x + y; the scale is ten times the prior's sd, and is unused then.
  FitParameter x = Parameter("x", 1, 10), y = Parameter("y", 0, 10);
  x.prior_sd = 1;
  x.prior_mean = 3;
  y.prior_sd = 2;
  const FitProblem problem = MakeProblem({x, y}, 2, Linear{{{0.4, 0}, {0.4, 1}}, {0.4, 0.4}});
  const FitVerdict verdict = JudgedInDetail(problem);
  const ParameterVerdict& of = verdict.identifiability.parameters[0];
  EXPECT_NEAR(of.se_alone, 1 / std::sqrt(2 * 0.16 + 1), 1e-9);
  // (J^T J + P)^-1, explicitly
  const double a = 0.32 + 1, b = 0.4, c = 1 + 0.25, det = a * c - b * b;
  EXPECT_NEAR(of.se, std::sqrt(c / det), 1e-9);
  EXPECT_NEAR(of.sd_ratio, std::sqrt(c / det), 1e-9);
  EXPECT_EQ(of.kind, Determined::kPrior);
  EXPECT_NEAR(of.pull, of.value - 3, 1e-12);
  EXPECT_LT(of.pull, -0.1);
}

TEST(FitDetails, WithoutAGroupAStepGoesWhereASearchGoes) {
  const FitProblem problem = MeanOf({0, 1, 2, 7});
  const std::vector<double> fitted = Fit(problem, {}).values;
  const FitDerivatives d = Differentiate(problem, fitted);
  const double without[] = {10.0 / 3, 3, 8.0 / 3, 1};
  for (const Jackknife how : {Jackknife::kStep, Jackknife::kRefit}) {
    const auto result = JackknifeGroups(problem, fitted, d, how);
    ASSERT_EQ(result.groups.size(), 4u);
    for (std::size_t g = 0; g < 4; ++g) {
      EXPECT_NEAR(result.groups[g].values[0], without[g], 1e-7);
    }
  }
}

TEST(FitDetails, WhatOneGroupSeesAHundredTimesBetterIsItsOwn) {
  // Sensitivity to b: group 0 has 1 and each of the others 0.05, so that 0.0075 of the square
  // remains without group 0.
  for (const auto& [other, own] : {std::pair(0.05, true), {0.07, false}}) {
    Linear linear;
    for (int i = 0; i < 4; ++i) {
      linear.A.push_back({1, i == 0 ? 1 : other * (i - 2.0) * std::sqrt(1.5)});
      linear.b.push_back(0.1 * i * i);
    }
    FitProblem problem = MakeProblem({Parameter("a", 0), Parameter("b", 0)}, 4, linear);
    for (int i = 0; i < 4; ++i) problem.rows[static_cast<std::size_t>(i)].group = i;
    const std::vector<double> fitted = Fit(problem, {}).values;
    const auto result =
        JackknifeGroups(problem, fitted, Differentiate(problem, fitted), Jackknife::kStep);
    EXPECT_TRUE(result.se[0]);
    EXPECT_EQ(result.se[1].has_value(), !own) << other;
  }
}

TEST(FitDetails, FoldsAreThoseTheySayAndHaveTheirOwnErrors) {
  const std::vector<double> y{0, 1, 2, 7, 9};
  const FitProblem problem = MeanOf(y, 4);
  const CrossValidation result = CrossValidate(problem, Fit(problem, {}).values, 2);
  ASSERT_EQ(result.folds.size(), 2u);
  EXPECT_EQ(result.folds[0].groups, (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(result.folds[1].groups, (std::vector<int>{1, 3}));
  const double means[] = {4, 11.0 / 3};  // of the data outside of the fold: 1, 7 and 0, 2, 9
  double fitted = 0, untuned = 0;
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_NEAR(result.folds[f].values[0], means[f], 1e-7);
    double off = 0, before = 0;
    for (const int g : result.folds[f].groups) {
      off += std::pow(means[f] - y[static_cast<std::size_t>(g)], 2);
      before += std::pow(4 - y[static_cast<std::size_t>(g)], 2);
    }
    const double n = static_cast<double>(result.folds[f].groups.size());
    EXPECT_EQ(result.folds[f].errors.count, result.folds[f].groups.size());
    EXPECT_NEAR(result.folds[f].errors.fitted, std::sqrt(off / n), 1e-6);
    EXPECT_NEAR(result.folds[f].errors.untuned, std::sqrt(before / n), 1e-9);
    fitted += off, untuned += before;
  }
  EXPECT_NEAR(result.all.fitted, std::sqrt(fitted / 5), 1e-6);
  EXPECT_NEAR(result.all.untuned, std::sqrt(untuned / 5), 1e-9);
}

TEST(FitDetails, DataThatContradictThemselvesAreRejectedWhereTheWholeIsNot) {
  // Ten numbers, each measured once, the first twice with a difference of 4.9; weak priors. All
  // residuals have 11 degrees of freedom, the data one.
  std::vector<FitParameter> p;
  Linear linear;
  for (std::size_t j = 0; j < 10; ++j) {
    p.push_back(Parameter(std::to_string(j), 0, 0));
    p.back().prior_sd = 1000;
    linear.A.emplace_back(10, 0.0)[j] = 1;
    linear.b.push_back(0);
  }
  linear.A.emplace_back(10, 0.0)[0] = 1;
  linear.b.push_back(4.9);
  const FitVerdict verdict = JudgedInDetail(MakeProblem(p, 11, linear));
  EXPECT_NEAR(verdict.data.value, 0.5 * 4.9 * 4.9, 1e-4);
  EXPECT_NEAR(verdict.data.freedom, 1, 1e-4);
  EXPECT_NEAR(verdict.total.freedom, 11, 1e-9);
  EXPECT_GT(verdict.total.p, 0.3);
  EXPECT_LT(verdict.data.p, 0.001);
  EXPECT_TRUE(verdict.rejected);
}

TEST(FitDetails, AHoldOutThatCannotBeComputedIsNoGoodFit) {
  FitProblem problem = MeanOf({0.1, -0.2, 0.3, -0.1});
  problem.parameters[0].scale = 10;
  EXPECT_EQ(JudgedInDetail(problem).judgement, FitJudgement::kGood);
  const FitProblem test = MakeProblem(problem.parameters, 1, [](const std::vector<double>&) {
    return Residuals{{}, "it blows up"};
  });
  const FitVerdict verdict = JudgedInDetail(problem, &test);
  EXPECT_EQ(verdict.judgement, FitJudgement::kWorse);
  bool said = false;
  for (const std::string& s : verdict.sentences) said |= s.find("it blows up") != s.npos;
  EXPECT_TRUE(said);
}

TEST(FitDetails, LossesStandInPlaceOfSquaresInChiSquare) {
  FitProblem problem = MeanOf({0, 0.5, -0.5, 0.2, 9});
  for (FitRow& row : problem.rows) row.loss = FitLoss::kHuber, row.loss_width = 1;
  const FitVerdict verdict = JudgedInDetail(problem);
  const double m = verdict.values[0];
  double expected = 2 * std::fabs(9 - m) - 1;
  for (const double y : {0.0, 0.5, -0.5, 0.2}) expected += (y - m) * (y - m);
  EXPECT_NEAR(verdict.data.value, expected, 1e-9);
}

TEST(FitDetails, CauchysLossHasItsWidth) {
  FitProblem problem = MeanOf({0, 0.5, -0.5, 0.2, 9});
  for (FitRow& row : problem.rows) row.loss = FitLoss::kCauchy, row.loss_width = 2;
  const FitVerdict verdict = JudgedInDetail(problem);
  const double m = verdict.values[0];
  double expected = 0, slope = 0;
  for (const double y : {0.0, 0.5, -0.5, 0.2, 9.0}) {
    expected += 4 * std::log(1 + (y - m) * (y - m) / 4);
    slope += 2 * (m - y) / (1 + (y - m) * (y - m) / 4);  // zero at the minimum
  }
  EXPECT_NEAR(verdict.data.value, expected, 1e-9);
  EXPECT_NEAR(slope, 0, 1e-5);
}

TEST(FitDetails, AtEitherBoundAParameterIsHeldOnlyIfTheDataWantItBeyond) {
  // Data at 3 for a number between 0 and 1, and mirrored.
  for (const double sign : {1.0, -1.0}) {
    FitProblem problem = MeanOf({3 * sign, 3.2 * sign, 2.8 * sign, 3 * sign});
    FitParameter& p = problem.parameters[0];
    p.low = sign > 0 ? 0 : -1, p.high = sign > 0 ? 1 : 0;
    const FitVerdict verdict = JudgedInDetail(problem);
    EXPECT_EQ(verdict.values[0], sign);
    EXPECT_EQ(verdict.identifiability.parameters[0].kind, Determined::kAtBound);
    EXPECT_EQ(verdict.total.freedom, 4);
    // At the other bound the data pull inward: the parameter is free there.
    const std::vector<double> inside{0};
    EXPECT_NE(Identify(problem, inside, Differentiate(problem, inside)).parameters[0].kind,
              Determined::kAtBound);
  }
}

TEST(FitDetails, AFoldTakesTheLowerOfItsTwoSearches) {
  // Two minima: the search from the start at -2 finds the upper one of (x^2 - 4)^2 + x, the search
  // from the fit the lower.
  const auto well = [](const std::vector<double>& v) {
    const double x = v[0];
    return Residuals{{x * x - 4, 0.3 * (x + 4), x * x - 4, 0.3 * (x + 4)}, {}};
  };
  for (const double start : {-2.0, 2.0}) {
    FitProblem problem = MakeProblem({Parameter("x", start)}, 4, well);
    for (int i = 0; i < 4; ++i) problem.rows[static_cast<std::size_t>(i)].group = i / 2;
    const CrossValidation result = CrossValidate(problem, {-start}, 2);
    ASSERT_EQ(result.folds.size(), 2u);
    for (const FoldResult& fold : result.folds) EXPECT_LT(fold.values[0], -1.9) << start;
  }
}

TEST(FitDetails, ACombinationThatNothingHoldsTakesNoDegreeOfFreedom) {
  // Five data of the sum of two numbers: one combination is fitted, four degrees of freedom remain.
  const FitProblem problem =
      MakeProblem({Parameter("a", 0), Parameter("b", 0)}, 5,
                  Linear{{{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}}, {0.5, -1, 2, 0, 1}});
  const FitVerdict verdict = JudgedInDetail(problem);
  EXPECT_EQ(verdict.identifiability.endless, 1);
  EXPECT_NEAR(verdict.total.freedom, 4, 1e-9);
  EXPECT_NEAR(verdict.data.freedom, 4, 1e-6);
}

TEST(FitDetails, OneStepSolvesALinearProblemInABox) {
  // Different scales. b starts at its lower bound and leaves it at once; a ends at its bound, and b
  // at the minimum for this a: of (4 + b + 9)^2 + (1 + 2 b - 4)^2 + (3 b - 5)^2, at 8 / 14.
  FitParameter a = Parameter("a", 1.5, 10), b = Parameter("b", 0, 0.1);
  a.low = 1, b.low = 0;
  const FitProblem problem = MakeProblem({a, b}, 3, Linear{{{4, 1}, {1, 2}, {0, 3}}, {-9, 4, 5}});
  FitOptions options;
  options.most_iterations = 1;
  options.dampings = 1;
  options.first_damping = 1e-10;
  const FitResult fit = Fit(problem, options);
  EXPECT_EQ(fit.values[0], 1);
  EXPECT_NEAR(fit.values[1], 8.0 / 14, 1e-6);
}

TEST(FitDetails, ASearchNeverGoesUp) {
  const FitProblem problem =
      MakeProblem({Parameter("x", -1.2), Parameter("y", 1)}, 2, [](const std::vector<double>& v) {
        return Residuals{{10 * (v[1] - v[0] * v[0]), 1 - v[0]}, {}};
      });
  double before = 1e300;
  FitOptions options;
  options.dampings = 1;
  options.first_damping = 1e-6;  // so that steps overshoot
  options.progress = [&](const FitState& state) {
    EXPECT_LE(state.tracks[0].cost, before);
    before = state.tracks[0].cost;
    return true;
  };
  EXPECT_NEAR(Fit(problem, options).values[0], 1, 1e-6);
}

TEST(FitDetails, AScaleIsThePriorsElseAQuarterOfTheBoundsElseATenthOfTheStart) {
  FitParameter p = Parameter("x", 30, 0);
  EXPECT_EQ(FitScale(p), 3);
  p.low = 20, p.high = 60;
  EXPECT_EQ(FitScale(p), 10);
  p.prior_sd = 7;
  EXPECT_EQ(FitScale(p), 7);
  p.scale = 2;
  EXPECT_EQ(FitScale(p), 2);
  EXPECT_EQ(FitScale(Parameter("y", 0, 0)), 1);
}

TEST(FitDetails, AProportionIsTheWeightedLineThroughZero) {
  // Two sds, each point a group: the closed-form line, and each of the three errors in a case in
  // which it is the largest.
  const auto check = [](double off, int groups) {
    std::vector<ProportionPoint> points;
    for (int i = 1; i <= 6; ++i) {
      const double sd = i % 2 == 0 ? 0.5 : 2;
      points.push_back({1.0 * i, 0.8 * i + (i % 2 == 0 ? off : -off), sd, i % groups});
    }
    return CheckProportion(points, "forces carry");
  };
  double xx = 0, xy = 0;
  for (int i = 1; i <= 6; ++i) {
    const double w = i % 2 == 0 ? 4 : 0.25;
    xx += w * i * i, xy += w * i * (0.8 * i + (i % 2 == 0 ? 3 : -3));
  }
  const ProportionCheck exact = check(0, 1), scattered = check(3, 1), grouped = check(3, 6);
  EXPECT_NEAR(exact.slope, 0.8, 1e-12);
  EXPECT_NEAR(exact.se, 1 / std::sqrt(xx), 1e-12);  // from the sds
  EXPECT_NEAR(exact.z, -0.2 * std::sqrt(xx), 1e-9);
  EXPECT_NEAR(scattered.slope, xy / xx, 1e-12);
  double chi2 = 0;
  for (int i = 1; i <= 6; ++i) {
    const double r = 0.8 * i + (i % 2 == 0 ? 3 : -3) - scattered.slope * i;
    chi2 += r * r * (i % 2 == 0 ? 4 : 0.25);
  }
  EXPECT_NEAR(scattered.chi2, chi2, 1e-9);
  EXPECT_NEAR(scattered.p, ChiSquareTail(chi2, 5), 1e-12);
  EXPECT_NEAR(scattered.se, std::sqrt(chi2 / 5 / xx), 1e-12);
  EXPECT_GE(grouped.se, scattered.se);
  // The slope is consistent with the whole load, but the forces are not proportional.
  EXPECT_LT(std::fabs(scattered.z), 3);
  EXPECT_LT(scattered.p, 0.001);
  EXPECT_FALSE(scattered.consistent);
  EXPECT_NE(scattered.sentence.find("not proportional"), std::string::npos);
}

TEST(FitDetails, ErrorsByGroupsThatAreALittleLargerAreNotTold) {
  // 40 groups whose means scatter 1.6 times as much as their sds: significant, but too little to
  // report.
  std::vector<double> y;
  for (int i = 0; i < 40; ++i) y.push_back((i % 2 == 0 ? 1 : -1) * 1.6 * std::sqrt(39.0 / 40));
  FitProblem problem = MeanOf(y);
  const FitVerdict verdict = JudgedInDetail(problem);
  const ParameterVerdict& m = verdict.identifiability.parameters[0];
  EXPECT_NEAR(*m.se_jackknife / m.se, 1.6, 1e-6);
  EXPECT_LT(ChiSquareTail(39 * 1.6 * 1.6, 39), 1e-5);
  EXPECT_FALSE(m.groups_apart);
}

}  // namespace
}  // namespace taut
