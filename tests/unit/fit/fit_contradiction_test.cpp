/// Standard errors that residuals, other starts, other experiments or omitted effects contradict
#include <gtest/gtest.h>

#include <cmath>

#include "taut/fit_verdict.h"
#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::MakeProblem;
using test::Parameter;

bool Contains(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts) {
    if (text.find(part) != std::string::npos) return true;
  }
  return false;
}

FitVerdict VerdictOn(const FitProblem& problem) { return JudgeFit(problem, Fit(problem, {}), {}); }

TEST(FitContradiction, LargeResidualsContradictTheErrorAndEnlargeIt) {
  // Data of sd 1 with deviations of 3: 20 data determine the mean to 1 / sqrt(20) at best.
  FitProblem problem =
      MakeProblem({Parameter("m", 0, 10)}, 20, [](const std::vector<double>& v) -> Residuals {
        Residuals r;
        for (int i = 0; i < 20; ++i) r.value.push_back(v[0] - (i % 2 == 0 ? 3 : -3));
        return r;
      });
  const FitVerdict verdict = VerdictOn(problem);
  const ParameterVerdict& m = verdict.identifiability.parameters[0];
  EXPECT_TRUE(verdict.rejected);
  EXPECT_EQ(m.kind, Determined::kUnreliable);
  ASSERT_TRUE(m.se_residuals);
  EXPECT_NEAR(*m.se_residuals / m.se, std::sqrt(20 * 9.0 / 19), 1e-6);
  EXPECT_EQ(m.error(), *m.se_residuals);
  EXPECT_TRUE(Contains(m.contradictions, "3.078 times as large as their standard deviations"));
}

TEST(FitContradiction, AnotherStartWithTheSameCostContradictsTheError) {
  // Two minima, at x = 1 and x = -1.
  FitParameter x = Parameter("x", 0.8, 1);
  x.low = -3, x.high = 3;
  const FitProblem problem = MakeProblem({x}, 4, [](const std::vector<double>& v) {
    return Residuals{std::vector<double>(4, 50 * (v[0] * v[0] - 1)), ""};
  });
  FitOptions options;
  options.starts = 8;
  const FitResult fit = Fit(problem, options);
  const FitVerdict verdict = JudgeFit(problem, fit, {});
  const ParameterVerdict& of = verdict.identifiability.parameters[0];
  EXPECT_NEAR(std::fabs(of.value), 1, 1e-6);
  EXPECT_EQ(of.kind, Determined::kUnreliable) << of.sentence;
  EXPECT_TRUE(Contains(of.contradictions, "another start ended at "));
  EXPECT_EQ(verdict.judgement, FitJudgement::kUnreliable);
  EXPECT_EQ(verdict.sentences[0], "Unreliable: other results contradict the standard error of x.");
  // All starts with their chi-square, and without other starts nothing to contradict.
  EXPECT_TRUE(Contains(verdict.sentences, "of 8 starts converged to this minimum; chi-square by"));
  EXPECT_EQ(VerdictOn(problem).judgement, FitJudgement::kGood);
}

TEST(FitContradiction, ChiSquareOneErrorAwayContradictsAnErrorBySlopesAtAPoint) {
  // The slope at 0 is 1, so the error by J^T J is 1. There the residual is 101 instead of 1.
  FitParameter x = Parameter("x", 0.0, 4);
  x.step = 1e-4;
  const FitVerdict verdict =
      VerdictOn(MakeProblem({x}, 2, [](const std::vector<double>& v) -> Residuals {
        return {{v[0] + 100 * v[0] * v[0] * v[0], 0}, ""};
      }));
  const ParameterVerdict& of = verdict.identifiability.parameters[0];
  EXPECT_NEAR(of.se, 1, 1e-3);
  EXPECT_EQ(of.kind, Determined::kUnreliable) << of.sentence;
  EXPECT_TRUE(Contains(of.contradictions, "one standard error away, chi-square changes by +1.02"))
      << of.sentence;
}

TEST(FitContradiction, ANullDirectionThatMovesTheResidualsIsNotConfounded) {
  // Noise of the differences hides that half of the data determine a and the other half b.
  const auto model = [](const std::vector<double>& v) {
    Residuals r;
    for (int i = 0; i < 40; ++i) {
      const double jump = 1.5 * std::sin(1e5 * (v[0] + 3 * v[1]) + i);
      r.value.push_back((i < 20 ? 30 * v[0] : 20 * v[1]) + jump);
    }
    return r;
  };
  const FitProblem problem = MakeProblem({Parameter("a", 0), Parameter("b", 0)}, 40, model);
  const FitDerivatives derivatives = Differentiate(problem, {0, 0});
  const Identifiability of = Identify(problem, {0, 0}, derivatives);
  EXPECT_TRUE(of.directions[1].null);
  for (const ParameterVerdict& one : of.parameters) {
    EXPECT_TRUE(std::isinf(one.se));
    EXPECT_EQ(one.kind, Determined::kUnreliable) << one.sentence;
    EXPECT_NE(one.sentence.find("its derivatives are too inaccurate"), std::string::npos);
  }
}

/// Means of three experiments with 50 data each, whose true values are `apart` from each other.
FitProblem Experiments(std::uint64_t seed, double apart) {
  math::Random random(seed, 7, 5);
  std::vector<double> y;
  for (int e = 0; e < 3; ++e) {
    for (int i = 0; i < 50; ++i) y.push_back(apart * e + random.Normal());
  }
  FitProblem problem =
      MakeProblem({Parameter("m", 0, 10)}, y.size(), [y](const std::vector<double>& v) {
        Residuals r;
        for (const double one : y) r.value.push_back(v[0] - one);
        return r;
      });
  for (std::size_t i = 0; i < y.size(); ++i) {
    problem.rows[i].group = static_cast<int>(i);  // groups need not be experiments
    problem.rows[i].experiment = static_cast<int>(i / 50);
  }
  problem.experiment_names = {"t0", "t1", "t2"};
  return problem;
}

TEST(FitContradiction, ExperimentsThatDisagreeAreNamed) {
  for (const Jackknife how : {Jackknife::kStep, Jackknife::kRefit}) {
    const FitProblem problem = Experiments(1, 0.6);
    VerdictOptions options;
    options.jackknife = how;
    const FitVerdict verdict = JudgeFit(problem, Fit(problem, {}), options);
    EXPECT_TRUE(verdict.contradiction);
    EXPECT_EQ(verdict.judgement, FitJudgement::kContradiction) << verdict.sentences[0];
    EXPECT_EQ(
        verdict.sentences[0].find(
            "Contradiction: experiments fitted alone disagree by more than their errors; m: "),
        0u)
        << verdict.sentences[0];
    EXPECT_NE(verdict.sentences[0].find(" from t2"), std::string::npos);
    ASSERT_EQ(verdict.alone.fits.size(), 3u);
    for (int e = 0; e < 3; ++e) {
      const AloneFit& one = verdict.alone.fits[static_cast<std::size_t>(e)];
      EXPECT_NEAR(*one.value[0], 0.6 * e, 0.5);
      EXPECT_NEAR(*one.se[0], 1 / std::sqrt(50.0), 0.03);
    }
    EXPECT_EQ(verdict.identifiability.parameters[0].kind, Determined::kUnreliable);
  }
}

/// The false alarm rate is 1e-3: of 100 fits 0.1 are expected, and three or more have a probability
/// of 1.5e-4.
TEST(FitContradiction, ChanceAloneMakesNoContradiction) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    found += VerdictOn(Experiments(seed, 0)).contradiction ? 1 : 0;
  }
  EXPECT_LE(found, 2);
}

TEST(FitContradiction, AParameterOfOneExperimentContradictsNothing) {
  // Experiment 0 measures a, experiment 1 measures b.
  FitProblem problem = MakeProblem({Parameter("a", 0, 10), Parameter("b", 0, 10)}, 20,
                                   [](const std::vector<double>& v) {
                                     Residuals r;
                                     for (int i = 0; i < 10; ++i) r.value.push_back(v[0] - 1);
                                     for (int i = 0; i < 10; ++i) r.value.push_back(v[1] - 5);
                                     return r;
                                   });
  for (int i = 0; i < 20; ++i) problem.rows[static_cast<std::size_t>(i)].experiment = i / 10;
  const FitVerdict verdict = VerdictOn(problem);
  EXPECT_FALSE(verdict.contradiction);
  EXPECT_TRUE(verdict.alone.tested.empty());
  EXPECT_FALSE(verdict.alone.fits[0].value[1]);
}

/// Forces y = gain * k x + offset with errors of sd 0.1; the fit estimates k.
struct Sensor {
  std::vector<double> x, y;
  FitProblem problem;
  std::vector<double> computed(double k) const {
    std::vector<double> out;
    for (const double one : x) out.push_back(2 + k * one);
    return out;
  }
};
Sensor MakeSensor(double gain, double offset) {
  Sensor sensor;
  math::Random random(3, 7, 6);
  for (int i = 0; i < 60; ++i) {
    sensor.x.push_back(0.1 * i);
    sensor.y.push_back(gain * (2 + 1.5 * sensor.x.back()) + offset + 0.1 * random.Normal());
  }
  sensor.problem =
      MakeProblem({Parameter("k", 1, 1)}, 60, [x = sensor.x, y = sensor.y](const auto& v) {
        Residuals r;
        for (std::size_t i = 0; i < x.size(); ++i) {
          r.value.push_back((2 + v[0] * x[i] - y[i]) / 0.1);
        }
        return r;
      });
  return sensor;
}

std::vector<FitAlias> SensorAliases(const Sensor& sensor, const std::vector<double>& residual) {
  FitAlias gain{"gain *_n", "", 1, {}}, offset{"offset *_n", "N", 0, {}};
  for (std::size_t i = 0; i < sensor.y.size(); ++i) {
    gain.slope.push_back((sensor.y[i] + 0.1 * residual[i]) / 0.1);
    offset.slope.push_back(1 / 0.1);
  }
  return {gain, offset};
}

TEST(FitContradiction, AnOmittedGainIsFoundWithItsValue) {
  const Sensor sensor = MakeSensor(0.9, 0);
  VerdictOptions options;
  options.aliases = [&](const auto& residual) { return SensorAliases(sensor, residual); };
  const FitResult fit = Fit(sensor.problem, {});
  const FitVerdict verdict = JudgeFit(sensor.problem, fit, options);
  ASSERT_EQ(verdict.aliases.size(), 2u);
  const AliasTest* gain = nullptr;
  for (const AliasTest& test : verdict.aliases) {
    if (test.name == "gain *_n") gain = &test;
  }
  ASSERT_NE(gain, nullptr);
  // To first order in gain - 1: of second order are 0.1^2.
  EXPECT_NEAR(gain->value, 0.9, 0.02);
  EXPECT_LT(gain->p, 1e-6);
  EXPECT_NEAR(fit.values[0] + gain->change[0], 1.5, 0.05);
  EXPECT_GT(std::fabs(fit.values[0] - 1.5), 0.05);
  EXPECT_EQ(verdict.identifiability.parameters[0].kind, Determined::kUnreliable);
  EXPECT_TRUE(Contains(verdict.identifiability.parameters[0].contradictions,
                       "if the gain *_n were estimated"));
}

TEST(FitContradiction, TheScoreTestIsTheRefitOfALinearModel) {
  const Sensor sensor = MakeSensor(1, 0.15);
  const FitResult fit = Fit(sensor.problem, {});
  const FitDerivatives derivatives = Differentiate(sensor.problem, fit.values);
  const std::vector<FitAlias> aliases = SensorAliases(sensor, derivatives.residual);
  const auto tests = TestAliases(sensor.problem, fit.values, derivatives, {&aliases[1], 1});
  FitProblem extended = sensor.problem;
  extended.parameters.push_back(Parameter("offset", 0, 1));
  extended.forward = [inner = sensor.problem.forward](std::span<const std::vector<double>> points) {
    std::vector<Residuals> out;
    for (const auto& point : points) {
      const std::vector<double> one{point[0]};
      out.push_back(inner({&one, 1})[0]);
      for (double& r : out.back().value) r += point[1] / 0.1;
    }
    return out;
  };
  const FitResult both = Fit(extended, {});
  const Identifiability of = Identify(extended, both.values, Differentiate(extended, both.values));
  ASSERT_EQ(tests.size(), 1u);
  EXPECT_NEAR(tests[0].value, both.values[1], 1e-6);
  EXPECT_NEAR(tests[0].fall, 2 * (fit.cost - both.cost), 1e-6);
  EXPECT_NEAR(fit.values[0] + tests[0].change[0], both.values[0], 1e-6);
  EXPECT_NEAR(tests[0].se / of.parameters[1].se, std::max(1.0, std::sqrt(2 * both.cost / 58)),
              1e-6);
  const double alone = Identify(sensor.problem, fit.values, derivatives).parameters[0].se;
  EXPECT_NEAR(tests[0].se_ratio[0], of.parameters[0].se / alone, 1e-6);
  // An effect that a parameter already has is no separate effect.
  FitAlias same{"same", "", 0, derivatives.columns[0].slope};
  EXPECT_TRUE(TestAliases(sensor.problem, fit.values, derivatives, {&same, 1})[0].confounded);
}

TEST(FitContradiction, WithoutAnOmittedEffectNothingIsFound) {
  const Sensor sensor = MakeSensor(1, 0);
  VerdictOptions options;
  options.aliases = [&](const auto& residual) { return SensorAliases(sensor, residual); };
  const FitVerdict verdict = JudgeFit(sensor.problem, Fit(sensor.problem, {}), options);
  EXPECT_EQ(verdict.judgement, FitJudgement::kGood) << verdict.sentences[0];
  for (const AliasTest& test : verdict.aliases) EXPECT_GT(test.p, 1e-3) << test.sentence;
}

}  // namespace
}  // namespace taut
