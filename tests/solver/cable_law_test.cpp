// The law of a stiff cable is a spring and a damper between slack and its limit
// (docs/theory/cables.md, eq. 11), and its derivatives are those of the law.
#include <gtest/gtest.h>

#include "tests/solver/law_instances.h"

namespace taut::test {
namespace {

constexpr int kInstances = 1000;

enum Case { kSlack, kInside, kAtLimit };

/// The rate at which the cable wishes for an impulse.
double RateFor(const Cable& c, double wish) { return (c.base[0] - wish) / c.gain[0]; }

struct State {
  Rows<1> u, l;
};

/// A solution, off the kinks by 0.05 at least.
State Solution(const Cable& c, Case which, math::Random& random) {
  const double upper = c.upper[0], off = random.Uniform(0.1, 1);
  if (which == kSlack) return {{RateFor(c, -off)}, {0}};
  if (which == kAtLimit) return {{RateFor(c, upper + off)}, {upper}};
  const double l = random.Uniform(0.1 * upper, 0.9 * upper);
  return {{RateFor(c, l)}, {l}};
}

template <class F>
void ForEachInstance(const F& f) {
  for (int i = 0; i < kInstances; ++i) {
    for (const Case which : {kSlack, kInside, kAtLimit}) {
      math::Random random(9, which, static_cast<std::uint64_t>(i));
      const OwnedCable cable(random);
      f(cable.law, which, random);
      if (testing::Test::HasFailure()) FAIL() << "instance " << i << ", case " << which;
    }
  }
}

TEST(CableLaw, SolutionsStayWhereTheyAre) {
  ForEachInstance([](const Cable& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    ExpectSolution(c, s.u, s.l);
    const auto branch = c.BranchOf(Packed(s.u), Packed(s.l));
    EXPECT_EQ(branch.inside[0], which == kInside);
    EXPECT_EQ(branch.lower[0], which == kSlack ? 1 : 0);
  });
}

TEST(CableLaw, NothingElseStays) {
  ForEachInstance([](const Cable& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    for (const double off : {-0.04, 0.04}) {  // pushes; beyond its limit; not the spring's
      const Rows<1> l = {s.l[0] + off};
      ASSERT_GT(Violation(c, s.u, l), 1e-3);
      EXPECT_GT(ResidualOf(c, s.u, l), 1e-4);
      for (const double e : kSoftnesses) {
        // A soft cable moves by 1 / (1 + gain e A) of what is missing.
        const double moves = std::abs(Projected(c, s.u, l, e)[0] - l[0]);
        EXPECT_GT(moves, 0.5 * std::abs(off) / (1 + c.gain[0] * e * c.A[0])) << "e = " << e;
      }
    }
  });
}

TEST(CableLaw, ResidualIsWhatSolvingItAloneWouldChange) {
  ForEachInstance([](const Cable& c, Case which, math::Random& random) {
    State s = Solution(c, which, random);
    ExpectResidualIsNewtons(c, s.u, s.l);
    s.u[0] += random.Uniform(-0.5, 0.5), s.l[0] += random.Uniform(-0.5, 0.5);
    ExpectResidualIsNewtons(c, s.u, s.l);
  });
}

TEST(CableLaw, DerivativesEqualDifferences) {
  int checked[3] = {};
  ForEachInstance([&](const Cable& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    for (const double e : {1.0, 1e-2}) checked[which] += CheckDerivative(c, s.u, s.l, e);
  });
  for (const int count : checked) EXPECT_EQ(count, 2 * kInstances);
}

TEST(CableLaw, ItOnlyPullsBack) {
  ForEachInstance([](const Cable& c, Case, math::Random& random) {
    const Rows<1> a = RandomRows<1>(random, 2), b = RandomRows<1>(random, 2);
    for (const double e : kSoftnesses) ExpectFrozenPushesBack(c, a, b, RandomRows<1>(random), a, e);
  });
}

TEST(CableLaw, LinearizeIsNewtonsEquation) {
  int checked[3] = {};
  ForEachInstance([&](const Cable& c, Case which, math::Random& random) {
    State s = Solution(c, which, random);
    s.l[0] += random.Uniform(-0.5, 0.5);
    for (const double e : {0.0, 1e-2}) checked[which] += CheckLinearize(c, s.u, s.l, e);
  });
  for (const int count : checked) EXPECT_EQ(count, 2 * kInstances);
}

TEST(CableLaw, AloneItIsSolved) {
  int found[3] = {};
  for (int i = 0; i < 3 * kInstances; ++i) {
    math::Random random(10, 0, static_cast<std::uint64_t>(i));
    const OwnedCable cable(random);
    const Cable& c = cable.law;
    const auto [u, l] = SolvedAlone(c, RandomRows<1>(random, 2), {random.Uniform(0, c.upper[0])});
    EXPECT_LT(Violation(c, u, l), 1e-14 * (1 + c.base[0] + Largest(u))) << "instance " << i;
    ++found[l[0] == 0 ? kSlack : l[0] < c.upper[0] ? kInside : kAtLimit];
  }
  for (const int count : found) EXPECT_GT(count, kInstances / 5);
}

TEST(CableLaw, ClampedImpulsesAreAdmissibleAndAdmissibleOnesStay) {
  ForEachInstance([](const Cable& c, Case, math::Random& random) {
    const double any = random.Uniform(-2, 4);
    EXPECT_EQ(Clamped(c, {any})[0], std::clamp(any, 0.0, c.upper[0]));
  });
}

TEST(CableLaw, ALaneWithoutItIsAtRest) {
  ForEachInstance([](Cable c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    c.live = Num::Splat(0.0);
    const auto branch = c.BranchOf(Packed(s.u), Packed(Rows<1>{}));
    EXPECT_EQ(c.Residual(branch, Packed(s.u), Packed(Rows<1>{}))[0], 0);
    sim::LinearLaw<Num, 1> linear;
    c.Linearize(branch, Packed(s.u), Packed(Rows<1>{}), Num::Splat(1e-9), linear);
    EXPECT_EQ(linear.A[0][0][0], 1);  // 1 x = 0
    EXPECT_EQ(linear.S[0][0][0], 0);
    EXPECT_EQ(linear.r[0][0], 0);
  });
}

}  // namespace
}  // namespace taut::test
