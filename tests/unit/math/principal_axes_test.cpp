// Eigenvectors and eigenvalues of symmetric 3x3 matrices
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "math/principal_axes.h"
#include "math/vec.h"

namespace taut {
namespace {

struct Axes {
  double r[9], moments[3];
  explicit Axes(const Inertia& inertia) { PrincipalAxes(inertia, r, moments); }
  Vec3 operator[](int i) const { return {r[i], r[3 + i], r[6 + i]}; }
};

Vec3 Times(const Inertia& m, const Vec3& a) {
  return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
          m.xz * a.x + m.yz * a.y + m.zz * a.z};
}

/// Bound of rounding after a dozen rotations of a matrix of size 1 to 3
constexpr double kRounding = 1e-14;

void ExpectAxesOf(const Inertia& inertia, double tolerance) {
  const Axes axes(inertia);
  for (int i = 0; i < 3; ++i) {
    const Vec3 residual = Times(inertia, axes[i]) - axes.moments[i] * axes[i];
    EXPECT_LE(std::sqrt(Dot(residual, residual)), tolerance);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(Dot(axes[i], axes[j]), i == j ? 1 : 0, 1e-14);
  }
  EXPECT_NEAR(Dot(Cross(axes[0], axes[1]), axes[2]), 1, 1e-14);
}

TEST(PrincipalAxes, OfADiagonalMatrixAreTheAxesItIsGivenIn) {
  const Axes axes({3, 1, 2, 0, 0, 0});
  const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_TRUE(std::equal(identity, identity + 9, axes.r));
  EXPECT_EQ(axes.moments[0], 3);
  EXPECT_EQ(axes.moments[1], 1);
  EXPECT_EQ(axes.moments[2], 2);
}

TEST(PrincipalAxes, OfAMatrixByHandAreItsDiagonals) {
  // (2 1 0; 1 2 0; 0 0 5): 1 along x - y, 3 along x + y, 5 along z
  const Axes axes({2, 2, 5, 1, 0, 0});
  EXPECT_NEAR(axes.moments[0], 1, 1e-15);
  EXPECT_NEAR(axes.moments[1], 3, 1e-15);
  EXPECT_EQ(axes.moments[2], 5);
  EXPECT_NEAR(std::fabs(axes[0].x), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(axes[0].x, -axes[0].y, 1e-15);
  EXPECT_NEAR(axes[1].x, axes[1].y, 1e-15);
}

TEST(PrincipalAxes, SatisfyTheirEquationForAnyMatrixAndAreRightHanded) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> x(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double a = x(random), b = x(random), c = x(random), d = x(random), e = x(random);
    ExpectAxesOf({a, b, c, d, e, x(random)}, kRounding);
    if (HasFailure()) FAIL() << "matrix " << i;
  }
}

TEST(PrincipalAxes, ExistWhereMomentsAreEqualOrFarApart) {
  ExpectAxesOf({1, 1, 1, 0, 0, 0}, 0);
  ExpectAxesOf({1, 1, 1, 1e-9, 0, 1e-9}, kRounding);
  ExpectAxesOf({1, 1, 2, 0, 1e-17, 0}, kRounding);
  ExpectAxesOf({1e-9, 1, 1, 1e-6, 1e-6, 0}, kRounding);
  ExpectAxesOf({0, 0, 0, 0, 0, 0}, 0);
}

}  // namespace
}  // namespace taut
