/// Fits without groups, profiles, consistency of data, and design of further measurements
#include <gtest/gtest.h>

#include <cmath>

#include "taut/fit_design.h"
#include "taut/fit_verdict.h"
#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::MakeProblem;
using test::Parameter;

/// Datum i of group g is m + (error shared by group g) + (individual error), with the stated sd of
/// 1.
FitProblem SharedErrors(std::uint64_t seed, std::size_t groups, std::size_t each, double shared) {
  math::Random random(seed, 7, 0);
  std::vector<double> y;
  for (std::size_t g = 0; g < groups; ++g) {
    const double common = shared * random.Normal();
    for (std::size_t i = 0; i < each; ++i) y.push_back(common + random.Normal());
  }
  FitProblem problem =
      MakeProblem({Parameter("m", 0)}, y.size(), [y](const std::vector<double>& v) {
        Residuals r;
        for (const double one : y) r.value.push_back(v[0] - one);
        return r;
      });
  for (std::size_t i = 0; i < y.size(); ++i) problem.rows[i].group = static_cast<int>(i / each);
  return problem;
}

TEST(FitLeftOut, TheJackknifeOfAMeanIsItsTextbookError) {
  // For equal groups: the standard error of the mean of the groups' means
  const FitProblem problem = SharedErrors(5, 6, 10, 0.5);
  const std::vector<double> fitted = Fit(problem, {}).values;
  const auto residual = problem.forward(std::vector<std::vector<double>>{{0.0}})[0].value;
  double mean = 0, sum = 0;
  std::vector<double> means(6, 0);
  for (std::size_t i = 0; i < 60; ++i) means[i / 10] -= residual[i] / 10;
  for (const double m : means) mean += m / 6;
  for (const double m : means) sum += (m - mean) * (m - mean);
  const double expected = std::sqrt(sum / (6 * 5));
  const FitDerivatives derivatives = Differentiate(problem, fitted);
  for (const Jackknife how : {Jackknife::kStep, Jackknife::kRefit}) {
    const auto result = JackknifeGroups(problem, fitted, derivatives, how);
    ASSERT_TRUE(result.se[0]) << result.why;
    EXPECT_NEAR(*result.se[0], expected, 1e-8);
    EXPECT_EQ(result.groups.size(), 6u);
  }
}

/// If residuals of a group are correlated, the errors of J^T J are several times too small, and the
/// errors of the jackknife are unbiased: here the true value is sqrt((shared^2 + 1 / each) /
/// groups).
TEST(FitLeftOut, TheJackknifeKnowsResidualsThatHangTogether) {
  const std::size_t groups = 8, each = 20;
  double by_jacobian = 0, by_groups = 0, scatter = 0;
  const int runs = 200;
  for (int seed = 1; seed <= runs; ++seed) {
    const FitProblem problem = SharedErrors(static_cast<std::uint64_t>(seed), groups, each, 1.0);
    const std::vector<double> fitted = Fit(problem, {}).values;
    const FitDerivatives derivatives = Differentiate(problem, fitted);
    const double se = Identify(problem, fitted, derivatives).parameters[0].se;
    const double jackknife = *JackknifeGroups(problem, fitted, derivatives, Jackknife::kStep).se[0];
    by_jacobian += se * se / runs;
    by_groups += jackknife * jackknife / runs;
    scatter += fitted[0] * fitted[0] / runs;
  }
  const double truth = (1.0 + 1.0 / each) / groups;
  EXPECT_NEAR(by_jacobian, 1.0 / (groups * each), 1e-9);
  EXPECT_NEAR(std::sqrt(truth / by_jacobian), std::sqrt(21.0), 1e-9);  // 4.6 times too small
  // From 200 runs with 7 degrees of freedom each, a variance is known to sqrt(2 / 1400): 3.8 %.
  EXPECT_NEAR(by_groups / truth, 1, 3 * 0.038);
  EXPECT_NEAR(scatter / truth, 1, 3 * 0.1);
}

TEST(FitLeftOut, AnOffsetOfOneGroupHasNoJackknife) {
  FitProblem problem = SharedErrors(3, 4, 5, 0.1);
  problem.parameters.push_back(Parameter("offset of 2", 0));
  problem.forward = [inner = problem.forward](std::span<const std::vector<double>> points) {
    auto answers = inner(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      for (std::size_t i = 10; i < 15; ++i) answers[k].value[i] += points[k][1];
    }
    return answers;
  };
  const std::vector<double> fitted = Fit(problem, {}).values;
  const auto result =
      JackknifeGroups(problem, fitted, Differentiate(problem, fitted), Jackknife::kStep);
  EXPECT_TRUE(result.se[0]);
  EXPECT_FALSE(result.se[1]);
}

TEST(FitLeftOut, TwoGroupsHaveNoJackknife) {
  const FitProblem problem = SharedErrors(3, 2, 5, 0.1);
  const auto result = JackknifeGroups(problem, {0}, Differentiate(problem, {0}), Jackknife::kStep);
  EXPECT_FALSE(result.se[0]);
  EXPECT_EQ(result.why, "there are fewer than three groups to leave out");
}

/// Polynomials for a straight line with noise: data at 0, 0.1, ... 1.1, a group each
FitProblem Polynomial(int degree) {
  math::Random random(11, 7, 0);
  std::vector<double> y;
  for (int i = 0; i < 12; ++i) y.push_back(1 + 0.1 * i + 0.3 * random.Normal());
  std::vector<FitParameter> p;
  for (int k = 0; k <= degree; ++k) p.push_back(Parameter("c" + std::to_string(k), k == 0 ? 1 : 0));
  FitProblem problem = MakeProblem(p, 12, [y](const std::vector<double>& v) {
    Residuals r;
    for (std::size_t i = 0; i < y.size(); ++i) {
      double f = 0;
      for (std::size_t k = v.size(); k-- > 0;) f = f * 0.1 * static_cast<double>(i) + v[k];
      r.value.push_back((f - y[i]) / 0.3);
    }
    return r;
  });
  for (int i = 0; i < 12; ++i) problem.rows[static_cast<std::size_t>(i)].group = i;
  return problem;
}

TEST(FitLeftOut, LeavingOneOutOfALineIsTheClosedForm) {
  // Residual of a datum left out = residual / (1 - leverage)
  const FitProblem problem = Polynomial(1);
  const std::vector<double> fitted = Fit(problem, {}).values;
  const auto residual = problem.forward(std::vector<std::vector<double>>{fitted})[0].value;
  double sum = 0;
  for (int i = 0; i < 12; ++i) {
    const double x = 0.1 * i - 0.55;
    const double leverage = 1.0 / 12 + x * x / 1.43;
    const double out = residual[static_cast<std::size_t>(i)] / (1 - leverage);
    sum += out * out;
  }
  const CrossValidation result = CrossValidate(problem, fitted, 0);
  EXPECT_EQ(result.folds.size(), 12u);
  EXPECT_NEAR(result.all.fitted, std::sqrt(sum / 12), 1e-7);
  EXPECT_EQ(result.all.count, 12u);
}

TEST(FitLeftOut, AnOverfittedModelIsWorseOnWhatItHasNotSeen) {
  const FitProblem line = Polynomial(1), much = Polynomial(8);
  const FitResult line_fit = Fit(line, {}), much_fit = Fit(much, {});
  EXPECT_LT(much_fit.cost, 0.5 * line_fit.cost);  // fits better
  const CrossValidation of_line = CrossValidate(line, line_fit.values, 4);
  const CrossValidation of_much = CrossValidate(much, much_fit.values, 4);
  EXPECT_EQ(of_line.folds[1].groups, (std::vector<int>{1, 5, 9}));
  EXPECT_FALSE(of_line.all.worse());
  EXPECT_TRUE(of_much.all.worse());
  EXPECT_GT(of_much.all.fitted, 2 * of_line.all.fitted);
}

TEST(FitLeftOut, AHoldOutThatCannotBeComputedSaysWhy) {
  const auto test = MakeProblem({Parameter("x", 0)}, 1, [](const std::vector<double>& v) {
    return v[0] > 1 ? Residuals{{}, "slack"} : Residuals{{v[0]}, ""};
  });
  EXPECT_EQ(HoldOut(test, {2}).failed, "slack");
  EXPECT_TRUE(HoldOut(test, {1}).worse());
}

// Profiles

TEST(FitProfile, OfALinearProblemItIsAParabolaAndTheIntervalIts196Errors) {
  const test::Linear linear = test::RandomLinear(20, 3, 4);
  const auto problem =
      MakeProblem({Parameter("a", 0), Parameter("b", 0), Parameter("c", 0)}, 20, linear);
  const FitResult fit = Fit(problem, {});
  const double se =
      Identify(problem, fit.values, Differentiate(problem, fit.values)).parameters[1].se;
  const FitProfile profile = ProfileParameter(problem, fit.values, 1, se);
  ASSERT_EQ(profile.why, "");
  EXPECT_EQ(profile.points.size(), 13u);
  for (const ProfilePoint& point : profile.points) {
    const double z = (point.value - fit.values[1]) / se;
    EXPECT_NEAR(point.rise, z * z, 1e-7);
  }
  EXPECT_NEAR(profile.low, fit.values[1] - 1.959964 * se, 1e-6);
  EXPECT_NEAR(profile.high, fit.values[1] + 1.959964 * se, 1e-6);
  EXPECT_FALSE(profile.low_open || profile.high_open || profile.better);
}

TEST(FitProfile, ItSeesWhatTheEllipseDoesNot) {
  // exp(a) = y: the interval is the interval of y, transformed and not symmetric. exp(a) = 1 +-
  // 0.4.
  const auto problem = MakeProblem({Parameter("a", 0)}, 1, [](const std::vector<double>& v) {
    return Residuals{{(std::exp(v[0]) - 1) / 0.4}, ""};
  });
  ProfileOptions options;
  options.points = 40;
  const FitProfile profile = ProfileParameter(problem, {0}, 0, 0.4, options);
  EXPECT_NEAR(profile.low, std::log(1 - 1.959964 * 0.4), 2e-3);
  EXPECT_NEAR(profile.high, std::log(1 + 1.959964 * 0.4), 2e-3);
}

TEST(FitProfile, AnAliasIsOpenOnBothSides) {
  const auto problem =
      MakeProblem({Parameter("a", 1), Parameter("b", 1)}, 2, [](const std::vector<double>& v) {
        return Residuals{{v[0] + v[1] - 2, 2 * (v[0] + v[1]) - 4}, ""};
      });
  const FitProfile profile =
      ProfileParameter(problem, {1, 1}, 0, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(profile.low_open && profile.high_open);
  EXPECT_TRUE(std::isinf(profile.low) && std::isinf(profile.high));
  EXPECT_NE(profile.sentence.find("open on both sides"), std::string::npos) << profile.sentence;
}

TEST(FitProfile, AnotherMinimumIsHandedOnFromWhereItIsFound) {
  // Two branches for z, near -1 and near +1. From x = 0, z = -1 the other branch is found only far
  // away, where the first ends, and is the lower one already for x > 0.
  const auto problem =
      MakeProblem({Parameter("x", 0), Parameter("z", -1)}, 3, [](const std::vector<double>& v) {
        return Residuals{{2 * (v[1] * v[1] - 1), v[1] - v[0], v[0]}, ""};
      });
  ProfileOptions options;
  options.points = 10;
  options.reach = 5;
  const std::vector<double> fitted = Fit(problem, {}).values;
  ASSERT_LT(fitted[1], 0);
  const FitProfile profile = ProfileParameter(problem, fitted, 0, 1, options);
  int checked = 0;
  for (const ProfilePoint& point : profile.points) {
    // The lower of both branches: by symmetry z has the sign of x.
    if (std::fabs(point.value) < 0.3) continue;
    EXPECT_GT(point.values[1] * point.value, 0) << point.value;
    ++checked;
  }
  EXPECT_GT(checked, 15);
}

TEST(FitProfile, ABoundEndsItAndALowerMinimumIsTold) {
  FitParameter p = Parameter("x", -1);
  p.low = -1.1;
  p.high = 2;
  const auto problem = MakeProblem({p}, 2, [](const std::vector<double>& v) {
    return Residuals{{4 * (v[0] * v[0] - 1), 0.5 * (v[0] - 2)}, ""};
  });
  const FitProfile profile = ProfileParameter(problem, {-0.97}, 0, 1);
  EXPECT_EQ(profile.points.front().value, -1.1);
  ASSERT_TRUE(profile.better);
  EXPECT_NEAR((*profile.better)[0], 1, 0.3);
}

// Consistency of data

TEST(FitProportion, MissingLoadIsFound) {
  // 0.93 of the load is measured, in six tests whose gains differ by 0.01.
  math::Random random(2, 7, 0);
  std::vector<ProportionPoint> points, whole;
  double slopes = 0;
  for (int test = 0; test < 6; ++test) {
    const double gain = 0.93 + 0.01 * random.Normal();
    slopes += gain / 6;
    for (int i = 1; i <= 10; ++i) {
      points.push_back({100.0 * i, gain * 100.0 * i, 2.0, test});
      whole.push_back({100.0 * i, 100.0 * i + 2.0 * random.Normal(), 2.0, test});
    }
  }
  const ProportionCheck check = CheckProportion(points, "the measured forces carry");
  EXPECT_NEAR(check.slope, slopes, 1e-12);
  EXPECT_GT(check.se, 2.0 / std::sqrt(6 * 3.85e6));  // more than from the sds alone
  EXPECT_NEAR(check.se, 0.01 / std::sqrt(6), 0.003);
  EXPECT_FALSE(check.consistent);
  const ProportionCheck good = CheckProportion(whole, "the measured forces carry");
  EXPECT_TRUE(good.consistent) << good.sentence;
  EXPECT_NEAR(good.slope, 1, 3 * good.se);
  EXPECT_FALSE(CheckProportion({}, "").why.empty());
}

TEST(FitProportion, OnePassIsTheTextbook) {
  const std::vector<ProportionPoint> points = {{1, 2, 1, 0}, {2, 3, 1, 0}, {3, 7, 1, 0}};
  const ProportionCheck check = CheckProportion(points, "");
  EXPECT_NEAR(check.slope, 29.0 / 14, 1e-12);
  EXPECT_NEAR(check.chi2, 62 - 29.0 * 29 / 14, 1e-12);
  EXPECT_NEAR(check.p, std::exp(-check.chi2 / 2), 1e-12);
}

// Design of further measurements

TEST(FitDesign, CombinationsAreCountedAndTheGreedyOrderIsByInformation) {
  std::vector<FitParameter> p = {Parameter("a", 0), Parameter("b", 0), Parameter("c", 0)};
  p[0].scale = 0;
  p[0].prior_sd = 2;  // the others from their scale of 1
  const DesignCandidate base{"now", {}, {}};
  const double nan = std::nan("");
  // sum: a + b once; pair: a and c; again: only a, almost useless after pair.
  const std::vector<DesignCandidate> candidates = {
      {"sum", {1, 1, 0}, {0.1}},
      {"again", {1, 0, 0, nan, 0, 0}, {1.0, 1.0}},
      {"pair", {1, 0, 0, 0, 0, 1}, {0.1, 0.1}},
  };
  const DesignRanking ranking = RankDesigns(p, base, candidates);
  ASSERT_TRUE(ranking.wrong.empty());
  EXPECT_EQ(ranking.now.fixed, 0);
  EXPECT_EQ(ranking.alone[0].fixed, 1);
  EXPECT_EQ(ranking.alone[1].fixed, 1);  // 2 / sqrt(1 + 4) < 1
  EXPECT_EQ(ranking.alone[2].fixed, 2);
  EXPECT_EQ(ranking.order, (std::vector<std::size_t>{2, 0, 1}));
  EXPECT_EQ(ranking.greedy[1].fixed, 3);
  EXPECT_NEAR(ranking.alone[1].information, 0.5 * std::log(5.0), 1e-12);
  EXPECT_NEAR(ranking.alone[2].information, 0.5 * std::log(401.0 * 101.0), 1e-9);
  EXPECT_NEAR(ranking.alone[1].sd_ratio[0], 1 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(ranking.alone[1].sd_ratio[1], 1, 1e-12);
  EXPECT_EQ(ranking.sentences[1].substr(0, 41), "with pair: 2 of 3 combinations, 5.305 nat");
}

TEST(FitDesign, TheThresholdIsHalfThePriorsDeviation) {
  const std::vector<FitParameter> p = {Parameter("a", 0)};
  const auto fixed = [&](double slope) {
    return RankDesigns(p, {"now", {slope}, {1.0}}, {}).now.fixed;
  };
  EXPECT_EQ(fixed(std::sqrt(3.0) * 1.0001), 1);
  EXPECT_EQ(fixed(std::sqrt(3.0) * 0.9999), 0);
}

TEST(FitDesign, MistakesAreNamedAtOnce) {
  const DesignRanking ranking =
      RankDesigns({Parameter("a", 0)}, {"now", {1, 2}, {1.0}}, {{"x", {1}, {0.0}}});
  ASSERT_EQ(ranking.wrong.size(), 2u);
  EXPECT_EQ(ranking.wrong[0], "now: its Jacobian must have one row per standard deviation");
  EXPECT_EQ(ranking.wrong[1], "x: a standard deviation is not above 0");
}

}  // namespace
}  // namespace taut
