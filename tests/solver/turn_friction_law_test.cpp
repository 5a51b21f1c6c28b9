// Law of a ball joint's friction: impulses within a ball, opposite to the rotation at its surface
// (docs/theory/joints.md, eq. 10); its derivatives, and the solution of a single joint for any
// ratio of the inverse masses about different axes.
#include "sim/constraint/turn_friction.h"

#include <gtest/gtest.h>

#include "tests/solver/law_checks.h"

namespace taut::test {

using Friction = sim::TurnFriction<Num>;

static double Length(const Rows<3>& x) {
  return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}
static Rows<3> Scaled(double by, Rows<3> x) {
  for (double& y : x) y *= by;
  return x;
}
static double InverseMass(const Friction& f) { return f.w[0]; }

/// Returns the excess of |l| over the limit, and the distance of u from zero, or from the direction
/// of -l at the limit, where the joint slides.
static double Violation(const Friction& f, const Rows<3>& u, const Rows<3>& l) {
  const double limit = f.limit[0], beyond = std::max(0.0, Length(l) - limit);
  if (Length(l) < limit * (1 - 1e-9)) return std::max(beyond, Length(u));
  const Rows<3> along = Scaled(1 / Length(l), l);
  const double slides = std::max(0.0, -(u[0] * along[0] + u[1] * along[1] + u[2] * along[2]));
  Rows<3> askew = u;
  for (std::size_t r = 0; r < 3; ++r) askew[r] += slides * along[r];
  return std::max(beyond, Length(askew));
}
/// Sticking: u + e w (l - center). Sliding: w (l - limit y / |y|), y = l - u / w - e (l - center).
static Rows<3> NewtonFunction(const Friction& f, const Rows<3>& u, const Rows<3>& l,
                              const Rows<3>& center, double e) {
  const double w = InverseMass(f), limit = f.limit[0];
  Rows<3> y, out;
  for (std::size_t r = 0; r < 3; ++r) y[r] = l[r] - u[r] / w - e * (l[r] - center[r]);
  const double share = std::min(1.0, limit / std::max(Length(y), 1e-300));
  for (std::size_t r = 0; r < 3; ++r) out[r] = w * (l[r] - share * y[r]);
  return out;
}

namespace {

/// Returns the friction of one body, or two, with moments of inertia that differ by `spread`.
Friction RandomFriction(math::Random& random, double spread) {
  Friction f{};
  f.limit = Num::Splat(random.Uniform(0.3, 1.0));
  f.link_count = random.Uniform() < 0.5 ? 1 : 2;
  for (int k = 0; k < f.link_count; ++k) {
    double n[3] = {random.Normal(), random.Normal(), random.Normal()};
    const double size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (double& x : n) x /= size;
    for (int r = 0; r < 3; ++r) {
      const auto splat = [&](const double* x) {
        return simd::V3<Num>{Num::Splat(x[0]), Num::Splat(x[1]), Num::Splat(x[2])};
      };
      double axis[3] = {}, turn[3];
      axis[r] = k == 0 ? 1 : -1;
      for (int i = 0; i < 3; ++i) turn[i] = 0.3 * (axis[i] + spread * n[i] * n[r] * axis[r]);
      f.links[k].ang[r] = splat(axis), f.links[k].turn[r] = splat(turn);
    }
  }
  f.FinishMasses();
  return f;
}

struct State {
  Rows<3> u, l;
};
State Solution(const Friction& f, bool slides, math::Random& random) {
  const Rows<3> way = {random.Normal(), random.Normal(), random.Normal()};
  const Rows<3> one = Scaled(1 / Length(way), way);
  if (!slides) return {{}, Scaled(f.limit[0] * random.Uniform(0, 0.9), one)};
  return {Scaled(-random.Uniform(0.2, 1.2), one), Scaled(f.limit[0], one)};
}

template <class F>
void ForEachInstance(const F& f) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    for (const bool slides : {false, true}) {
      math::Random random(23, slides, i);
      const Friction friction = RandomFriction(random, i % 2 ? 1.0 : 1e6);
      f(friction, Solution(friction, slides, random), slides, random);
      if (testing::Test::HasFailure()) FAIL() << "instance " << i << (slides ? ", slides" : "");
    }
  }
}
bool IsEven(const Friction& f) { return InverseMass(f) < 1e3; }

TEST(TurnFrictionLaw, SolutionsStayWhereTheyAreAndNothingElseDoes) {
  ForEachInstance([](const Friction& f, State s, bool slides, math::Random& random) {
    if (!IsEven(f)) return;  // the tolerances assume inverse masses of order 1
    ExpectSolution(f, s.u, s.l);
    EXPECT_EQ(f.BranchOf(Packed(s.u), Packed(s.l)).slides[0], slides);
    const double off = random.Uniform(0.05, 0.2);
    if (!slides) {
      ExpectNoSolution(f, {off, 0, 0}, s.l);  // rotates below the friction limit
      return;
    }
    ExpectNoSolution(f, s.u, Scaled(1 + off, s.l));  // beyond the limit
    ExpectNoSolution(f, s.u, Scaled(1 - off, s.l));
    ExpectNoSolution(f, s.u, Scaled(-1, s.l));           // accelerates
    ExpectNoSolution(f, {s.u[1], s.u[2], s.u[0]}, s.l);  // wrong direction
  });
}

TEST(TurnFrictionLaw, DerivativesAreThoseOfTheLaw) {
  int seen = 0;
  ForEachInstance([&](const Friction& f, State s, bool, math::Random& random) {
    if (!IsEven(f)) return;
    const Rows<3> u = RandomRows<3>(random), l = RandomRows<3>(random), v = RandomRows<3>(random);
    ExpectResidualIsNewtons(f, u, s.l);
    ExpectResidualIsNewtons(f, s.u, l);
    for (const double e : {1.0, 1e-2}) {
      seen += CheckDerivative(f, u, l, e);
      seen += CheckDerivative(f, Scaled(1e-3 * e, u), s.l, e);
      ExpectFrozenPushesBack(f, u, v, l, l, e);
    }
  });
  EXPECT_GT(seen, 3000);
}

TEST(TurnFrictionLaw, ANewtonStepSolvesTheLinearizedLaw) {
  int seen = 0;
  ForEachInstance([&](const Friction& f, State s, bool slides, math::Random& random) {
    if (!IsEven(f)) return;
    const double e = 1e-2;
    Rows<3> u = s.u, l = s.l;
    for (std::size_t r = 0; r < 3; ++r) {
      u[r] += random.Uniform(-0.01, 0.01), l[r] += random.Uniform(-0.01, 0.01);
    }
    const auto of_l = [&](const Rows<3>& at) { return NewtonFunction(f, u, at, l, e); };
    const auto of_u = [&](const Rows<3>& at) { return NewtonFunction(f, at, l, l, e); };
    if (HasKink(of_l, l, kStep, 1.0) || HasKink(of_u, u, kStep, 1.0)) return;
    const auto branch = f.BranchOf(Packed(u), Packed(l));
    EXPECT_EQ(branch.slides[0], slides);
    sim::LinearLaw<Num, 3> linear;
    f.Linearize(branch, Packed(u), Packed(l), Num::Splat(e), linear);
    const auto by_l = Differences(of_l, l, kStep), by_u = Differences(of_u, u, kStep);
    const Rows<3> at = of_l(l), du = RandomRows<3>(random);
    Rows<3> dl;
    for (int i = 0; i < 3; ++i) {
      dl[At(i)] = linear.r[i][0];
      for (int j = 0; j < 3; ++j) {
        dl[At(i)] -= linear.S[i][j][0] * du[At(j)];
        EXPECT_EQ(linear.S[i][j][0], linear.S[j][i][0]);
        EXPECT_TRUE(i == j || linear.A[i][j][0] == 0);
      }
      dl[At(i)] /= linear.A[i][i][0];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      double left = at[i];
      for (std::size_t j = 0; j < 3; ++j) left += by_l[i][j] * dl[j] + by_u[i][j] * du[j];
      EXPECT_NEAR(left, 0, 1e-7 * (1 + Largest(dl)));
    }
    ++seen;
  });
  EXPECT_GT(seen, 900);
}

TEST(TurnFrictionLaw, AloneItIsSolvedWhateverTheInertias) {
  ForEachInstance([](const Friction& f, const State&, bool, math::Random& random) {
    const Rows<3> u = RandomRows<3>(random, 3), l0 = RandomRows<3>(random);
    const auto [after, with] = SolvedAlone(f, u, l0);
    EXPECT_LT(Violation(f, after, with), 1e-12 * (1 + InverseMass(f)));
    EXPECT_LE(Length(with), f.limit[0] * (1 + 1e-15));
  });
}

TEST(TurnFrictionLaw, ClampedImpulsesAreTheNearestWithinTheLimit) {
  ForEachInstance([](const Friction& f, const State& s, bool, math::Random& random) {
    const Rows<3> far = RandomRows<3>(random, 5), near = Clamped(f, far);
    EXPECT_NEAR(Length(near), std::min(f.limit[0], Length(far)), 1e-14);
    EXPECT_LT(Length(Difference(Scaled(Length(near) / Length(far), far), near)), 1e-14);
    EXPECT_LT(Length(Difference(Clamped(f, s.l), s.l)), 1e-15);
  });
}

}  // namespace
}  // namespace taut::test
