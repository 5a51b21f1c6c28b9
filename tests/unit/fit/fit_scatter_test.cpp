/// Verdicts by errors from groups compared with errors from J^T J
#include <gtest/gtest.h>

#include <cmath>

#include "taut/fit_verdict.h"
#include "unit/fit/fit_problems.h"

namespace taut {
namespace {

using test::MakeProblem;
using test::Parameter;

/// A mean of `each` data of sd 1 in each of `groups`, with shared errors of sd `shared`
FitProblem Mean(std::uint64_t seed, std::size_t groups, std::size_t each, double shared,
                double scale) {
  math::Random random(seed, 7, 3);
  std::vector<double> y;
  for (std::size_t g = 0; g < groups; ++g) {
    const double common = shared * random.Normal();
    for (std::size_t i = 0; i < each; ++i) y.push_back(common + random.Normal());
  }
  FitProblem problem =
      MakeProblem({Parameter("m", 0, scale)}, y.size(), [y](const std::vector<double>& v) {
        Residuals r;
        for (const double one : y) r.value.push_back(v[0] - one);
        return r;
      });
  for (std::size_t i = 0; i < y.size(); ++i) problem.rows[i].group = static_cast<int>(i / each);
  return problem;
}

FitVerdict Judged(const FitProblem& problem) { return JudgeFit(problem, Fit(problem, {}), {}); }

TEST(FitScatter, ANumberThatGroupsDisagreeAboutIsNotEstimated) {
  // Standard error from J^T J: 1 / sqrt(400) = 0.05. From groups: about 0.5 / sqrt(8) = 0.18, with
  // a scale of 0.2.
  const FitVerdict verdict = Judged(Mean(1, 8, 50, 0.5, 0.2));
  const ParameterVerdict& m = verdict.identifiability.parameters[0];
  EXPECT_NEAR(m.se, 0.05, 1e-9);
  ASSERT_TRUE(m.se_jackknife);
  EXPECT_GT(*m.se_jackknife, 0.1);
  EXPECT_TRUE(m.groups_apart);
  EXPECT_EQ(m.kind, Determined::kUnreliable);
  EXPECT_TRUE(verdict.unreliable);
  EXPECT_NE(m.sentence.find("its estimates without one group or another differ"),
            std::string::npos);
  // A nuisance parameter, such as a sensor's offset, need not be determined.
  FitProblem nuisance = Mean(1, 8, 50, 0.5, 0.2);
  nuisance.parameters[0].nuisance = true;
  EXPECT_FALSE(Judged(nuisance).unreliable);
}

TEST(FitScatter, WhereTheErrorByGroupsIsSmallEnoughItIsOnlySaid) {
  const FitVerdict verdict = Judged(Mean(1, 8, 50, 0.5, 2.0));
  const ParameterVerdict& m = verdict.identifiability.parameters[0];
  EXPECT_TRUE(m.groups_apart);
  EXPECT_EQ(m.kind, Determined::kEstimated);
  EXPECT_FALSE(verdict.unidentifiable);
  bool said = false;
  for (const std::string& sentence : verdict.sentences) {
    said |= sentence.find("times the error by J^T J: residuals within a group are correlated") !=
            sentence.npos;
  }
  EXPECT_TRUE(said);
}

/// With independent residuals the false alarm rate is 1e-3: of 400 fits 0.4 are expected, and four
/// or more have a probability of 1e-3.
TEST(FitScatter, ChanceAloneSetsNoGroupsApart) {
  for (const std::size_t groups : {3u, 6u}) {
    int apart = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
      apart += Judged(Mean(seed, groups, 5, 0, 10)).identifiability.parameters[0].groups_apart;
    }
    EXPECT_LE(apart, 3) << groups;
  }
}

/// Three groups determine their scatter badly: a ratio of 2.5 occurs by chance, 2.7 does not.
TEST(FitScatter, FewGroupsNeedALargerDifference) {
  for (const auto& [ratio, apart] : {std::pair(2.5, false), {2.7, true}}) {
    // Means of groups at -d, 0, d have a standard error of d / sqrt(3); from J^T J it is 1 /
    // sqrt(6).
    const double d = ratio / std::sqrt(6.0) * std::sqrt(3.0);
    const std::vector<double> y{-d - 0.1, -d + 0.1, -0.1, 0.1, d - 0.1, d + 0.1};
    FitProblem problem =
        MakeProblem({Parameter("m", 0, 100)}, 6, [y](const std::vector<double>& v) {
          Residuals r;
          for (const double one : y) r.value.push_back(v[0] - one);
          return r;
        });
    for (int i = 0; i < 6; ++i) problem.rows[static_cast<std::size_t>(i)].group = i / 2;
    const FitVerdict verdict = Judged(problem);
    const ParameterVerdict& m = verdict.identifiability.parameters[0];
    EXPECT_NEAR(*m.se_jackknife / m.se, ratio, 1e-6);
    EXPECT_EQ(m.groups_apart, apart);
  }
}

}  // namespace
}  // namespace taut
