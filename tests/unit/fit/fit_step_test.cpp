/// One damped step within a box: Karush-Kuhn-Tucker conditions
#include <gtest/gtest.h>

#include "fit/damped_step.h"
#include "math/random.h"

namespace taut::fit {
namespace {

/// Columns far from orthogonal, so that a variable at its bound changes the others
Quadratic Coupled(std::uint64_t seed, Eigen::Index n) {
  math::Random random(seed, 7, 4);
  Quadratic quadratic{Matrix(n + 2, n), Vector(n + 2)};
  for (Eigen::Index i = 0; i < n + 2; ++i) {
    quadratic.q[i] = 3 * random.Normal();
    for (Eigen::Index j = 0; j < n; ++j) quadratic.R(i, j) = 1 + random.Normal();
  }
  return quadratic;
}

/// Gradient of |R d + q|^2 / 2 + damping |D d|^2 / 2
Vector Gradient(const Quadratic& quadratic, const Vector& weight, double damping, const Vector& d) {
  return quadratic.R.transpose() * (quadratic.R * d + quadratic.q) +
         damping * weight.cwiseProduct(weight).cwiseProduct(d);
}

TEST(FitStep, OnABoundTheOthersAreAtTheirMinimumThere) {
  int pinned = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Quadratic quadratic = Coupled(seed, 3);
    const Vector weight = Vector::LinSpaced(3, 1.0, 2.0);
    const double damping = 0.3;
    const StepBox box{Vector::Constant(3, -0.4), Vector::Constant(3, 0.3), {false, false, false}};
    const Vector d = DampedStep(quadratic, weight, damping, box);
    const Vector gradient = Gradient(quadratic, weight, damping, d);
    for (Eigen::Index j = 0; j < 3; ++j) {
      EXPECT_GE(d[j], box.low[j]);
      EXPECT_LE(d[j], box.high[j]);
      const bool on_bound = d[j] == box.low[j] || d[j] == box.high[j];
      pinned += on_bound ? 1 : 0;
      if (!on_bound) {
        EXPECT_NEAR(gradient[j], 0, 1e-10) << seed;
      }
      if (d[j] == box.low[j]) {  // descent points outward
        EXPECT_GE(gradient[j], 0) << seed;
      }
      if (d[j] == box.high[j]) {
        EXPECT_LE(gradient[j], 0) << seed;
      }
    }
  }
  EXPECT_GT(pinned, 10);
}

TEST(FitStep, WhatIsHeldStandsStill) {
  const Quadratic quadratic = Coupled(5, 3);
  const Vector weight = Vector::Ones(3);
  const StepBox box{Vector::Constant(3, -9), Vector::Constant(3, 9), {false, true, false}};
  const Vector d = DampedStep(quadratic, weight, 0.1, box);
  const Vector gradient = Gradient(quadratic, weight, 0.1, d);
  EXPECT_EQ(d[1], 0);
  EXPECT_NEAR(gradient[0], 0, 1e-10);
  EXPECT_NEAR(gradient[2], 0, 1e-10);
}

TEST(FitStep, ReducingASystemKeepsItsSquares) {
  const Quadratic whole = Coupled(3, 2);
  System system;
  system.jacobian = whole.R;
  system.residual = whole.q;
  const Quadratic less = Reduce(system);
  ASSERT_EQ(less.R.rows(), 2);
  const Vector d = Vector::LinSpaced(2, -0.3, 0.7);
  EXPECT_NEAR(less.Reduction(d), whole.Reduction(d), 1e-12);
  EXPECT_NEAR((less.gradient() - whole.gradient()).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace taut::fit
