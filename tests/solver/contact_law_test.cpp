// Law of a contact: Coulomb friction with complementarity (docs/theory/contact.md, C1 and C2), its
// derivatives, and the solution of a single contact for any steepness of its cone.
#include <gtest/gtest.h>

#include "tests/solver/law_instances.h"

namespace taut::test {
namespace {

constexpr int kInstances = 1000;

enum Case { kOpen, kSticking, kSliding };

struct State {
  Rows<3> u, l;
};

/// Returns a solution with impulses and gaps between 0.2 and 1.2.
State Solution(const Contact2& c, Case which, math::Random& random) {
  State s{};
  const double bias[3] = {c.bias[0][0], c.bias[1][0], c.bias[2][0]};
  for (std::size_t r = 0; r < 3; ++r) s.u[r] = -bias[r];
  const double size = random.Uniform(0.2, 1.2), angle = random.Uniform(0, 6.28);
  const double d1 = c.one_direction ? (angle < 3.14 ? 1 : -1) : std::cos(angle);
  const double d2 = c.one_direction ? 0 : std::sin(angle);
  if (which == kOpen) {
    s.u[0] += size, s.u[1] += d1, s.u[2] += d2;
    return s;
  }
  s.l[0] = size;
  const double edge = c.mu[0] * s.l[0];
  if (which == kSticking) {
    const double share = random.Uniform(0.0, 0.9);
    s.l[1] = share * edge * d1, s.l[2] = share * edge * d2;
  } else {
    const double speed = random.Uniform(0.2, 1.2);
    s.l[1] = edge * d1, s.l[2] = edge * d2;
    s.u[1] -= speed * d1, s.u[2] -= speed * d2;
  }
  if (c.one_direction) s.u[2] = random.Uniform(-1, 1);
  return s;
}

/// Calls f(contact, case, random) for equally many contacts of each case, with cones and lines.
template <class F>
void ForEachInstance(const F& f) {
  for (int i = 0; i < kInstances; ++i) {
    for (const bool one_direction : {false, true}) {
      for (const Case which : {kOpen, kSticking, kSliding}) {
        math::Random random(7, which, static_cast<std::uint64_t>(2 * i + one_direction));
        f(RandomContact(random, one_direction), which, random);
        if (testing::Test::HasFailure()) {
          FAIL() << "instance " << i << ", case " << which << (one_direction ? ", a line" : "");
        }
      }
    }
  }
}

TEST(ContactLaw, SolutionsStayWhereTheyAre) {
  ForEachInstance([](const Contact2& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    ExpectSolution(c, s.u, s.l);
    const auto branch = c.BranchOf(Packed(s.u), Packed(s.l));
    EXPECT_EQ(branch.closed[0], which != kOpen);
    EXPECT_EQ(branch.slides[0], which == kSliding);
  });
}

TEST(ContactLaw, NothingElseStays) {
  ForEachInstance([](const Contact2& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    const double off = random.Uniform(0.05, 0.2);
    State x = s;
    x.u[0] = -c.bias[0][0] - off;  // penetration
    ExpectNoSolution(c, x.u, x.l);
    x = s, x.l[0] = -off;  // adhesion
    ExpectNoSolution(c, x.u, x.l);
    x = s, x.u[0] += off, x.l[0] += off;  // a normal force at a distance
    ExpectNoSolution(c, x.u, x.l);
    if (which == kOpen) {
      x = s, x.l[1] = off;  // friction at a distance
      ExpectNoSolution(c, x.u, x.l);
    }
    if (which == kSticking) {
      x = s, x.u[1] += off;  // slip below the friction limit
      ExpectNoSolution(c, x.u, x.l);
    }
    if (which == kSliding) {
      for (const double factor : {-1.0, 0.8, 1.2}) {  // accelerates; too little friction; too much
        x = s, x.l[1] *= factor, x.l[2] *= factor;
        ExpectNoSolution(c, x.u, x.l);
      }
      x = s, x.l[1] = 1.3 * s.l[1], x.l[2] = 1.3 * s.l[2];  // sticks beyond its limit
      for (std::size_t r = 1; r < 3; ++r) x.u[r] = -c.bias[r][0];
      ExpectNoSolution(c, x.u, x.l);
    }
    if (which == kSliding && !c.one_direction) {
      const double cosine = std::cos(off), sine = std::sin(off);  // friction at a wrong angle
      x = s, x.l[1] = cosine * s.l[1] - sine * s.l[2], x.l[2] = sine * s.l[1] + cosine * s.l[2];
      ExpectNoSolution(c, x.u, x.l);
    }
    if (c.one_direction) {
      x = s, x.l[2] = off;  // friction across the line
      ExpectNoSolution(c, x.u, x.l);
    }
  });
}

TEST(ContactLaw, ReachIsWhereARayOfImpulsesLeavesItsBranch) {
  int leaves = 0, stays = 0;
  ForEachInstance([&](const Contact2& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    const auto branch = c.BranchOf(Packed(s.u), Packed(s.l));
    Rows<3> dl = RandomRows<3>(random);
    if (random.Uniform(0, 1) < 0.5) dl[0] += 3;  // some never leave their branch
    const double t = c.Reach(branch, Packed(s.l), Packed(dl))[0];
    if (which == kOpen) {
      EXPECT_EQ(t, 1e300);
      return;
    }
    const auto holds = [&](double at) {
      const double n = s.l[0] + at * dl[0], t1 = s.l[1] + at * dl[1];
      const double t2 = c.one_direction ? 0 : s.l[2] + at * dl[2];
      return n > 0 && (which == kSliding || std::hypot(t1, t2) < c.mu[0] * n);
    };
    if (t > 1e9) {
      ++stays;
      EXPECT_TRUE(holds(1e6));
      return;
    }
    ++leaves;
    EXPECT_TRUE(holds(0.999 * t)) << t;
    EXPECT_FALSE(holds(1.001 * t)) << t;
  });
  EXPECT_GT(leaves, 1000);
  EXPECT_GT(stays, 300);
}

TEST(ContactLaw, WhatGivesInHoldsAtAnyVelocity) {
  ForEachInstance([](Contact2 c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    const auto branch = c.BranchOf(Packed(s.u), Packed(s.l));
    Rows<3> u = s.u;
    for (double& x : u) x += random.Uniform(-1e-6, 1e-6);
    Num change[3];
    c.Disagreement(branch, Packed(u), Packed(s.l), change);
    c.Relax(change);
    EXPECT_LT(c.Residual(c.BranchOf(Packed(u), Packed(s.l)), Packed(u), Packed(s.l))[0], 1e-12);
    const std::size_t held = which == kOpen ? 0 : c.one_direction ? 2 : 3;
    for (std::size_t r = held; r < 3; ++r) EXPECT_EQ(change[r][0], 0);
    // Slip opposite to friction remains, at the same speed.
    const double along = change[1][0] * s.l[1] + change[2][0] * s.l[2];
    if (which == kSliding) {
      EXPECT_NEAR(along, 0, 1e-15);
    }
  });
}

TEST(ContactLaw, ASolutionIsNotRelaxed) {
  ForEachInstance([](const Contact2& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    Num change[3];
    c.Disagreement(c.BranchOf(Packed(s.u), Packed(s.l)), Packed(s.u), Packed(s.l), change);
    for (const Num& x : change) EXPECT_NEAR(x[0], 0, 1e-12);
  });
}

TEST(ContactLaw, ResidualIsWhatOneStepWouldChange) {
  ForEachInstance([](const Contact2& c, Case which, math::Random& random) {
    State s = Solution(c, which, random);
    ExpectResidualIsNewtons(c, s.u, s.l);
    for (double& x : s.u) x += random.Uniform(-0.2, 0.2);
    for (double& x : s.l) x += random.Uniform(-0.2, 0.2);
    ExpectResidualIsNewtons(c, s.u, s.l);
  });
}

TEST(ContactLaw, DerivativesEqualDifferences) {
  int checked[3] = {};
  ForEachInstance([&](const Contact2& c, Case which, math::Random& random) {
    State s = Solution(c, which, random);
    for (double& x : s.u) x += random.Uniform(-0.05, 0.05);
    for (const double e : {1.0, 1e-2}) checked[which] += CheckDerivative(c, s.u, s.l, e);
    if (which != kOpen) return;
    // open and not slipping: friction is 0
    s.u[1] = -c.bias[1][0], s.u[2] = -c.bias[2][0];
    EXPECT_TRUE(CheckDerivative(c, s.u, s.l, 1.0));
  });
  for (const int count : checked) EXPECT_GT(count, 0.95 * 2 * 2 * kInstances) << "next to a kink";
}

TEST(ContactLaw, StiffenedFullyFrictionHoldsInAllDirectionsAlike) {
  ForEachInstance([](const Contact2& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    Num g[9], stiff[9];
    Packed<3> l;
    const auto branch = c.Project(Packed(s.u), Packed(s.l), Num::Splat(1.0), l);
    c.Derivative(branch, Num::Splat(1.0), g);
    std::copy(g, g + 9, stiff);
    c.Stiffen(branch, Num::Splat(1.0), stiff);
    const bool turns = which == kSliding && !c.one_direction;
    const double trace = g[4][0] + g[8][0];
    for (std::size_t i = 0; i < 9; ++i) {
      const bool friction = i == 4 || i == 5 || i == 7 || i == 8;
      const double alike = i == 4 || i == 8 ? trace : 0;
      EXPECT_NEAR(stiff[i][0], turns && friction ? alike : g[i][0], 1e-14 * (1 + trace)) << i;
    }
  });
}

TEST(ContactLaw, FrozenFrictionOnlyPushesBack) {
  ForEachInstance([](const Contact2& c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    const Rows<3> l0 = {random.Uniform(0, 1), 0, 0};
    for (const double e : {1.0, 1e-2}) {
      const Rows<3> a = RandomRows<3>(random, 2), b = RandomRows<3>(random, 2);
      ExpectFrozenPushesBack(c, a, b, s.l, l0, e);
    }
  });
}

TEST(ContactLaw, LinearizeIsNewtonsEquation) {
  int checked[3] = {};
  ForEachInstance([&](const Contact2& c, Case which, math::Random& random) {
    State s = Solution(c, which, random);
    for (double& x : s.u) x += random.Uniform(-0.05, 0.05);
    for (double& x : s.l) x += random.Uniform(-0.05, 0.05);
    for (const double e : {0.0, 1e-2, 0.5}) checked[which] += CheckLinearize(c, s.u, s.l, e);
  });
  for (const int count : checked) EXPECT_GT(count, 0.9 * 3 * 2 * kInstances) << "next to a kink";
}

TEST(ContactLaw, MassesAreThoseOfItsLinks) {
  ForEachInstance([](const Contact2& c, Case, math::Random&) {
    const auto w = InverseMassOf(c);
    const double mine[3][3] = {{c.wnn[0], c.w1n[0], c.w2n[0]},
                               {c.w1n[0], c.w11[0], c.w12[0]},
                               {c.w2n[0], c.w12[0], c.w22[0]}};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(mine[i][j], w[i][j], 1e-14 * w[0][0] + 1e-14);
    }
    EXPECT_NEAR(c.inv_wnn[0] * w[0][0], 1, 1e-14);
    EXPECT_NEAR(c.inv_wt[0] * c.wt[0], 1, 1e-14);
    // wt bounds the largest eigenvalue of the tangential block.
    const double mean = (w[1][1] + w[2][2]) / 2;
    const double most = mean + std::hypot((w[1][1] - w[2][2]) / 2, w[1][2]);
    EXPECT_GE(c.wt[0], (c.one_direction ? w[1][1] : most) * (1 - 1e-14));
  });
}

TEST(ContactLaw, AloneItIsSolvedHoweverSteepItsCone) {
  int found[3] = {}, steep = 0;
  for (int i = 0; i < 3 * kInstances; ++i) {
    math::Random random(8, 0, static_cast<std::uint64_t>(i));
    const bool one_direction = i % 2 == 1;
    const Contact2 c = RandomContact(random, one_direction, 4.0);
    const Rows<3> u0 = RandomRows<3>(random, 2);
    Rows<3> l0 = RandomRows<3>(random);
    if (one_direction) l0[2] = 0;
    const auto [u, l] = SolvedAlone(c, u0, l0);
    EXPECT_LT(Violation(c, u, l), 1e-12 * (1 + Largest(l))) << "instance " << i;
    const double edge = c.mu[0] * l[0];
    ++found[l[0] == 0 ? kOpen : std::hypot(l[1], l[2]) < edge * (1 - 1e-9) ? kSticking : kSliding];
    // Painleve's paradox: friction alone would press the contact together.
    const auto w = InverseMassOf(c);
    steep += c.mu[0] * std::hypot(w[1][0], one_direction ? 0 : w[2][0]) > w[0][0];
  }
  for (const int count : found) EXPECT_GT(count, kInstances / 5);
  EXPECT_GT(steep, kInstances / 10);
}

TEST(ContactLaw, AloneItIsSolvedForAnyRatioOfClosingSpeedAndSlip) {
  for (int i = 0; i < kInstances; ++i) {
    math::Random random(9, 0, static_cast<std::uint64_t>(i));
    const bool one_direction = i % 2 == 1;
    const Contact2 c = RandomContact(random, one_direction, 4.0);
    const Rows<3> slip = RandomRows<3>(random, 2);
    for (const double closing : {1e-3, 1e-15, 1e-50, 1e-60, 1e-100, 1e-200, 1e-300, 5e-324}) {
      Rows<3> u0{-closing - c.bias[0][0], slip[1] - c.bias[1][0], slip[2] - c.bias[2][0]};
      if (closing < 1e-14) u0[0] = -closing;
      Contact2 exact = c;
      if (closing < 1e-14) exact.bias[0] = Num::Splat(0.0);
      const auto [u, l] = SolvedAlone(exact, u0, {});
      for (const double x : l) ASSERT_TRUE(std::isfinite(x)) << "instance " << i << ' ' << closing;
      EXPECT_LT(Violation(exact, u, l), 1e-12 * (1 + Largest(l))) << "instance " << i;
      EXPECT_LE(std::hypot(l[1], l[2]), c.mu[0] * l[0] * (1 + 1e-14)) << "outside its cone";
    }
  }
}

TEST(ContactLaw, ClampedImpulsesAreAdmissibleAndAdmissibleOnesStay) {
  ForEachInstance([](const Contact2& c, Case which, math::Random& random) {
    const Rows<3> any = RandomRows<3>(random), l = Clamped(c, any);
    EXPECT_GE(l[0], 0);
    EXPECT_LE(std::hypot(l[1], l[2]), c.mu[0] * l[0] * (1 + 1e-15));
    EXPECT_EQ(l[0], std::max(any[0], 0.0));
    EXPECT_GE(l[1] * any[1], 0) << "friction keeps its direction";
    EXPECT_NEAR(l[2] * any[1], c.one_direction ? 0 : l[1] * any[2], 1e-15);
    const Rows<3> solution = Solution(c, which, random).l;
    const Rows<3> inside = {solution[0], 0.999 * solution[1], 0.999 * solution[2]};
    EXPECT_EQ(Clamped(c, inside), inside);
  });
}

TEST(ContactLaw, ALaneWithoutItIsAtRest) {
  ForEachInstance([](Contact2 c, Case which, math::Random& random) {
    const State s = Solution(c, which, random);
    c.live = Num::Splat(0.0);
    const Rows<3> none{};
    const auto branch = c.BranchOf(Packed(s.u), Packed(none));
    EXPECT_FALSE(branch.closed[0] || branch.slides[0]);
    EXPECT_EQ(c.Residual(branch, Packed(s.u), Packed(none))[0], 0);
    sim::LinearLaw<Num, 3> linear;
    c.Linearize(branch, Packed(s.u), Packed(none), Num::Splat(1e-9), linear);
    for (int i = 0; i < 3; ++i) {  // 1 x = 0
      for (int j = 0; j < 3; ++j) {
        EXPECT_EQ(linear.A[i][j][0], i == j ? 1 : 0);
        EXPECT_EQ(linear.S[i][j][0], 0);
      }
      EXPECT_EQ(linear.r[i][0], 0);
    }
  });
}

}  // namespace
}  // namespace taut::test
