// Rotations as matrices and quaternions
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/rotation.h"
#include "math/vec.h"

namespace taut {
namespace {

/// Expects that the columns are the axes rotated by Rotate.
void ExpectMatrix(const double r[9], const Quat& q, double tolerance) {
  const Vec3 axes[3] = {Rotate(q, {1, 0, 0}), Rotate(q, {0, 1, 0}), Rotate(q, {0, 0, 1})};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(r[i], axes[i].x, tolerance);
    EXPECT_NEAR(r[3 + i], axes[i].y, tolerance);
    EXPECT_NEAR(r[6 + i], axes[i].z, tolerance);
  }
}

TEST(MatrixOf, TurnsAsItsQuaternionDoes) {
  const double s = std::sqrt(0.5);
  double r[9];
  MatrixOf({s, 0, 0, s}, r);  // a quarter turn about z
  const double quarter[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(r[i], quarter[i], 1e-15);
}

TEST(MatrixOf, DoesNotDependOnTheQuaternionsLength) {
  double r[9];
  MatrixOf({1.5, -0.3, 2.1, 0.9}, r);
  const double n = std::sqrt(1.5 * 1.5 + 0.3 * 0.3 + 2.1 * 2.1 + 0.9 * 0.9);
  ExpectMatrix(r, {1.5 / n, -0.3 / n, 2.1 / n, 0.9 / n}, 1e-15);
}

TEST(QuatOf, FindsTheQuaternionOfAnyMatrixUpToItsSign) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> x;
  int largest[4] = {};
  for (int i = 0; i < 1000; ++i) {
    const double q[4] = {x(random), x(random), x(random), x(random)};
    const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    int most = 0;
    for (int k = 1; k < 4; ++k) most = std::fabs(q[k]) > std::fabs(q[most]) ? k : most;
    ++largest[most];
    double r[9];
    MatrixOf({q[0], q[1], q[2], q[3]}, r);
    const Quat found = QuatOf(r);
    const double dot = (found.w * q[0] + found.x * q[1] + found.y * q[2] + found.z * q[3]) / n;
    EXPECT_NEAR(std::fabs(dot), 1, 1e-14);
    ExpectMatrix(r, found, 1e-14);
    if (HasFailure()) FAIL() << "quaternion " << i;
  }
  for (const int count : largest) EXPECT_GT(count, 100);  // each branch was taken
}

TEST(QuatOf, FindsHalfTurns) {
  const double about_x[9] = {1, 0, 0, 0, -1, 0, 0, 0, -1};
  const double about_y[9] = {-1, 0, 0, 0, 1, 0, 0, 0, -1};
  const double about_z[9] = {-1, 0, 0, 0, -1, 0, 0, 0, 1};
  ExpectMatrix(about_x, QuatOf(about_x), 0);
  ExpectMatrix(about_y, QuatOf(about_y), 0);
  ExpectMatrix(about_z, QuatOf(about_z), 0);
}

}  // namespace
}  // namespace taut
