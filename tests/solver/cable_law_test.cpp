// Law of a stiff cable: the mean of its spring's tension over the step, with a damper while it is
// stretched (docs/theory/cables.md, eq. 8-11). The law is linear while taut at both ends of the
// step, a curve where the cable goes slack or becomes taut, and between zero and its limit. Its
// derivatives are checked, too.
#include <gtest/gtest.h>

#include "tests/solver/law_instances.h"

namespace taut::test {
namespace {

constexpr int kInstances = 1000;

/// kHeld: taut at both ends, with the tension held at zero by the damper.
enum Case { kSlack, kTaut, kAtLimit, kEnters, kLeaves, kHeld, kCases };

struct State {
  Rows<1> u, l;
};

/// Returns the case of u, or kCases if u is less than 0.05 from a kink, on a flatter slope, or
/// where Wish divides by a small number.
Case CaseOf(const Cable& c, const Rows<1>& u) {
  constexpr double kOff = 0.05;
  const double z = EndOf(c, u), z0 = c.start[0], wish = Wish(c, u);
  if (std::abs(z) < kOff || std::abs(z0) < kOff || std::abs(z - z0) < 2 * kOff) return kCases;
  if (z < 0 && z0 < 0) return kSlack;
  if (std::abs(wish) < kOff || std::abs(wish - c.upper[0]) < kOff) return kCases;
  if (wish > c.upper[0]) return kAtLimit;
  if (z > 0 && z0 > 0) return wish > 0 ? kTaut : kHeld;
  if (wish < 0 || SlopeOfWish(c, u) < kOff) return kCases;
  return z > 0 ? kEnters : kLeaves;
}

bool IsInside(Case which) { return which == kTaut || which == kEnters || which == kLeaves; }

/// Calls `f(cable, case, random, state)` with solutions of different cables. Most draws are of
/// other cases, so the bodies, which take most of the time, are drawn last.
template <class F>
void ForEachInstance(const F& f) {
  for (int i = 0; i < kInstances; ++i) {
    for (int which = 0; which < kCases; ++which) {
      for (int again = 0;; ++again) {
        ASSERT_LT(again, 10000);
        math::Random random(9, static_cast<std::uint32_t>(which + kCases * again),
                            static_cast<std::uint64_t>(i));
        std::vector<double> numbers = RandomLawNumbers(random);
        const Cable law = LawOf(numbers);
        const Rows<1> u = {law.end[0] - random.Uniform(-1, 1)};
        if (CaseOf(law, u) != which) continue;
        AddCableBodies(random, numbers);
        const OwnedCable cable(numbers);
        const Cable& c = cable.law;
        f(c, static_cast<Case>(which), random, State{u, {std::clamp(Wish(c, u), 0.0, c.upper[0])}});
        break;
      }
      if (testing::Test::HasFailure()) FAIL() << "instance " << i << ", case " << which;
    }
  }
}

TEST(CableLaw, SolutionsStayWhereTheyAre) {
  ForEachInstance([](const Cable& c, Case which, math::Random&, const State& s) {
    ExpectSolution(c, s.u, s.l);
    const auto branch = c.BranchOf(Packed(s.u), Packed(s.l));
    EXPECT_EQ(branch.inside[0], IsInside(which));
    EXPECT_EQ(branch.lower[0], which == kSlack || which == kHeld ? 1 : 0);
  });
}

TEST(CableLaw, NothingElseStays) {
  constexpr double kSteepest = 15;  // steepest slope of a curve of width 0.1, with winding
  ForEachInstance([](const Cable& c, Case, math::Random&, const State& s) {
    for (const double off : {-0.04, 0.04}) {  // pushes; beyond its limit; off the spring's law
      const Rows<1> l = {s.l[0] + off};
      ASSERT_GT(Violation(c, s.u, l), 1e-3);
      EXPECT_GT(ResidualOf(c, s.u, l), 1e-4);
      for (const double e : kSoftnesses) {
        // A soft cable corrects 1 / (1 + slope e A) of the error.
        const double moves = std::abs(Projected(c, s.u, l, e)[0] - l[0]);
        EXPECT_GT(moves, 0.5 * std::abs(off) / (1 + kSteepest * e * c.A[0])) << "e = " << e;
      }
    }
  });
}

TEST(CableLaw, ResidualIsWhatSolvingItAloneWouldChange) {
  ForEachInstance([](const Cable& c, Case, math::Random& random, State s) {
    ExpectResidualIsNewtons(c, s.u, s.l);
    s.u[0] += random.Uniform(-0.5, 0.5), s.l[0] += random.Uniform(-0.5, 0.5);
    // To first order: along the line, or along the curve.
    const bool crosses = (c.start[0] > 0) != (EndOf(c, s.u) > 0);
    const double a = InverseMassOf(c)[0][0];
    const double slope = crosses ? std::max(SlopeOfWish(c, s.u), 0.0) : c.gain[0];
    const double expected = a / (1 + slope * a) * Violation(c, s.u, s.l);
    EXPECT_NEAR(ResidualOf(c, s.u, s.l), expected, 1e-11 * (1 + expected));
  });
}

TEST(CableLaw, DerivativesEqualDifferences) {
  int checked[kCases] = {};
  ForEachInstance([&](const Cable& c, Case which, math::Random&, const State& s) {
    for (const double e : {1.0, 1e-2}) checked[which] += CheckDerivative(c, s.u, s.l, e);
  });
  for (const int count : checked) EXPECT_EQ(count, 2 * kInstances);
}

TEST(CableLaw, ItOnlyPullsBack) {
  ForEachInstance([](const Cable& c, Case, math::Random& random, const State&) {
    const Rows<1> a = RandomRows<1>(random, 2), b = RandomRows<1>(random, 2);
    for (const double e : kSoftnesses) ExpectFrozenPushesBack(c, a, b, RandomRows<1>(random), a, e);
  });
}

TEST(CableLaw, LinearizeIsNewtonsEquation) {
  int checked[kCases] = {};
  ForEachInstance([&](const Cable& c, Case which, math::Random& random, State s) {
    s.l[0] += random.Uniform(-0.5, 0.5);
    for (const double e : {0.0, 1e-2}) checked[which] += CheckLinearize(c, s.u, s.l, e);
  });
  for (const int count : checked) EXPECT_EQ(count, 2 * kInstances);
}

TEST(CableLaw, AloneItIsSolved) {
  int found[kCases + 1] = {};
  for (int i = 0; i < 10 * kInstances; ++i) {
    math::Random random(10, 0, static_cast<std::uint64_t>(i));
    const OwnedCable cable(random);
    const Cable& c = cable.law;
    const Rows<1> l0 = {random.Uniform(0, std::min(c.upper[0], 2.0))};
    const auto [u, l] = SolvedAlone(c, RandomRows<1>(random, 3), l0);
    if (EndOf(c, u) == c.start[0]) continue;  // Wish is undefined there
    // Rounding of u, through impulses and masses, and of the law's terms.
    const double moved = InverseMassOf(c)[0][0] * (l[0] + l0[0]);
    const double sizes = 1 + std::abs(c.base[0]) + (1 + c.gain[0]) * (Largest(u) + moved);
    const double steepness = 1 / std::min(1.0, std::abs(EndOf(c, u) - c.start[0]));
    EXPECT_LT(Violation(c, u, l), 1e-14 * sizes * steepness) << "instance " << i;
    ++found[CaseOf(c, u)];
  }
  for (int which = 0; which < kCases; ++which) EXPECT_GT(found[which], 5) << which;
}

TEST(CableLaw, ClampedImpulsesAreAdmissibleAndAdmissibleOnesStay) {
  ForEachInstance([](const Cable& c, Case, math::Random& random, const State&) {
    const double any = random.Uniform(-2, 4);
    EXPECT_EQ(Clamped(c, {any})[0], std::clamp(any, 0.0, c.upper[0]));
  });
}

TEST(CableLaw, ACableThatEndsAsItStartedHasTheTensionOfItsStretch) {
  // The mean over zero travel: the limit of the formula, not 0 / 0.
  for (const double z : {1.0, 1e-3, 1e-15, 0.0, -1e-15, -1.0}) {
    math::Random random(13, 0, 0);
    OwnedCable cable(random);
    Cable& c = cable.law;
    c.SetLaw(Num::Splat(z), Num::Splat(z), Num::Splat(0.5), Num::Splat(0.25), Num::Splat(0.0));
    c.upper = Num::Splat(1e300);
    const Rows<1> u = {0}, l = {std::max(z, 0.0)};  // 2 spring z
    EXPECT_EQ(ResidualOf(c, u, l), 0) << z;
    for (const double e : kSoftnesses) EXPECT_NEAR(Projected(c, u, l, e)[0], l[0], 1e-15) << z;
  }
}

TEST(CableLaw, ALaneWithoutItIsAtRest) {
  ForEachInstance([](Cable c, Case, math::Random&, const State& s) {
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
