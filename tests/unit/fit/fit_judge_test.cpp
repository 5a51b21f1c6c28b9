/// Judgment of whole fits, and synthetic data from known parameters
#include <gtest/gtest.h>

#include <cmath>

#include "taut/fit_verdict.h"
#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::MakeProblem;
using test::Parameter;

/// A damped oscillation sampled at 60 times, in six groups
double Swing(double t, const std::vector<double>& v) {
  return v[0] * std::exp(-v[1] * t) * std::cos(v[2] * t) + v[3];
}

struct Twin {
  std::vector<double> truth;
  FitProblem problem;
};

Twin MakeTwin(std::uint64_t seed, double noise_factor = 1.0) {
  math::Random random(seed, 7, 1);
  Twin twin;
  std::vector<FitParameter> p = {Parameter("amplitude", 1), Parameter("decay", 0.3),
                                 Parameter("frequency", 2), Parameter("offset", 0)};
  const std::vector<double> sds = {0.3, 0.1, 0.1, 0.2};
  for (std::size_t j = 0; j < p.size(); ++j) {
    p[j].prior_sd = sds[j];
    p[j].scale = 0;
    twin.truth.push_back(p[j].start + 0.7 * sds[j] * random.Normal());
  }
  std::vector<double> t, y;
  for (int i = 0; i < 60; ++i) {
    t.push_back(0.1 * i);
    y.push_back(Swing(t.back(), twin.truth) + noise_factor * 0.02 * random.Normal());
  }
  twin.problem = MakeProblem(p, t.size(), [t, y](const std::vector<double>& v) {
    Residuals r;
    for (std::size_t i = 0; i < t.size(); ++i) r.value.push_back((Swing(t[i], v) - y[i]) / 0.02);
    return r;
  });
  for (std::size_t i = 0; i < t.size(); ++i) twin.problem.rows[i].group = static_cast<int>(i % 6);
  return twin;
}

TEST(FitTwin, TwentySeedsAreFoundWithinTwoStandardErrors) {
  int within = 0, within_groups = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Twin twin = MakeTwin(seed);
    const FitResult fit = Fit(twin.problem, {});
    EXPECT_EQ(fit.end, FitEnd::kConverged) << fit.why;
    const FitVerdict verdict = JudgeFit(twin.problem, fit, {});
    EXPECT_EQ(verdict.judgement, FitJudgement::kGood) << seed << verdict.sentences[0];
    for (std::size_t j = 0; j < twin.truth.size(); ++j) {
      const ParameterVerdict& of = verdict.identifiability.parameters[j];
      const double off = std::fabs(of.value - twin.truth[j]);
      ++all;
      within += off <= 2 * of.se ? 1 : 0;
      within_groups += off <= 2 * of.error() ? 1 : 0;
    }
  }
  EXPECT_EQ(all, 80);
  EXPECT_GE(within, 72);  // 90 %; 95.4 % are expected
  EXPECT_GE(within_groups, within);
}

TEST(FitTwin, AnAddedAliasIsNamed) {
  Twin twin = MakeTwin(1);
  twin.problem.parameters.push_back(Parameter("gain", 0));  // added to the amplitude
  twin.problem.parameters[0].prior_sd = std::numeric_limits<double>::infinity();
  twin.problem.parameters[0].scale = 0.3;
  twin.problem.forward = [inner =
                              twin.problem.forward](std::span<const std::vector<double>> points) {
    std::vector<std::vector<double>> summed;
    for (const auto& point : points) {
      summed.push_back({point.begin(), point.end() - 1});
      summed.back()[0] += point.back();
    }
    return inner(summed);
  };
  const FitVerdict verdict = JudgeFit(twin.problem, Fit(twin.problem, {}), {});
  EXPECT_EQ(verdict.judgement, FitJudgement::kUnidentifiable);
  EXPECT_FALSE(verdict.rejected);
  EXPECT_EQ(verdict.sentences[0],
            "Not identifiable: the data do not determine amplitude (confounded) and gain "
            "(confounded); they fix 4 of 5 "
            "combinations of parameters (condition infinite).");
  const ParameterVerdict& of = verdict.identifiability.parameters[0];
  EXPECT_EQ(of.kind, Determined::kConfounded);
  ASSERT_EQ(of.confounded_with.size(), 2u);
  EXPECT_EQ(of.confounded_with[1].first, 4u);
  EXPECT_FALSE(of.se_jackknife);
  // Nuisance parameters may be undetermined.
  twin.problem.parameters[0].nuisance = twin.problem.parameters[4].nuisance = true;
  EXPECT_EQ(JudgeFit(twin.problem, Fit(twin.problem, {}), {}).judgement, FitJudgement::kGood);
}

TEST(FitTwin, ResidualsThreeTimesTooLargeAreRejectedAndATenthIsSuspicious) {
  const Twin large = MakeTwin(2, 3.0);
  const FitVerdict rejected = JudgeFit(large.problem, Fit(large.problem, {}), {});
  EXPECT_EQ(rejected.judgement, FitJudgement::kRejected);
  EXPECT_EQ(rejected.sentences[0].substr(0, 26), "Rejected: total chi-square");
  const Twin small = MakeTwin(2, 0.1);
  const FitVerdict suspicious = JudgeFit(small.problem, Fit(small.problem, {}), {});
  EXPECT_EQ(suspicious.judgement, FitJudgement::kGood);
  EXPECT_NE(suspicious.sentences[1].find("smaller than their standard deviations"),
            std::string::npos);
}

TEST(FitJudge, OfALinearModelChiSquareHasItsDistribution) {
  // p of all residuals is uniform between 0 and 1: its mean over seeds is 1/2, sd 1 / sqrt(12).
  double whole = 0, data = 0, prior = 0, data_freedom = 0, prior_freedom = 0;
  double data_value = 0, prior_value = 0;
  const int runs = 300;
  for (int seed = 1; seed <= runs; ++seed) {
    math::Random random(static_cast<std::uint64_t>(seed), 7, 2);
    test::Linear linear = test::RandomLinear(6, 3, 99);
    std::vector<FitParameter> p;
    std::vector<double> truth;
    for (int j = 0; j < 3; ++j) {
      p.push_back(Parameter(std::to_string(j), 0, 0));
      p.back().prior_sd = 0.3 * (j + 1);
      truth.push_back(p.back().prior_sd * random.Normal());
    }
    for (std::size_t i = 0; i < 6; ++i) {
      linear.b[i] = random.Normal();
      for (std::size_t j = 0; j < 3; ++j) linear.b[i] += linear.A[i][j] * truth[j];
    }
    const FitProblem problem = MakeProblem(p, 6, linear);
    const FitVerdict of = JudgeFit(problem, Fit(problem, {}), {});
    EXPECT_NEAR(of.total.freedom, 6, 1e-9);
    whole += of.total.p / runs;
    data += of.data.p / runs;
    prior += of.prior.p / runs;
    data_value += of.data.value / runs;
    prior_value += of.prior.value / runs;
    data_freedom = of.data.freedom;
    prior_freedom = of.prior.freedom;
  }
  const double three_errors = 3 / std::sqrt(12.0 * runs);
  EXPECT_NEAR(whole, 0.5, three_errors);
  EXPECT_NEAR(data, 0.5, three_errors);
  EXPECT_NEAR(prior, 0.5, three_errors);
  EXPECT_NEAR(data_freedom + prior_freedom, 6, 1e-6);
  EXPECT_NEAR(data_value, data_freedom, 3 * std::sqrt(2 * data_freedom / runs));
  EXPECT_NEAR(prior_value, prior_freedom, 3 * std::sqrt(2 * prior_freedom / runs));
}

TEST(FitJudge, OfOneDirectionThePartsAreExact) {
  // x ~ N(0, 1), y = x + N(0, 1) = b: x^ = b / 2. The residuals of the datum and of the prior are b
  // / 2 with variance 1 / 2, so that both have p = erfc(b / 2), as have all residuals together.
  FitParameter x = Parameter("x", 0, 0);
  x.prior_sd = 1;
  for (const double b : {0.3, 1.0, 4.0}) {
    const auto problem = MakeProblem({x}, 1, [b](const std::vector<double>& v) {
      return Residuals{{v[0] - b}, ""};
    });
    const FitVerdict of = JudgeFit(problem, Fit(problem, {}), {});
    EXPECT_NEAR(of.data.value, b * b / 4, 1e-7);  // a step of 1e-8 ends the search
    EXPECT_NEAR(of.data.freedom, 0.5, 1e-9);
    for (const ChiSquare& part : {of.data, of.prior, of.total}) {
      EXPECT_NEAR(part.p / std::erfc(b / 2), 1, 1e-7);
    }
  }
}

TEST(FitJudge, APriorThatTheDataContradictIsNamed) {
  FitParameter push = Parameter("push", 22, 0);
  push.prior_sd = 3;
  push.unit = "N";
  const auto problem = MakeProblem({push}, 4, [](const std::vector<double>& v) -> Residuals {
    return {{v[0] - 42, v[0] - 43, v[0] - 42, v[0] - 41}, ""};
  });
  const FitVerdict verdict = JudgeFit(problem, Fit(problem, {}), {});
  EXPECT_EQ(verdict.judgement, FitJudgement::kRejected);
  EXPECT_NE(
      verdict.sentences[0].find("push is 6.486 prior standard deviations from its prior mean"),
      std::string::npos)
      << verdict.sentences[0];
}

TEST(FitJudge, WhereAllIsAtItsBoundThereIsStillAVerdict) {
  FitParameter p = Parameter("mass", 1);
  p.high = 1;
  auto problem = MakeProblem({p}, 3, [](const std::vector<double>& v) -> Residuals {
    return {{v[0] - 2, v[0] - 3, v[0] - 2}, ""};
  });
  for (int i = 0; i < 3; ++i) problem.rows[static_cast<std::size_t>(i)].group = i;
  VerdictOptions options;
  options.folds = 0;
  const FitVerdict verdict = JudgeFit(problem, Fit(problem, {}), options);
  EXPECT_EQ(verdict.judgement, FitJudgement::kUnidentifiable);
  EXPECT_EQ(verdict.identifiability.parameters[0].kind, Determined::kAtBound);
  EXPECT_NEAR(verdict.total.freedom, 3, 1e-12);
  EXPECT_TRUE(verdict.identifiability.directions.empty());
}

TEST(FitJudge, SixDataOfNineteenParametersFixSixCombinationsAtMost) {
  const test::Linear linear = test::RandomLinear(6, 19, 8);
  std::vector<FitParameter> p;
  for (int j = 0; j < 19; ++j) {
    p.push_back(Parameter(std::to_string(j), 0, 0));
    p.back().prior_sd = 1;
  }
  const auto problem = MakeProblem(p, 6, linear);
  const FitVerdict verdict = JudgeFit(problem, Fit(problem, {}), {});
  EXPECT_EQ(verdict.judgement, FitJudgement::kUnidentifiable);
  EXPECT_EQ(verdict.identifiability.fixed, 6);
  EXPECT_EQ(verdict.identifiability.endless, 0);
  EXPECT_TRUE(std::isinf(verdict.identifiability.condition));
  EXPECT_NEAR(verdict.total.freedom, 6, 1e-12);
}

TEST(FitJudge, WorseOnTheHoldOutIsSaid) {
  const Twin twin = MakeTwin(3);
  FitProblem test = twin.problem;  // another robot, which the untuned values fit
  test.forward = [](std::span<const std::vector<double>> points) {
    std::vector<Residuals> answers;
    for (const auto& v : points) {
      answers.push_back({std::vector<double>(60, 10 * (v[2] - 2)), ""});
    }
    return answers;
  };
  const FitVerdict verdict = JudgeFit(twin.problem, Fit(twin.problem, {}), {}, &test);
  EXPECT_EQ(verdict.judgement, FitJudgement::kWorse);
  EXPECT_EQ(verdict.sentences[0], "Worse than untuned on held-out data.");
}

TEST(FitJudge, WithoutAFitThereIsNoVerdict) {
  const auto problem = MakeProblem({Parameter("x", 0)}, 1, [](const std::vector<double>&) {
    return Residuals{{}, "slack"};
  });
  const FitVerdict verdict = JudgeFit(problem, Fit(problem, {}), {});
  EXPECT_EQ(verdict.judgement, FitJudgement::kNone);
  EXPECT_EQ(verdict.sentences[0], "There is no fit: the start could not be computed: slack");
}

TEST(FitJudge, TheWholeStoryIsTold) {
  const Twin twin = MakeTwin(4);
  FitOptions options;
  options.starts = 4;
  VerdictOptions judge;
  judge.folds = 3;
  judge.jackknife = Jackknife::kRefit;
  const FitVerdict verdict = JudgeFit(twin.problem, Fit(twin.problem, options), judge);
  EXPECT_EQ(verdict.judgement, FitJudgement::kGood);
  EXPECT_TRUE(verdict.jackknife.refit);
  ASSERT_EQ(verdict.sentences.size(), 8u);
  EXPECT_NE(verdict.sentences[1].find("leaving out groups"), std::string::npos);
  EXPECT_NE(verdict.sentences[6].find("on groups left out in turn"), std::string::npos);
  EXPECT_NE(verdict.sentences[7].find("of 4 starts converged to this minimum"), std::string::npos);
}

}  // namespace
}  // namespace taut
